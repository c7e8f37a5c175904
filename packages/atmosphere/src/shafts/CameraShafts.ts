import type { Camera } from 'three'
import type { NodeFrame, Renderer, UniformNode } from 'three/webgpu'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { ViewNodes } from '../view/ViewNodes'
import type { ShaftScreens } from './ShaftScreens'
import type { ShaftSteps } from './tsl/lostLight'
import type { ShadowedAir } from './tsl/shadowsAlong'

/** Light shafts of a camera, as far as a picture of it asks them. */
export interface CameraShafts {
  readonly camera: Camera
  /** The camera's view of the air in the light. */
  readonly view: ViewNodes
  readonly shadowedAir: ShadowedAir
  readonly steps: ShaftSteps
  /** Pixels of a large picture from one that is marched to the next. */
  readonly spacing: number
  /** True if there are shadows to be drawn, as of the last `prepare`. */
  readonly isActive: boolean
  /** Grows whenever its shader changes. */
  readonly version: number
  /** Pictures that are drawn with them. */
  readonly screens: ShaftScreens
  /** True if materials draw the shafts themselves. */
  readonly isForward: boolean
  /** Part of the light that air in shadow loses; 0 where shafts are off. */
  readonly strengthNow: UniformNode<'float', number>
  prepare(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void
  update(view: AtmosphereView): void
}
