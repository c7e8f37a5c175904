import type { Camera } from 'three'
import type { NodeFrame } from 'three/webgpu'
import { fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { AtmosphereView } from './AtmosphereView'
import type { LightSource } from './LightSource'
import { getOrMake } from './getOrMake'
import { ViewUniforms } from './ViewUniforms'

/** An atmosphere as seen from a camera in the light of one source: what shaders of a view share. */
export class ViewNodes extends ViewUniforms {
  readonly atmosphere: Atmosphere

  /** @param camera - The camera; null for whichever renders. */
  constructor(atmosphere: Atmosphere, camera: Camera | null, source: LightSource) {
    super(atmosphere.tables, source, camera)
    this.atmosphere = atmosphere
  }

  /** Bakes what the camera that renders needs. To be called before a render starts. */
  prepare(frame: NodeFrame): AtmosphereView | undefined {
    const camera = this.camera ?? frame.camera
    if (frame.renderer === null || camera === null) return undefined
    return this.atmosphere.update(frame.renderer, camera, this.source)
  }

  /** Sets the uniforms for the camera that renders. */
  update(frame: Pick<NodeFrame, 'camera'>): AtmosphereView | undefined {
    const camera = this.camera ?? frame.camera
    const view = camera === null ? undefined : this.atmosphere.viewOf(camera, this.source)
    if (!view?.viewpoint) return undefined
    this.set(view, view.viewpoint)
    return view
  }
}

/** @throws If it is no atmosphere. */
export function checkAtmosphere(where: string, value: Atmosphere): void {
  if (!value?.isAtmosphere) fail(where, 'atmosphere must be an Atmosphere', value)
}

const shared = new WeakMap<LightSource, WeakMap<object, ViewNodes>>()

/** The nodes of an atmosphere for a camera and a source of light, made once. */
export function viewNodes(
  atmosphere: Atmosphere,
  camera: Camera | null = null,
  source: LightSource = atmosphere.sun
): ViewNodes {
  const views = getOrMake(shared, source, () => new WeakMap())
  return getOrMake(views, camera ?? atmosphere, () => new ViewNodes(atmosphere, camera, source))
}
