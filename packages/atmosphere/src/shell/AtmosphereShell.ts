import {
  BackSide,
  CustomBlending,
  IcosahedronGeometry,
  Matrix3,
  Matrix4,
  Mesh,
  OneFactor,
  OneMinusSrcAlphaFactor,
  Plane,
  Vector2,
  Vector3
} from 'three'
import type { Camera, DirectionalLight, Light, PointLight, BufferGeometry } from 'three'
import {
  If,
  cameraProjectionMatrix,
  modelViewMatrix,
  positionLocal,
  texture,
  uniform,
  vec4
} from 'three/tsl'
import { Node, NodeMaterial, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame, Renderer } from 'three/webgpu'
import { checkChoice, checkOptions, checkPositive, fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkParameters, type AtmosphereParameters } from '../parameters/AtmosphereParameters'
import type { AtmosphereTables } from '../tables/AtmosphereTables'
import { AtmosphereUniforms } from '../air/AtmosphereUniforms'
import { eyeScalars } from '../view/cpu/eye'
import { sunWhite } from '../ground/cpu/reflectance'
import { checkRenderer } from '../view/renderers'
import { giveTablesBack, takeTables } from '../tables/sharedTables'
import { EyeUniforms, SkyVolumes } from '../skyVolume/SkyVolumes'
import { ProfileUniforms } from './tsl/chapman'
import type { Air } from '../scattering/tsl/scattering'
import { shellFragment, type ShellPlace, type Way } from './tsl/shell'
import { tableShell, volumeShell, type Shell } from './tsl/shellMarch'
import { singleScatteringShell } from './tsl/singleScattering'
import type { Bool, Vec4 } from '../tsl-types'

/** Where a shell's light comes from. */
export type ShellSun = Atmosphere | DirectionalLight | PointLight | Vector3

/** Options of {@link AtmosphereShell}. */
export interface AtmosphereShellOptions {
  /**
   * The sun. An atmosphere's; or a light, whose colour and intensity then are those of the sun above the
   * air; or a direction in world space, which may be changed in place. Default: (1, √2, 1).
   */
  sun?: ShellSun
  /**
   * `'tables'`, the default: all orders of scattering, from tables that are baked on first use, once for
   * all shells of the same `parameters` object.
   * `'single-scattering'`: sunlight scattered once, without any texture; skies are darker and bluer, and
   * dark soon after sunset.
   */
  model?: 'tables' | 'single-scattering'
  /** Output per luminance where the sun is a direction [1/(cd/m²)]. */
  luminanceScale?: number
}

/** Segments of the march on the tables, two points each. */
const TABLE_STEPS = 8

/**
 * Radii from which on the air is marched instead of read from a volume: a body that far off has few
 * pixels, and float32 no elevations for them in a volume.
 */
const FAR = 20

/** Scale that the colour matrix is computed with; `tint` makes it any other. */
const SCALE = 1e-4

const _inverse = new Matrix4()
const _point = new Vector3()
const _other = new Vector3()
const _size = new Vector2()

/** A ball of triangles around the unit sphere: none of them cuts it. */
function ballAround(radius: number): BufferGeometry {
  const ball = new IcosahedronGeometry(1, 6)
  const position = ball.getAttribute('position')
  const plane = new Plane()
  const corners = [new Vector3(), new Vector3(), new Vector3()] as const
  let inner = 1
  for (let i = 0; i < position.count; i += 3) {
    corners.forEach((corner, k) => corner.fromBufferAttribute(position, i + k))
    inner = Math.min(inner, Math.abs(plane.setFromCoplanarPoints(...corners).constant))
  }
  ball.deleteAttribute('normal')
  ball.deleteAttribute('uv')
  ball.scale(radius / inner, radius / inner, radius / inner)
  return ball
}

const isAtmosphere = (sun: ShellSun): sun is Atmosphere => 'isAtmosphere' in sun
const isLight = (sun: ShellSun): sun is DirectionalLight | PointLight =>
  'isDirectionalLight' in sun || 'isPointLight' in sun

/** Also of what only claims to be one. */
function isSun(sun: ShellSun | null): boolean {
  if (typeof sun !== 'object' || sun === null) return false
  if (isAtmosphere(sun) || isLight(sun)) return true
  if (!('isVector3' in sun)) return false
  const length = sun.manhattanLength()
  return length > 0 && length < Infinity
}

/** Follows body, camera and sun, and has tables and volumes baked, whenever its shell is drawn. */
class ShellNode extends Node<'vec4'> {
  static get type(): string {
    return 'AtmosphereShellNode'
  }

  readonly #shell: AtmosphereShell
  readonly #output: Vec4

  constructor(shell: AtmosphereShell, output: Vec4) {
    super('vec4')
    this.#shell = shell
    this.#output = output
    this.updateBeforeType = NodeUpdateType.OBJECT
  }

  override updateBefore({ renderer, camera }: NodeFrame): undefined {
    if (renderer === null) return
    this.#shell.bake(renderer)
    if (camera !== null) this.#shell.see(renderer, camera)
  }

  override setup(): Node {
    return this.#output
  }
}

/**
 * A planet's air as a mesh, for scenes with no post pass and no sky background: a map, a game's body,
 * many small planets. A child of the body's mesh:
 *
 * ```ts
 * globe.add(new AtmosphereShell(new AtmosphereParameters(), 1, { sun: light }))
 * ```
 *
 * Seen from space it hazes the body and rims it, on the night side too; seen from inside it is the sky.
 * It follows its body, wherever that goes and however large it is, the camera and the sun by itself.
 * Works for perspective and orthographic cameras and every kind of depth buffer.
 *
 * The way through the air ends at the body's sphere, not at the scene's depth: what stands in front of
 * the middle of the way through the air (from outside, of the way to the ground or the lowest point), a
 * ship or a cockpit, is drawn without haze, and what is behind it with all of it; multisampling bares no
 * ground. One alpha dims all colours of what is behind alike.
 *
 * An eclipse of its sun does not dim it. That of a body without air is not `visible`, and draws nothing.
 *
 * It draws transparent, back faces only, premultiplied, writes no depth, and has `renderOrder` 1, after
 * a body's own transparent tiles. It casts no shadow and no ray hits it.
 */
export class AtmosphereShell extends Mesh<BufferGeometry, NodeMaterial> {
  /** What the air is made of; shared. Change it with `parameters.set(…)`. */
  readonly parameters: AtmosphereParameters
  /** Of the body, in its own units. */
  readonly bodyRadius: number
  #sun: ShellSun
  #luminanceScale: number
  readonly #isSingle: boolean
  /** An atmosphere that is its sun and of the same air: its tables serve the shell, too. */
  readonly #lender: Atmosphere | null
  /** Those of all shells of its parameters, or the lender's; null before it is drawn, or if single. */
  #tables: AtmosphereTables | null = null
  /** Its own, of a few slots, whoever the tables are of: seen from its body the eye is elsewhere. */
  #volumes: SkyVolumes | null = null
  #uniforms = new AtmosphereUniforms()
  /** What the tables are taken for. */
  #renderer: Renderer | null = null
  readonly #eye = new EyeUniforms()
  readonly #isMarched = uniform(1)
  readonly #profile = new ProfileUniforms()
  #version = -1
  readonly #height = uniform(0)
  readonly #up = uniform(new Vector3())
  readonly #sunDirection = uniform(new Vector3())
  readonly #viewToMapped = uniform(new Matrix3())
  readonly #tint = uniform(new Vector3(1, 1, 1))
  readonly #pixel = uniform(new Vector2())

  /**
   * @param parameters - What the air is made of. `bottomRadius` in metres is what `bodyRadius` stands for.
   * @param bodyRadius - Of the body, in units of the object that the shell is added to.
   * @throws If an argument is missing or out of its range.
   */
  constructor(
    parameters: AtmosphereParameters,
    bodyRadius: number,
    options: AtmosphereShellOptions = {}
  ) {
    const where = 'AtmosphereShell'
    checkParameters(where, parameters)
    checkPositive(where, 'bodyRadius', bodyRadius)
    checkOptions(where, options, 'sun', 'model', 'luminanceScale')
    const {
      sun = new Vector3(1, Math.SQRT2, 1),
      model = 'tables',
      luminanceScale = SCALE
    } = options
    checkChoice(where, 'model', model, ['tables', 'single-scattering'])
    super(
      ballAround((bodyRadius * parameters.topRadius) / parameters.bottomRadius),
      new NodeMaterial()
    )
    this.parameters = parameters
    this.bodyRadius = bodyRadius
    this.#sun = this.sun = sun
    this.#luminanceScale = this.luminanceScale = luminanceScale
    this.name = 'AtmosphereShell'
    this.renderOrder = 1
    this.visible = !parameters.isAirless

    this.#isSingle = model === 'single-scattering'
    const lends = !this.#isSingle && isAtmosphere(sun) && sun.parameters === parameters
    this.#lender = lends ? sun : null
    const { material } = this
    material.name = 'Welkin.AtmosphereShell'
    material.side = BackSide
    material.transparent = true
    material.depthWrite = false
    material.blending = CustomBlending
    material.blendSrc = material.blendSrcAlpha = OneFactor
    material.blendDst = material.blendDstAlpha = OneMinusSrcAlphaFactor
    // The colour is premultiplied already: three would do it again.
    material.premultipliedAlpha = false
    material.fog = false
    material.lights = false
    // Its depth is written by the fragments: let neither plane of the frustum clip it.
    const clip = cameraProjectionMatrix.mul(modelViewMatrix).mul(vec4(positionLocal, 1)).toVar()
    material.vertexNode = vec4(clip.xy, clip.w.mul(0.5), clip.w)
  }

  /** Draws with what a renderer has from now on. */
  #take(renderer: Renderer): void {
    if (renderer === this.#renderer) return
    checkRenderer('AtmosphereShell', renderer)
    this.#giveBack()
    this.#renderer = renderer
    const tables = this.#isSingle
      ? null
      : (this.#lender?.tables ?? takeTables(this.parameters, renderer, this))
    this.#tables = tables
    if (tables !== null) this.#uniforms = tables.uniforms
    const air: Air = {
      uniforms: this.#uniforms,
      transmittance: (tables &&
        texture(tables.transmittance.target.texture)) as Air['transmittance'],
      diffuse: tables && texture(tables.diffuseLight.target.texture)
    }
    const place: ShellPlace = {
      height: this.#height,
      up: this.#up,
      sunDirection: this.#sunDirection,
      viewToMapped: this.#viewToMapped,
      tint: this.#tint,
      pixel: this.#pixel
    }
    this.#volumes =
      tables &&
      new SkyVolumes(
        tables.uniforms,
        tables.transmittance.target,
        tables.diffuseLight.target,
        tables.volumes.segments
      )
    const { color, depth } = shellFragment(air, place, this.#light(air, this.#volumes))
    this.material.fragmentNode = new ShellNode(this, color)
    this.material.depthNode = depth
    this.material.needsUpdate = true
  }

  #giveBack(): void {
    this.#volumes?.dispose()
    this.#volumes = null
    if (this.#renderer === null || this.#tables === null) return
    if (this.#lender === null) giveTablesBack(this.parameters, this.#renderer, this)
    this.#tables = null
  }

  /** Comes before what its material is compiled from is looked at. */
  override onBeforeRender(renderer: unknown): void {
    this.#take(renderer as Renderer)
  }

  #light(air: Air, volumes: SkyVolumes | null): (way: Way) => Shell {
    if (volumes === null) return way => singleScatteringShell(air, this.#profile, way)
    const [molecular, aerosol] = volumes.light.textures.map(part => texture(part))
    const textures = { molecular, aerosol, depth: texture(volumes.depth.texture) }
    const isMarched = this.#isMarched.greaterThan(0) as Bool
    return way => {
      const radiance = vec4(0).toVar()
      const depth = vec4(0).toVar()
      If(isMarched, () => {
        const shell = tableShell(air, way, TABLE_STEPS)
        radiance.assign(shell.radiance)
        depth.assign(shell.depth)
      }).Else(() => {
        const shell = volumeShell(air.uniforms, textures, this.#eye, way.sight)
        radiance.assign(shell.radiance)
        depth.assign(shell.depth)
      })
      return { radiance, depth }
    }
  }

  /** Where the light comes from. Throws if set to anything else, or to a direction without one. */
  get sun(): ShellSun {
    return this.#sun
  }

  set sun(value: ShellSun) {
    if (!isSun(value)) {
      const rule =
        'sun must be an Atmosphere, a DirectionalLight, a PointLight or a finite direction'
      fail('AtmosphereShell', rule, value)
    }
    this.#sun = value
  }

  /** Output per luminance where the sun is a direction [1/(cd/m²)], positive. */
  get luminanceScale(): number {
    return this.#luminanceScale
  }

  set luminanceScale(value: number) {
    checkPositive('AtmosphereShell', 'luminanceScale', value)
    this.#luminanceScale = value
  }

  /** No ray hits air. */
  override raycast(): void {}

  /** Bakes the tables if they are stale. Drawing does this by itself. */
  bake(renderer: NonNullable<NodeFrame['renderer']>): void {
    const { parameters } = this
    this.#take(renderer)
    if (this.#lender !== null) {
      const { luminanceScale, bakeStepsPerFrame, tables } = this.#lender
      tables.update(renderer, parameters, luminanceScale, bakeStepsPerFrame)
    } else if (this.#tables !== null) {
      this.#tables.update(renderer, parameters, SCALE, Infinity)
    } else if (this.#version !== parameters.version) {
      this.#uniforms.update(parameters, SCALE)
      this.#profile.update(parameters)
      this.#version = parameters.version
    }
  }

  /** Sees where camera, body and sun are. Drawing does this by itself. */
  follow(camera: Camera): void {
    const { bottomRadius } = this.parameters
    _inverse.copy(this.matrixWorld).invert()
    const scale = bottomRadius / this.bodyRadius
    const up = this.#up.value.setFromMatrixPosition(camera.matrixWorld)
    up.applyMatrix4(_inverse).multiplyScalar(scale)
    const radius = up.length()
    this.#height.value = radius - bottomRadius
    if (radius > 0) up.divideScalar(radius)
    else up.set(0, 0, 1)
    this.#viewToMapped.value.setFromMatrix4(_inverse.clone().multiply(camera.matrixWorld))
    this.#viewToMapped.value.multiplyScalar(scale)
    this.#followSun()
  }

  /**
   * Sees that there is a sky volume for a camera, and follows it. Drawing does this by itself, after
   * {@link bake}.
   */
  see(renderer: NonNullable<NodeFrame['renderer']>, camera: Camera): void {
    this.follow(camera)
    // Rays of an orthographic camera do not start where it is.
    const isOrthographic = camera.projectionMatrixInverse.elements[11] === 0
    const rows = renderer.getRenderTarget()?.height ?? renderer.getDrawingBufferSize(_size).y
    const pixel = Math.SQRT2 / (camera.projectionMatrix.elements[5] * rows)
    const [x, y, z] = this.#viewToMapped.value.elements
    if (isOrthographic) this.#pixel.value.set(0, pixel * Math.hypot(x, y, z))
    else this.#pixel.value.set(pixel, 0)
    if (this.#volumes === null || this.#tables === null) return
    const { parameters } = this
    const { version } = this.#tables
    const height = this.#height.value
    const isFar = height > FAR * parameters.bottomRadius
    const isMarched = isOrthographic || isFar || version === 0
    this.#isMarched.value = isMarched ? 1 : 0
    if (isMarched) return
    const cosSun = Math.min(Math.max(this.#up.value.dot(this.#sunDirection.value), -1), 1)
    const eye = eyeScalars(parameters, height, cosSun)
    this.#eye.set(eye, this.#volumes.volumeFor(renderer, eye, version).slot)
  }

  #followSun(): void {
    const { sun } = this
    const direction = this.#sunDirection.value
    const tint = this.#tint.value.setScalar(1)
    _point.setFromMatrixPosition(this.matrixWorld)
    if (isAtmosphere(sun)) {
      direction.copy(sun.sunDirection)
      if (this.#lender !== sun) tint.setScalar(sun.luminanceScale / SCALE)
    } else if (isLight(sun)) {
      direction.setFromMatrixPosition(sun.matrixWorld)
      const { color, intensity } = sun as Light
      const white = sunWhite(this.parameters)
      tint.set(color.r / white[0], color.g / white[1], color.b / white[2])
      tint.multiplyScalar(intensity / SCALE)
      if ('target' in sun) direction.sub(_other.setFromMatrixPosition(sun.target.matrixWorld))
      else {
        direction.sub(_point)
        tint.divideScalar(direction.lengthSq() || 1)
      }
    } else {
      direction.copy(sun)
      tint.setScalar(this.luminanceScale / SCALE)
    }
    // The inverse of a matrix takes directions back; normals are not meant.
    direction.transformDirection(_inverse)
    if (!(direction.lengthSq() > 0)) direction.set(0, 1, 0)
  }

  /** Frees its geometry, material and volumes, and its tables if no other shell uses them. */
  override dispose(): void {
    this.geometry.dispose()
    this.material.dispose()
    this.#giveBack()
    this.#renderer = null
  }
}
