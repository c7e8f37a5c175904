import { Matrix4, Quaternion, Vector3, Vector4 } from 'three'
import { checkAtmosphere, viewNodes } from '@welkin/atmosphere'
import { checkOptions, fail } from '@welkin/geo'
import type { Atmosphere, AtmosphereView, ViewNodes } from '@welkin/atmosphere'
import { texture3D } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { CloudLayers } from '../layers/CloudLayers'
import { CloudNoise } from '../noise/CloudNoise'
import { NightLight } from '../light/NightLight'
import type { NoiseName } from '../noise/noiseSizes'
import type { CloudSample } from './CloudSample'
import type { CloudWorldMap } from './CloudWorldMap'
import { latticeRotations, layerRotation } from './lattice'
import {
  LAYER_STRIDE,
  noisePeriods,
  layerForms,
  layerPeriods,
  weatherScales
} from '../layers/layerUniforms'
import { meanColumnOf } from '../layers/meanColumn'
import { billowForm, heightForm } from './formConstants'
import { vec4Array, type Float, type LevelTexture, type Vec3 } from '../tsl-types'
import { number } from '../uniforms'
import { windAxis, windRotation } from '../layers/wind'

/**
 * Share of its coverage that a layer gains in each frame once its noise is complete, if that took several frames. 1: clouds pop up (*Cumulus*, at its start).
 */
const FADE_IN_STEP = 1 / 48

const _position = new Vector3()
const _subpoint = new Vector3()
const _point = new Vector3()
const _axis = new Vector3()
const _stretch = new Vector3()
const _matrix = new Matrix4()
const _rotationMatrix = new Matrix4()
const _rotation = new Quaternion()

/** Options of {@link CloudField}. */
export interface CloudFieldOptions {
  /** Cloud cover of the planet or a part of it: `cloudWorldMap(texture)`; by default none. */
  worldMap?: CloudWorldMap | null
  /** Noise to share between fields; left out, the field makes and owns its own. */
  noise?: CloudNoise
  /**
   * Clouds of one's own in place of weather and noise, a simulation's say: builds the node of their extinction at a
   * place [1/m]. The layers then say between which altitudes they are, and how dense at most (`density`).
   */
  extinction?: (place: CloudSample) => Float
}

/** Viewpoint of a camera, from the planet's centre in the mapped space [m]. */
export const viewpointMapped = (
  { atmosphere, up, height }: AtmosphereView,
  target: Vector3
): Vector3 => target.copy(up).multiplyScalar(atmosphere.parameters.bottomRadius + height)

/**
 * Map from a displacement [m] in the mapped space to a place in a lattice of noise, in its periods: the three
 * rows of a matrix, each with the place that displacements start from, in [0, 1).
 *
 * @param layerRotation - Rotation from the mapped space to the frame that drifts with the layer.
 * @param rotation - Rotation from there to the lattice.
 * @param from - Start of displacements, from the planet's centre [m].
 * @param across - Factor along the layer frame's x and y, which draws noise out [–].
 */
function latticeRows(
  layerRotation: Quaternion,
  rotation: Quaternion,
  period: number,
  from: Vector3,
  across: number
): number[][] {
  _matrix
    .makeRotationFromQuaternion(rotation)
    .scale(_stretch.set(across, across, 1))
    .multiply(_rotationMatrix.makeRotationFromQuaternion(layerRotation))
  const { elements: e } = _matrix
  const start = _point.copy(from).applyMatrix4(_matrix).divideScalar(period).toArray()
  return start.map((v, row) => [
    e[row] / period,
    e[row + 4] / period,
    e[row + 8] / period,
    v - Math.floor(v)
  ])
}

/**
 * The field of clouds as shaders see it: layers, weather and wind as uniforms, and noise.
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
  /** Light of moon and night sky on clouds. */
  readonly night = new NightLight()
  /** Factor on the light of sky and ground on clouds: see `CloudsNode.ambient`. */
  readonly ambient = number(1)
  /** Radius of the sphere at altitude 0 [m]. */
  readonly radius = number()
  /** Angle between neighbouring samples, that of a pixel or more: sets the level of detail [rad]. */
  readonly pixelAngle = number(1e-3)
  /**
   * Scaled optical depth over optical depth: `CloudLight.depthScale` where there is such a light. Unresolved clouds let through as much
   * light as resolved ones by it [–].
   */
  readonly depthScale = number(1)
  /**
   * Part of the likely distance to clouds that a march steps over at once, in [0, 1]. Below 1 it also samples where the weather on large
   * scales rules clouds out: for reference pictures, which must not share the assumption that they judge [–].
   */
  readonly skipping = number(1)
  /** All layers' parameters and anchors: see tsl/layer.ts for what lies where. */
  readonly values: Vector4[] = Array.from(
    { length: CloudLayers.maxLayers * LAYER_STRIDE },
    () => new Vector4()
  )
  readonly array = vec4Array(this.values)
  readonly textures: Readonly<Record<NoiseName, LevelTexture<Vec3>>>
  /** Cloud cover of the whole planet; shared, not owned. */
  readonly worldMap: CloudWorldMap | null
  /** Mapped space's axial ratio a/b of the ellipsoid, for geodetic latitudes. */
  readonly axialRatio: number
  /** See {@link CloudFieldOptions.extinction}. */
  readonly extinction: CloudFieldOptions['extinction']
  /** Kinds of the layers for which a shader is compiled; left out, for any. See `compiledByKinds`. */
  readonly kinds?: string
  readonly #ownsNoise: boolean
  /** Rotation of each layer's noise about the planet's centre: the wind's work. */
  readonly rotations: readonly Quaternion[] = Array.from(
    { length: CloudLayers.maxLayers },
    (_, i) => layerRotation(i)
  )
  /** Displacement of each layer at the camera since the update before, in the mapped space [m]. */
  readonly drifts: readonly Vector3[] = this.rotations.map(() => new Vector3())
  #seconds: number | null = null
  /** Share of their coverage that layers have, in [0, 1]: 0 until there is noise. */
  fadeIn = 0
  /** Gain of `fadeIn` in a frame. */
  #fadeInStep = 1

  /**
   * @param view - Nodes of the camera that samples are seen from.
   * @param where - The class that errors name.
   * @throws If the atmosphere or the layers are missing, or the map does not repeat.
   */
  constructor(
    atmosphere: Atmosphere,
    layers: CloudLayers,
    view: ViewNodes = viewNodes(atmosphere),
    options: CloudFieldOptions = {},
    where = 'CloudField'
  ) {
    checkAtmosphere(where, atmosphere)
    if (!(layers instanceof CloudLayers)) fail(where, 'layers must be CloudLayers', layers)
    const names = ['worldMap', 'noise', 'extinction'] as const
    const { worldMap = null, noise, extinction } = checkOptions(where, options, ...names)
    // Known by its method: importing its class would put that into every bundle.
    if (worldMap !== null && !worldMap?.coverageAt) {
      fail(where, 'worldMap must be a CloudWorldMap or null', worldMap)
    }
    if (noise !== undefined && !(noise instanceof CloudNoise)) {
      fail(where, 'noise must be a CloudNoise', noise)
    }
    this.atmosphere = atmosphere
    this.layers = layers
    this.view = view
    this.#ownsNoise = noise === undefined
    this.noise = noise ?? new CloudNoise()
    const node = (name: NoiseName): LevelTexture<Vec3> =>
      texture3D(this.noise[name].target.texture) as unknown as LevelTexture<Vec3>
    this.textures = { shape: node('shape'), detail: node('detail'), weather: node('weather') }
    this.worldMap = worldMap
    this.extinction = extinction
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
    const now = Number.isFinite(seconds) ? seconds : (this.#seconds ?? 0)
    const elapsed = now - (this.#seconds ?? now)
    this.#seconds = now
    this.fadeIn = this.isReady ? Math.min(this.fadeIn + this.#fadeInStep, 1) : 0
    this.radius.value = bottomRadius
    this.night.update(view)
    viewpointMapped(view, _position)
    _subpoint.copy(view.up).multiplyScalar(bottomRadius)
    for (let i = 0; i < this.layers.length; i++) {
      this.drifts[i].set(0, 0, 0)
      if (elapsed !== 0) this.#drift(i, view.up, elapsed)
      this.#write(i, view.up)
    }
    for (let i = this.layers.length; i < CloudLayers.maxLayers; i++) {
      this.values[i * LAYER_STRIDE].set(0, 0, 0, 0)
    }
  }

  /** Turns a layer against its wind: the noise is looked up where the air came from. */
  #drift(index: number, up: Vector3, elapsed: number): void {
    const { wind, baseAltitude } = this.layers.at(index).parameters
    const radius = this.atmosphere.parameters.bottomRadius + baseAltitude
    this.rotations[index].multiply(windRotation(wind, up, elapsed, radius, _rotation)).normalize()
    _point.copy(up).multiplyScalar(radius)
    this.drifts[index].copy(_point).sub(_point.applyQuaternion(_rotation))
  }

  /**
   * Copies a layer's parameters, and its anchors for the camera and the point of the ground below it: what
   * `layerAt` reads.
   */
  #write(index: number, up: Vector3): void {
    const { parameters } = this.layers.at(index)
    const { baseAltitude, baseRelief, weatherWeights, openCells } = parameters
    const periods = layerPeriods(parameters)
    const scales = weatherScales(weatherWeights, this.worldMap?.coversPlanet === true, openCells)
    const { stretch, edge, coarseness } = layerForms(parameters)
    const column = meanColumnOf(parameters, this.depthScale.value)
    const bend = parameters.turbulence * billowForm.bend * periods.shape
    const lattice = (rotation: Quaternion, period: number, from: Vector3, across = 1): number[][] =>
      latticeRows(this.rotations[index], rotation, period, from, across)
    const { weather, mesoscale, region, shape, detail, fields } = latticeRotations
    const vectors = [
      [
        baseAltitude,
        1 / (parameters.topAltitude - baseAltitude),
        parameters.coverage * this.fadeIn,
        parameters.density
      ],
      [
        parameters.profileExponent,
        parameters.shapeAmount,
        parameters.detailAmount,
        1 / periods.shape
      ],
      scales.clouds,
      ...lattice(shape, periods.shape, _position, 1 / stretch),
      ...lattice(detail, periods.detail, _position, 1 / stretch),
      // The weather is the same all the way up: it is looked up at the subpoint.
      ...lattice(weather, periods.weather, _subpoint),
      ...lattice(fields, periods.weather * noisePeriods.fields, _subpoint),
      ...lattice(region, noisePeriods.regions, _subpoint),
      [...windAxis(parameters.wind, up, _axis).multiplyScalar(parameters.shear), bend],
      [scales.cells, scales.regions, scales.planet, scales.cloudVariance],
      [column.columnDensity, column.insideDensity, column.profileMean, parameters.densityGrowth],
      [1 / edge, coarseness, parameters.anvil, parameters.shadow ? 1 : 0],
      [1 / periods.weather, 1 / periods.detail, column.fullDensity, parameters.shear],
      [1 / (baseRelief || 1), baseRelief === 0 ? 0 : heightForm.relief, 0, 0],
      ...lattice(mesoscale, noisePeriods.mesoscale, _subpoint)
    ]
    vectors.forEach((vector, i) => this.values[index * LAYER_STRIDE + i].fromArray(vector))
  }

  /** True once there is all the noise that the clouds need. */
  get isReady(): boolean {
    return this.extinction ? true : this.noise.isReady
  }

  /**
   * Draws missing noise: `CloudNoise.update`. Until that is done, the sky is clear. Then clouds are there
   * at once, or grow over some frames if the noise was drawn over several.
   */
  bake(renderer: Renderer, slices = Infinity): boolean {
    if (this.extinction) return true
    if (!this.noise.isReady) this.#fadeInStep = slices === Infinity ? 1 : FADE_IN_STEP
    return this.noise.update(renderer, slices)
  }

  /** Frees the noise if it is the field's own. */
  dispose(): void {
    if (this.#ownsNoise) this.noise.dispose()
  }
}
