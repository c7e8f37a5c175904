import { Vector3 } from 'three'
import { If } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { LightSource } from '../view/LightSource'
import type { PointRay, SkyRay } from '../view/SkyLayer'
import { radianceBetween, sampleSky } from '../skyVolume/tsl/skyVolume'
import type { Float, Vec4 } from '../tsl-types'
import { viewNodes, type ViewNodes } from '../view/ViewNodes'
import type { ViewUniforms } from '../view/ViewUniforms'
import { number } from '../uniforms'

/** Cosine of the sun's zenith angle above which its light in the air masks the moon's: 2° down. Less: the sky steps at dusk. */
const MAX_COS_SUN = -0.035

/** Cosine of the moon's zenith angle below which its light reaches no air that is seen: 18° down. */
const MIN_COS_MOON = -0.31

const _position = new Vector3()
const _direction = new Vector3()

/** Moonlit air: in-scatter of moonlight, from sky volumes that are computed while it can be seen. */
export class MoonlitAir {
  /** 1 while moonlit air can be seen, else 0. */
  readonly #isVisible = number()
  readonly #views = new Map<ViewUniforms, ViewNodes>()

  constructor(
    readonly atmosphere: Atmosphere,
    readonly source: LightSource
  ) {
    atmosphere.tables.addSource(source)
  }

  /** @param shines - False for a moon without light. */
  prepare(renderer: Renderer, view: AtmosphereView, shines: boolean): void {
    this.source.lightsAir = shines && this.#canBeSeen(view)
    if (this.source.lightsAir) this.atmosphere.update(renderer, view.camera, this.source)
  }

  #canBeSeen(view: AtmosphereView): boolean {
    const { parameters, space } = this.atmosphere
    if (view.height > parameters.topRadius - parameters.bottomRadius) return true
    if (view.up.dot(view.lightDirection) > MAX_COS_SUN) return false
    _position.setFromMatrixPosition(view.camera.matrixWorld)
    this.source.direction(_direction, _position)
    return view.up.dot(space.direction(_direction, _position)) > MIN_COS_MOON
  }

  update(view: AtmosphereView): void {
    this.#isVisible.value = this.source.lightsAir ? 1 : 0
    for (const nodes of this.#views.values()) {
      if (nodes.camera === null || nodes.camera === view.camera) nodes.update(view)
    }
  }

  glow(ray: SkyRay, without: Vec4): Vec4 {
    const light = without.toVar()
    const { air, volume, viewpoint, lightDirection: moonDirection } = this.#nodes(ray.view)
    If(this.#isVisible.greaterThan(0).and(ray.meetsAir), () => {
      const cosViewMoon = ray.direction.dot(moonDirection).toConst() as Float
      const sky = sampleSky(air.uniforms, volume, viewpoint, ray, cosViewMoon)
      light.addAssign(sky.mul(this.source.irradiance))
    })
    return light
  }

  inScatter({ view, direction, segment }: PointRay, without: Vec4): Vec4 {
    const light = without.toVar()
    const { air, volume, viewpoint, lightDirection: moonDirection } = this.#nodes(view)
    If(this.#isVisible.greaterThan(0), () => {
      const cosViewMoon = direction.dot(moonDirection).toConst() as Float
      const between = radianceBetween(air.uniforms, volume, viewpoint, segment, cosViewMoon)
      light.addAssign(between.mul(this.source.irradiance))
    })
    return light
  }

  /** Nodes of the same view, lit by the moon instead of the sun. */
  #nodes(view: ViewUniforms): ViewNodes {
    let nodes = this.#views.get(view)
    if (nodes === undefined) {
      nodes = viewNodes(this.atmosphere, view.camera, this.source)
      this.#views.set(view, nodes)
    }
    return nodes
  }

  dispose(): void {
    this.source.lightsAir = false
    this.atmosphere.tables.removeSource(this.source)
  }
}
