import { aerialPerspectiveTo, AtmosphereNode, linearSRGB } from '@welkin/atmosphere'
import type { Atmosphere } from '@welkin/atmosphere'
import { Vector2 } from 'three'
import type { Camera, PerspectiveCamera, Texture } from 'three'
import {
  Fn,
  If,
  float,
  getViewPosition,
  isBackgroundDepth,
  logarithmicDepthToViewZ,
  screenCoordinate,
  uniform,
  uv,
  vec2,
  vec4
} from 'three/tsl'
import type { Node, NodeBuilder, NodeFrame, Renderer } from 'three/webgpu'
import { CloudField } from './CloudField'
import type { CloudLayers } from './CloudLayers'
import { CloudLightTable } from './CloudLightTable'
import type { CloudNoise } from './CloudNoise'
import {
  QualityUniforms,
  resolveQuality,
  type CloudQuality,
  type CloudQualityName
} from './quality'
import { marchClouds } from './tsl/march'
import { FAR_AWAY } from './tsl/shells'
import type { Float, Vec3, Vec4 } from './tsl-types'

const _size = new Vector2()

/** Options of {@link clouds}. */
export interface CloudsOptions {
  /** How finely clouds are marched; by default `'high'`. */
  quality?: CloudQualityName | CloudQuality
  /** Cloud cover of the whole planet: see `CloudFieldOptions`. */
  worldMap?: Texture | null
  /** Noise to share between nodes; left out, the node makes and owns its own. */
  noise?: CloudNoise
  /** Light table to share between nodes; left out, the node makes and owns its own. */
  light?: CloudLightTable
}

/**
 * Volumetric clouds as a post effect: marched along each line of sight to what was drawn, lit by the
 * atmosphere's sun, sky and ground, with the air in front of them.
 *
 * ```ts
 * const scenePass = pass(scene, camera, { samples: 0 })
 * const depth = scenePass.getTextureNode('depth')
 * const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
 * pipeline.outputNode = clouds(air, depth, camera, atmosphere, cloudPreset('fairWeather'))
 * ```
 *
 * Layers may be changed at any time. What is transparent and writes no depth is taken to be where the
 * things behind it are. Knows standard, reversed and logarithmic depth.
 */
export class CloudsNode extends AtmosphereNode {
  static get type(): string {
    return 'CloudsNode'
  }

  /** What was drawn, air and sky included: linear colour. */
  colorNode: Node
  /** Its depth, as the renderer writes it. */
  depthNode: Node
  /** The camera that drew it. */
  readonly camera: PerspectiveCamera
  readonly field: CloudField
  readonly light: CloudLightTable
  /** Time, by which clouds drift [s]; null for the renderer's clock. */
  time: number | null = null
  readonly #ownsLight: boolean
  readonly #uniforms = new QualityUniforms()
  readonly #projectionInverse
  readonly #near = uniform(0.1)
  readonly #far = uniform(1000)
  #quality: CloudQuality

  /** @throws If an argument is missing or of the wrong kind. */
  constructor(
    colorNode: Node,
    depthNode: Node,
    camera: Camera,
    atmosphere: Atmosphere,
    layers: CloudLayers,
    { quality = 'high', worldMap = null, noise, light }: CloudsOptions = {}
  ) {
    super(atmosphere, camera)
    for (const [name, value] of Object.entries({ colorNode, depthNode, camera })) {
      if (value === undefined || value === null) {
        throw new Error(`CloudsNode: ${name} is missing, got ${value}`)
      }
    }
    if (!isPerspective(camera)) {
      throw new Error(`CloudsNode: camera must be a PerspectiveCamera, got ${camera.type}`)
    }
    this.colorNode = colorNode
    this.depthNode = depthNode
    this.camera = camera
    this.#quality = resolveQuality(quality)
    this.field = new CloudField(atmosphere, layers, this.view, { worldMap, noise })
    this.light = light ?? new CloudLightTable()
    this.#ownsLight = light === undefined
    this.#projectionInverse = uniform(camera.projectionMatrixInverse)
  }

  /** How finely clouds are marched. */
  get quality(): CloudQuality {
    return this.#quality
  }

  /** @throws If a parameter is out of its range. */
  set quality(quality: CloudQualityName | CloudQuality) {
    this.#quality = resolveQuality(quality)
  }

  override updateBefore(frame: NodeFrame): undefined {
    super.updateBefore(frame)
    if (frame.renderer !== null) this.field.bake(frame.renderer)
    this.light.bake()
  }

  override update(frame: NodeFrame): undefined {
    super.update(frame)
    const { camera, field } = this
    this.#near.value = camera.near
    this.#far.value = camera.far
    this.#uniforms.set(this.#quality)
    if (frame.renderer !== null) field.pixelAngle.value = pixelAngle(frame.renderer, camera)
    const view = this.atmosphere.viewOf(camera)
    if (view !== undefined) field.update(view, this.time ?? frame.time)
  }

  override setup(builder: NodeBuilder): Node {
    const { logarithmicDepthBuffer: isLogarithmic } = builder.renderer as Renderer & {
      logarithmicDepthBuffer: boolean
    }
    const position = (depth: Float): Vec3 => getViewPosition(uv(), depth, this.#projectionInverse)

    return Fn(() => {
      const color = vec4(this.colorNode as Vec4).toConst()
      const depth = float((this.depthNode as Vec4).r).toConst() as Float
      // Any depth that is neither near nor far gives the direction.
      const middle = position(float(0.5)).toConst() as Vec3
      const direction = this.view.toMapped(middle).normalize().toConst() as Vec3
      const end = float(FAR_AWAY).toVar()
      If(isBackgroundDepth(depth).not(), () => {
        const at = isLogarithmic
          ? middle.mul(logarithmicDepthToViewZ(depth, this.#near, this.#far).div(middle.z))
          : position(depth)
        end.assign(this.view.toMapped(at).length())
      })
      const marched = marchClouds(this.field, this.light.nodes, this.#uniforms, {
        direction,
        end,
        jitter: interleavedNoise()
      })
      const opacity = marched.transmittance.oneMinus().toConst()
      const result = color.toVar()
      If(opacity.greaterThan(0), () => {
        const reach = marched.distance.div(this.view.toMapped(middle).length())
        const air = aerialPerspectiveTo(this.view, middle.mul(reach))
        const light = linearSRGB(this.view.air.uniforms, marched.radiance)
        const added = light.mul(air.transmittance).add(air.inScatter.mul(opacity))
        result.assign(
          vec4(
            color.rgb.mul(marched.transmittance).add(added),
            color.a.mul(marched.transmittance).add(opacity)
          )
        )
      })
      return result
    })()
  }

  /** Frees the noise and the light table if they are the node's own. */
  override dispose(): void {
    this.field.dispose()
    if (this.#ownsLight) this.light.dispose()
    super.dispose()
  }
}

function isPerspective(camera: Camera): camera is PerspectiveCamera {
  return (camera as PerspectiveCamera).isPerspectiveCamera
}

/** Angle between the lines of sight of neighbouring pixels in the middle of the picture [rad]. */
function pixelAngle(renderer: Renderer, camera: PerspectiveCamera): number {
  const target = renderer.getRenderTarget()
  const height = target === null ? renderer.getDrawingBufferSize(_size).y : target.height
  return 2 / (camera.projectionMatrix.elements[5] * Math.max(height, 1))
}

/**
 * A pattern of [0, 1) in which any 3×3 pixels are evenly spread.
 *
 * @see Jimenez 2014, "Next generation post processing in Call of Duty: Advanced Warfare"
 */
function interleavedNoise(): Float {
  const across = screenCoordinate.xy.floor().dot(vec2(0.06711056, 0.00583715))
  return across.fract().mul(52.9829189).fract().toConst()
}

/** Volumetric clouds as a post effect: see {@link CloudsNode}. */
export const clouds = (
  color: Node,
  depth: Node,
  camera: Camera,
  atmosphere: Atmosphere,
  layers: CloudLayers,
  options: CloudsOptions = {}
): CloudsNode => new CloudsNode(color, depth, camera, atmosphere, layers, options)
