import { BackSide, CustomBlending, Mesh, OneFactor, OneMinusSrcAlphaFactor, Vector3 } from 'three'
import type { BufferGeometry, Camera } from 'three'
import {
  If,
  cameraProjectionMatrix,
  modelViewMatrix,
  positionLocal,
  uniform,
  vec4
} from 'three/tsl'
import { NodeMaterial } from 'three/webgpu'
import type { NodeFrame, Renderer } from 'three/webgpu'
import { checkChoice, checkOptions, checkPositive, fail, setOptions } from '@welkin/geo'
import { checkParameters, type AtmosphereParameters } from '../parameters/AtmosphereParameters'
import { checkTables, type AtmosphereTables } from '../tables/AtmosphereTables'
import { AtmosphereUniforms } from '../air/AtmosphereUniforms'
import { viewpointScalars } from '../view/cpu/viewpoint'
import { checkRenderer } from '../view/renderers'
import { sharedTables } from '../tables/sharedTables'
import { ViewpointUniforms, SkyVolumes } from '../skyVolume/SkyVolumes'
import { TableAtlas } from '../tables/TableAtlas'
import { circumscribedSphere } from './circumscribedSphere'
import { ShellNode } from './ShellNode'
import { isAtmosphere, isShellSun, SHELL_SCALE, sunlightAt, type ShellSun } from './ShellSun'
import { isOrthographic, ShellUniforms } from './ShellUniforms'
import { ProfileUniforms } from './tsl/chapman'
import type { Air } from '../scattering/tsl/ray'
import { shellFragment } from './tsl/shell'
import { marchedShellLight } from './tsl/shellMarch'
import { sampleAir, type MediumSegment } from '../skyVolume/tsl/skyVolume'
import { singleScatteringLight } from './tsl/singleScattering'
import type { ViewSegment } from './tsl/viewSegment'
import type { Bool } from '../tsl-types'
import type { AirShadows, MeshShadows } from '../view/AirShadows'

/** Options of {@link AtmosphereShell}. */
export interface AtmosphereShellOptions {
  /**
   * The sun: an atmosphere's; or a light, with the colour and intensity of sunlight above the air; or a
   * direction in world space, which may be changed in place. Default: (1, √2, 1).
   */
  sun?: ShellSun
  /**
   * Scattering model. `'tables'`, the default: all orders of scattering, from tables baked on first use,
   * once for all shells of the same `parameters` object. `'single-scattering'`: sunlight scattered once,
   * without any texture; skies are darker and bluer, and dark soon after sunset.
   */
  model?: 'tables' | 'single-scattering'
  /**
   * Tables of an atmosphere of the same `parameters` object, to share: `atmosphere.tables`. By default its
   * own if it is the sun, else those of all shells of that object.
   */
  tables?: AtmosphereTables
  /**
   * Shadows in its air for their camera, as `lightShafts` makes them, while their atmosphere is the sun. It has the same
   * `parameters` object, and its planet is where the body is. For the model `'tables'` alone.
   */
  shafts?: AirShadows
  /** Output per luminance where the sun is a direction, > 0, default 1e-4 [1/(cd/m²)]. */
  luminanceScale?: number
}

const SETTINGS = ['sun', 'luminanceScale'] as const

/** Steps of the march on the tables, two points each. */
const TABLE_STEPS = 8

/**
 * Height in radii of the body above which its air is marched instead of read from a volume: it covers few
 * pixels, and float32 cannot tell a volume's elevations apart.
 */
const FAR_HEIGHT = 20

const _body = new Vector3()
const _sunDirection = new Vector3()

/** Material of a shell: premultiplied, transparent, back faces only. */
function shellMaterial(): NodeMaterial {
  const material = new NodeMaterial()
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
  // Fragments write the depth: neither plane of the frustum may clip the mesh.
  const clip = cameraProjectionMatrix.mul(modelViewMatrix).mul(vec4(positionLocal, 1)).toVar()
  material.vertexNode = vec4(clip.xy, clip.w.mul(0.5), clip.w)
  return material
}

/**
 * A planet's air as a mesh, for scenes with no post pass and no sky background: a map, a game's body,
 * many small planets. A child of the body's mesh:
 *
 * ```ts
 * globe.add(new AtmosphereShell(new AtmosphereParameters(), 1, { sun: light }))
 * ```
 *
 * Seen from space it is haze over the body and a rim of light around it, on the night side too; seen from
 * inside it is the sky. It follows the body (of any size), the camera and the sun by itself, for
 * perspective and orthographic cameras and every kind of depth buffer.
 *
 * View rays end at the body's sphere, not at the scene's depth. Objects in front of the middle of a ray's
 * part in the air, such as a ship or a cockpit, are drawn without haze, objects behind it with all of it.
 * One alpha dims all colours of the background alike. Eclipses of its sun do not dim it. With `shafts` shadows fall into it.
 *
 * A shell of a body without air is not `visible`, and draws nothing.
 *
 * The mesh is transparent and premultiplied, draws back faces only, writes no depth, and has `renderOrder`
 * 1, after a body's own transparent tiles. It casts no shadow and raycasts miss it.
 */
export class AtmosphereShell extends Mesh<BufferGeometry, NodeMaterial> {
  /** Parameters of the air, shared. Change them with `parameters.set(…)`. */
  readonly parameters: AtmosphereParameters
  /** Radius of the body in its own units. */
  readonly bodyRadius: number
  #sun: ShellSun = new Vector3(1, Math.SQRT2, 1)
  #luminanceScale = SHELL_SCALE
  /** See {@link AtmosphereShellOptions}. */
  readonly model: 'tables' | 'single-scattering'
  /** Tables of an atmosphere; null for those of all shells of its parameters, and without tables. */
  readonly #given: AtmosphereTables | null
  /** Tables that it uses; null before drawing or without tables. */
  #tables: AtmosphereTables | null = null
  /** Sky volumes of its own: relative to its body the camera is elsewhere than in the lender's. */
  #volumes: SkyVolumes | null = null
  #uniforms = new AtmosphereUniforms()
  readonly #shafts: AirShadows | undefined
  /** Shadows in its air as pixels have them, while it has a renderer. */
  #shadows: MeshShadows | undefined
  /** Renderer that tables and volumes are acquired for. */
  #renderer: Renderer | null = null
  readonly #viewpoint = new ViewpointUniforms()
  readonly #isMarched = uniform(1)
  readonly #profile = new ProfileUniforms()
  #version = -1
  readonly #view = new ShellUniforms()

  /**
   * @param parameters - Parameters of the air, whose `bottomRadius` [m] corresponds to `bodyRadius`.
   * @param bodyRadius - Radius of the body, in units of the object that the shell is added to.
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
    checkOptions(where, options, 'model', 'tables', 'shafts', ...SETTINGS)
    const { model = 'tables', tables, shafts, ...settings } = options
    checkChoice(where, 'model', model, ['tables', 'single-scattering'])
    const lit = shafts?.atmosphere
    const fits = model === 'tables' && lit?.parameters === parameters && shafts?.source === lit.sun
    if (shafts && !(fits && shafts.onMesh))
      fail(
        where,
        'shafts must be forwardShafts of the sun, of these parameters, for tables',
        shafts
      )
    super(
      circumscribedSphere((bodyRadius * parameters.topRadius) / parameters.bottomRadius),
      shellMaterial()
    )
    this.parameters = parameters
    this.bodyRadius = bodyRadius
    this.#shafts = shafts
    this.set({ sun: lit, ...settings })
    this.name = 'AtmosphereShell'
    this.renderOrder = 1
    this.visible = !parameters.isAirless

    this.model = model
    const { sun } = this
    const lends = isAtmosphere(sun) && sun.parameters === parameters
    const given = tables ?? (lends ? sun.tables : null)
    if (given !== null) checkTables(where, given, parameters)
    this.#given = model === 'tables' ? given : null
  }

  /** Acquires tables and volumes of a renderer, and builds the material from them. */
  #acquire(renderer: Renderer): void {
    if (renderer === this.#renderer) return
    checkRenderer('AtmosphereShell', renderer)
    this.#release()
    this.#renderer = renderer
    const isBaked = this.model === 'tables'
    const tables = isBaked ? (this.#given ?? sharedTables(this.parameters, renderer)) : null
    this.#tables = tables
    const uniforms = (this.#uniforms = tables?.uniforms ?? this.#uniforms)
    // Single scattering reads no table.
    const air: Air = tables?.air ?? { uniforms, transmittance: null as never, diffuse: null }
    this.#volumes =
      tables &&
      new SkyVolumes(
        tables.air,
        new TableAtlas('Welkin.AtmosphereShell', 1, 1),
        undefined,
        tables.volumes.segments
      )
    this.#shadows = this.#shafts?.onMesh?.()
    this.#shadows?.compileWith(this.material)
    const { color, depth } = shellFragment(
      air,
      this.#view,
      this.#light(air, this.#volumes),
      this.#shadows
    )
    const fragmentNode = new ShellNode(this, color)
    Object.assign(this.material, { fragmentNode, depthNode: depth, needsUpdate: true })
  }

  #release(): void {
    this.#volumes?.dispose()
    this.#volumes?.atlas.dispose()
    this.#volumes = null
    this.#shadows?.dispose?.()
    this.#tables?.release(this)
    this.#tables = null
  }

  /** Acquires tables before three looks at the material. */
  override onBeforeRender(renderer: unknown): void {
    this.#acquire(renderer as Renderer)
  }

  /** Light of a segment: from the sky volume, marched on the tables, or scattered once. */
  #light(air: Air, volumes: SkyVolumes | null): (segment: ViewSegment) => MediumSegment {
    if (volumes === null) return segment => singleScatteringLight(air, this.#profile, segment)
    const isMarched = this.#isMarched.greaterThan(0) as Bool
    return segment => {
      const light = { radiance: vec4(0).toVar(), depth: vec4(0).toVar() }
      const take = ({ radiance, depth }: MediumSegment): void => {
        light.radiance.assign(radiance)
        light.depth.assign(depth)
      }
      const scatter = this.#shadows?.scatterAlong(segment.entry)
      If(isMarched, () => take(marchedShellLight(air, segment, TABLE_STEPS, scatter))).Else(() => {
        const lit = sampleAir(air.uniforms, volumes.atlas, this.#viewpoint, segment.fromCamera)
        take(lit)
      })
      return light
    }
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or refused; then nothing has changed.
   */
  set(settings: Pick<AtmosphereShellOptions, (typeof SETTINGS)[number]>): this {
    return setOptions('AtmosphereShell', this, settings, ...SETTINGS)
  }

  /** Source of light. @throws If set to anything else, or to a direction of length 0. */
  get sun(): ShellSun {
    return this.#sun
  }

  set sun(value: ShellSun) {
    if (!isShellSun(value)) {
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

  /** Raycasts miss air. */
  override raycast(): void {}

  /** Bakes the tables if they are stale. Drawing does this by itself. */
  bake(renderer: NonNullable<NodeFrame['renderer']>): void {
    const { parameters } = this
    this.#acquire(renderer)
    if (this.#tables !== null) this.#tables.update(renderer, this)
    else if (this.#version !== parameters.version) {
      this.#uniforms.update(parameters, SHELL_SCALE)
      this.#profile.update(parameters)
      this.#version = parameters.version
    }
  }

  /** Updates uniforms and sky volume for a camera. Drawing does this by itself, after {@link bake}. */
  update(renderer: NonNullable<NodeFrame['renderer']>, camera: Camera, frame?: NodeFrame): void {
    const { bottomRadius } = this.parameters
    const scale = bottomRadius / this.bodyRadius
    this.#view.setCamera(renderer, camera, this.matrixWorld, bottomRadius, scale)
    this.#updateSun()
    if (this.#volumes !== null && this.#tables !== null) {
      this.#updateVolume(renderer, camera, this.#volumes, this.#tables.version)
    }
    if (frame) this.#shadows?.prepareMesh(frame, this.sun, this.#isMarched.value > 0)
  }

  #updateSun(): void {
    const { sun, parameters, luminanceScale } = this
    const tint = this.#view.tint.value
    _body.setFromMatrixPosition(this.matrixWorld)
    sunlightAt(sun, parameters, _body, luminanceScale, _sunDirection, tint)
    // Tables have the scale of their atmosphere.
    tint.multiplyScalar(SHELL_SCALE / (this.#tables?.luminanceScale ?? SHELL_SCALE))
    this.#view.setSun(_sunDirection, this.matrixWorld)
  }

  #updateVolume(
    renderer: NonNullable<NodeFrame['renderer']>,
    camera: Camera,
    volumes: SkyVolumes,
    tablesVersion: number
  ): void {
    const { parameters } = this
    const height = this.#view.height.value
    const isFar = height > FAR_HEIGHT * parameters.bottomRadius
    const isMarched = isOrthographic(camera) || isFar || tablesVersion === 0
    this.#isMarched.value = isMarched ? 1 : 0
    if (isMarched) return
    const cosLight = this.#view.up.value.dot(this.#view.sunDirectionMapped.value)
    const viewpoint = viewpointScalars(parameters, height, Math.min(Math.max(cosLight, -1), 1))
    this.#viewpoint.set(viewpoint, volumes.volumeFor(renderer, viewpoint, tablesVersion))
  }

  /** Frees geometry, material and volumes, and the tables if no other shell uses them. */
  override dispose(): void {
    this.geometry.dispose()
    this.material.dispose()
    this.#release()
    this.#renderer = null
  }
}
