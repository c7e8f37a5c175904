import { fail } from '@welkin/geo'
import type { AirPicture, ForegroundLayer } from '../view/AirShadows'

/** Shafts of a picture, as far as those of its camera ask them. */
interface Screen {
  readonly foreground: ForegroundLayer | undefined
  readonly isMesh: boolean
  free(): void
}

/** Pictures that have a camera's light shafts: those of post effects, of foreground layers and of meshes of air. */
export class ShaftScreens extends Set<Screen> {
  /** True if a foreground layer is drawn, by whose node shafts are. */
  get hasForeground(): boolean {
    return [...this].some(({ foreground }) => foreground?.isDrawn)
  }

  /** True if a post effect draws them. */
  get hasPostEffect(): boolean {
    return [...this].some(({ foreground, isMesh }) => foreground === undefined && !isMesh)
  }
}

/** @throws If shafts would never be seen in a picture. */
export function checkPicture(
  picture: AirPicture,
  { camera, atmosphere }: Omit<AirPicture, 'type'>
): void {
  const { type } = picture
  if (picture.atmosphere !== atmosphere)
    fail(type, 'shafts must be of the same atmosphere', atmosphere)
  if (picture.camera !== camera) fail(type, 'shafts must be of the same camera', camera)
}
