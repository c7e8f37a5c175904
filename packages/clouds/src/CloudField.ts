import { Matrix3, Matrix4, Quaternion, RepeatWrapping, Vector3, Vector4 } from 'three'
import type { Texture } from 'three'
import { viewNodes } from '@welkin/atmosphere'
import type { Atmosphere, AtmosphereView, ViewNodes } from '@welkin/atmosphere'
import { renderGroup, texture, texture3D, uniform } from 'three/tsl'
import type { Renderer, UniformNode } from 'three/webgpu'
import { CloudLayers } from './CloudLayers'
import { CloudNoise } from './CloudNoise'
import { NightLight } from './NightLight'
import type { NoiseName } from './noiseSizes'
import { latticeRotation, layerTurn } from './lattice'
import {
  CURL_PERIOD,
  DETAIL_PERIOD,
  LAYER_STRIDE,
  REGION_PERIOD,
  FIELD_PERIOD,
  layerForms,
  layerPeriods,
  weatherScales
} from './layerUniforms'
import { vec4Array, type LevelTexture, type Vec2, type Vec3 } from './tsl-types'
import { windTurn } from './wind'

const _position = new Vector3()
const _foot = new Vector3()
const _point = new Vector3()
const _stretch = new Vector3()
const _matrix = new Matrix3()
const _matrix4 = new Matrix4()
const _turn = new Quaternion()

/** Options of {@link CloudField}. */
export interface CloudFieldOptions {
  /**
   * Cloud cover of the whole planet: equirectangular, north up, longitude −180° at the left edge; its
   * red channel is the share of the sky that is covered. It repeats in S. Shared, not owned. It should
   * have mipmaps.
   */
  worldMap?: Texture | null
  /** Noise to share between fields; left out, the field makes and owns its own. */
  noise?: CloudNoise
}

/**
 * Where the clouds are, as shaders see it: layers, weather and wind as uniforms, and noise.
 *
 * ```ts
 * const field = new CloudField(atmosphere, new CloudLayers())
 * field.noise.update(renderer)
 * field.update(atmosphere.update(renderer, camera), seconds)
 * ```
 *
 * Layers may be changed at any time: `update` copies them into uniforms, and nothing is recompiled.
 * The wind turns each layer as a rigid shell about the planet's centre, at the given velocity where the
 * camera is that `update` first saw at a time.
 */
export class CloudField {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  readonly layers: CloudLayers
  readonly noise: CloudNoise
  /** Place, height and up-vector of the camera: shared with the atmosphere's nodes. */
  readonly view: ViewNodes
  /** What lights clouds in the night. */
  readonly night = new NightLight()
  /** Radius of the sphere at altitude 0 [m]. */
  readonly radius: UniformNode<'float', number> = uniform(0).setGroup(renderGroup)
  /** Angle between neighbouring samples, that of a pixel or more: sets the level of detail [rad]. */
  readonly pixelAngle: UniformNode<'float', number> = uniform(1e-3).setGroup(renderGroup)
  /** All layers' parameters and anchors: see tsl/layer.ts for what lies where. */
  readonly values: Vector4[] = Array.from(
    { length: CloudLayers.maxLayers * LAYER_STRIDE },
    () => new Vector4()
  )
  readonly array = vec4Array(this.values)
  readonly textures: Readonly<Record<NoiseName, LevelTexture<Vec3>>>
  readonly worldMap: LevelTexture<Vec2> | null
  /** What it samples; shared, not owned. */
  readonly worldMapTexture: Texture | null
  /** Width of the world map [texels]. */
  readonly worldMapWidth: number
  /** Mapped space's axial ratio a/b of the ellipsoid, for geodetic latitudes. */
  readonly axialRatio: number
  readonly #ownsNoise: boolean
  /** How each layer's noise is turned about the planet's centre: the wind's work. */
  readonly turns: readonly Quaternion[] = Array.from({ length: CloudLayers.maxLayers }, (_, i) =>
    layerTurn(i)
  )
  /** How far each layer has moved at the camera since the update before, in the mapped space [m]. */
  readonly drifts: readonly Vector3[] = this.turns.map(() => new Vector3())
  #seconds: number | null = null

  /**
   * @param view - Nodes of the camera that samples are seen from.
   * @throws If the atmosphere or the layers are missing, or the map does not repeat.
   */
  constructor(
    atmosphere: Atmosphere,
    layers: CloudLayers,
    view: ViewNodes = viewNodes(atmosphere),
    { worldMap = null, noise }: CloudFieldOptions = {}
  ) {
    if (!atmosphere?.isAtmosphere) {
      throw new Error(`CloudField: atmosphere must be an Atmosphere, got ${typeof atmosphere}`)
    }
    if (!(layers instanceof CloudLayers)) {
      throw new Error(`CloudField: layers must be CloudLayers, got ${typeof layers}`)
    }
    if (worldMap !== null && worldMap.wrapS !== RepeatWrapping) {
      throw new Error(`CloudField: worldMap.wrapS must be RepeatWrapping, got ${worldMap.wrapS}`)
    }
    this.atmosphere = atmosphere
    this.layers = layers
    this.view = view
    this.#ownsNoise = noise === undefined
    this.noise = noise ?? new CloudNoise()
    const node = (name: NoiseName): LevelTexture<Vec3> =>
      texture3D(this.noise[name].target.texture) as unknown as LevelTexture<Vec3>
    this.textures = { shape: node('shape'), detail: node('detail'), weather: node('weather') }
    this.worldMapTexture = worldMap
    this.worldMap = worldMap === null ? null : (texture(worldMap) as unknown as LevelTexture<Vec2>)
    this.worldMapWidth = (worldMap?.image as { width?: number } | null)?.width ?? 2048
    const { x, z } = atmosphere.ellipsoid.radii
    this.axialRatio = x / z
  }

  /**
   * Follows layers, wind and camera: call it before each render of a camera.
   *
   * @param view - The camera's view, up to date.
   * @param seconds - Time, on any clock; the clouds drift by its differences [s].
   */
  update(view: AtmosphereView, seconds: number): void {
    const { bottomRadius } = this.atmosphere.parameters
    const elapsed = this.#seconds === null ? 0 : seconds - this.#seconds
    if (Number.isFinite(elapsed)) this.#seconds = seconds
    this.radius.value = bottomRadius
    this.night.update(view)
    _position.copy(view.up).multiplyScalar(bottomRadius + view.height)
    _foot.copy(view.up).multiplyScalar(bottomRadius)
    for (let i = 0; i < this.layers.length; i++) {
      this.drifts[i].set(0, 0, 0)
      if (Number.isFinite(elapsed) && elapsed !== 0) this.#drift(i, view.up, elapsed)
      this.#write(i)
    }
    for (let i = this.layers.length; i < CloudLayers.maxLayers; i++) {
      this.values[i * LAYER_STRIDE].set(0, 0, 0, 0)
    }
  }

  /** Turns a layer against its wind: the noise is looked up where the air came from. */
  #drift(index: number, up: Vector3, elapsed: number): void {
    const { wind, baseAltitude } = this.layers.at(index).parameters
    const radius = this.atmosphere.parameters.bottomRadius + baseAltitude
    this.turns[index].multiply(windTurn(wind, up, elapsed, radius, _turn)).normalize()
    _point.copy(up).multiplyScalar(radius)
    this.drifts[index].copy(_point).sub(_point.applyQuaternion(_turn))
  }

  /** Copies a layer's parameters, and its anchors for the eye and the point of the ground below it. */
  #write(index: number): void {
    const { parameters } = this.layers.at(index)
    const periods = layerPeriods(parameters)
    const slots = this.values.slice(index * LAYER_STRIDE, (index + 1) * LAYER_STRIDE)
    const { baseAltitude, topAltitude, density, shadow } = parameters
    const coverage = this.noise.isReady ? parameters.coverage : 0
    slots[0].set(baseAltitude, 1 / (topAltitude - baseAltitude), coverage, density)
    const { profileExponent, shapeAmount, detailAmount } = parameters
    slots[1].set(profileExponent, shapeAmount, detailAmount, 1 / periods.shape)
    const scales = weatherScales(parameters.weatherWeights, this.worldMap !== null)
    const { fibrous, stretch, steepness, sharpness, coarseness, anvil } = layerForms(parameters)
    slots[2].fromArray(scales.clouds)
    slots[11].set(scales.cells, scales.regions, scales.planet, scales.cloudVariance)
    const turn = this.turns[index]
    const { elements } = _matrix.setFromMatrix4(_matrix4.makeRotationFromQuaternion(turn))
    const anchor = (
      slot: number,
      place: Vector3,
      rotation: Matrix3,
      length: number,
      periods = 1,
      perStretch = 1
    ): void => {
      _point
        .copy(place)
        .applyQuaternion(turn)
        .multiply(_stretch.set(perStretch, perStretch, 1))
        .applyMatrix3(rotation)
        .divideScalar(length * periods)
      const [x, y, z] = _point.toArray().map(v => periods * (v - Math.floor(v)))
      slots[slot].set(x, y, z, slots[slot].w)
    }
    for (let row = 0; row < 3; row++) {
      slots[3 + row].set(elements[row], elements[row + 3], elements[row + 6], 0)
    }
    slots[3].w = steepness
    slots[4].w = sharpness
    slots[5].w = fibrous
    const perStretch = 1 / stretch
    anchor(8, _position, latticeRotation.shape, periods.shape, 1, perStretch)
    anchor(9, _position, latticeRotation.detail, DETAIL_PERIOD, CURL_PERIOD, perStretch)
    slots[8].w = perStretch
    slots[9].w = coarseness
    slots[10].w = anvil
    // The weather is the same all the way up: it is looked up at the foot point.
    anchor(6, _foot, latticeRotation.weather, periods.weather)
    slots[6].w = 1 / periods.weather
    anchor(10, _foot, latticeRotation.fields, periods.weather * FIELD_PERIOD)
    anchor(7, _foot, latticeRotation.region, REGION_PERIOD)
    slots[7].w = shadow ? 1 : 0
  }

  /** Draws missing noise: `CloudNoise.update`. Until that is done, the sky is clear. */
  bake(renderer: Renderer, slices = Infinity): boolean {
    return this.noise.update(renderer, slices)
  }

  /** Frees the noise if it is the field's own. */
  dispose(): void {
    if (this.#ownsNoise) this.noise.dispose()
  }
}
