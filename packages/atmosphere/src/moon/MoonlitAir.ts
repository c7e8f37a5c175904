import { Vector3 } from 'three'
import { If, renderGroup, uniform } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { LightSource } from '../view/LightSource'
import type { HazeLine, SkyRay } from '../view/SkyLayer'
import { radianceBetween, sampleSky } from '../skyVolume/tsl/skyVolume'
import type { Float, Vec4 } from '../tsl-types'
import { viewNodes, type ViewNodes } from '../view/ViewNodes'

/** With the sun above this, or the moon below that, moonlight in the air is not seen. cos of zenith angles. */
const SUN_DROWNS = 0
const MOON_IS_DOWN = -0.31

const _position = new Vector3()
const _direction = new Vector3()

/** The air in the light of the moon, from sky volumes that are computed while that can be seen. */
export class MoonlitAir {
  /** 1 while moonlight in the air can be seen. */
  readonly #glows = uniform(0).setGroup(renderGroup)
  readonly #views = new Map<ViewNodes, ViewNodes>()

  constructor(
    readonly atmosphere: Atmosphere,
    readonly source: LightSource
  ) {
    atmosphere.tables.addSource(source)
  }

  prepare(renderer: Renderer, view: AtmosphereView): void {
    this.source.lightsAir = this.#isSeen(view)
    if (this.source.lightsAir) this.atmosphere.update(renderer, view.camera, this.source)
  }

  #isSeen(view: AtmosphereView): boolean {
    const { parameters, space } = this.atmosphere
    if (view.height > parameters.topRadius - parameters.bottomRadius) return true
    if (view.up.dot(view.sunDirection) > SUN_DROWNS) return false
    _position.setFromMatrixPosition(view.camera.matrixWorld)
    this.source.direction(this.atmosphere, _direction, _position)
    return view.up.dot(space.direction(_direction, _position)) > MOON_IS_DOWN
  }

  update(view: AtmosphereView): void {
    this.#glows.value = this.source.lightsAir ? 1 : 0
    for (const nodes of this.#views.values()) {
      if (nodes.camera === null || nodes.camera === view.camera) nodes.update(view)
    }
  }

  glow(ray: SkyRay, without: Vec4): Vec4 {
    const light = without.toVar()
    const { air, volume, eye, sunDirection } = this.#nodes(ray.view)
    If(this.#glows.greaterThan(0).and(ray.meetsAir), () => {
      const cosViewMoon = ray.direction.dot(sunDirection).toConst() as Float
      const sky = sampleSky(air.uniforms, volume, eye, ray, cosViewMoon)
      light.addAssign(sky.mul(this.source.irradiance))
    })
    return light
  }

  haze({ view, direction, place }: HazeLine, without: Vec4): Vec4 {
    const light = without.toVar()
    const { air, volume, eye, sunDirection } = this.#nodes(view)
    If(this.#glows.greaterThan(0), () => {
      const cosViewMoon = direction.dot(sunDirection).toConst() as Float
      const between = radianceBetween(air.uniforms, volume, eye, place, cosViewMoon)
      light.addAssign(between.mul(this.source.irradiance))
    })
    return light
  }

  /** The nodes of a view in the light of the moon. */
  #nodes(view: ViewNodes): ViewNodes {
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
