import { Matrix4, Vector2, Vector4, VSMShadowMap } from 'three'
import type { DepthTexture, DirectionalLight, DirectionalLightShadow, RenderTarget } from 'three'
import { CSMShadowNode, type CSMShadowNodeData } from 'three/addons/csm/CSMShadowNode.js'
import { vec2, vec3 } from 'three/tsl'
import { ShadowNode } from 'three/webgpu'
import type { Node, NodeBuilder, NodeFrame } from 'three/webgpu'
import { fail } from '@welkin/geo'
import type { Vec3 } from '../tsl-types'

type Filter = (inputs: FilterInputs) => Node

interface FilterInputs {
  readonly filterFn: Filter
  readonly shadowCoord: Vec3
  readonly shadow: { readonly mapSize: Vector2; readonly radius: number }
}

interface Targets {
  readonly shadowMap: RenderTarget
  readonly depthTexture: DepthTexture
}

/** `ShadowNode` with what @types/three leaves out. */
type OpenShadowNode = ShadowNode & {
  readonly shadowMap: RenderTarget
  setup(builder: NodeBuilder): Node | null | undefined
  setupRenderTarget(shadow: object, builder: NodeBuilder): Targets
  setupShadowFilter(builder: NodeBuilder, inputs: FilterInputs): Node
  renderShadow(frame: NodeFrame): void
}
const BaseShadowNode = ShadowNode as unknown as new (
  light: object,
  shadow: DirectionalLightShadow
) => OpenShadowNode

/** `CSMShadowNode` with what @types/three leaves out. */
type OpenCascades = CSMShadowNode & {
  _shadowNodes: Node[]
  _init(builder: NodeBuilder): void
}
const BaseCascades = CSMShadowNode as unknown as new (
  light: DirectionalLight,
  data: CSMShadowNodeData
) => OpenCascades

/** Shadow map that cascades share, one tile each. */
class Atlas {
  readonly columns: number
  readonly rows: number
  /** Size of all of it [texels]. */
  readonly size = new Vector2()
  targets: Targets | null = null

  constructor(count: number) {
    this.columns = Math.ceil(Math.sqrt(count))
    this.rows = Math.ceil(count / this.columns)
  }

  setTileSize({ width, height }: Vector2): void {
    this.size.set(this.columns * width, this.rows * height)
  }
}

/** Shadow of one cascade, in its tile. */
class CascadeShadowNode extends BaseShadowNode {
  static get type(): string {
    return 'CascadeShadowNode'
  }

  readonly #cascade: DirectionalLightShadow
  readonly #atlas: Atlas
  readonly #index: number
  /** Column and row of the tile, from the top left. */
  readonly #tile: Vector2
  /** The shadow as filters see it: their texels are the atlas's. */
  readonly #filtered

  constructor(light: object, cascade: DirectionalLightShadow, atlas: Atlas, index: number) {
    super(light, cascade)
    const { columns, rows } = atlas
    const tile = new Vector2(index % columns, Math.floor(index / columns))
    this.#cascade = cascade
    this.#atlas = atlas
    this.#index = index
    this.#tile = tile
    this.#filtered = {
      mapSize: atlas.size,
      get radius() {
        return cascade.radius
      }
    }
    // Light shafts ask for these: matrices count rows from below.
    const fromBelow = rows - 1 - tile.y
    const toTile = new Matrix4().makeTranslation(tile.x, fromBelow, 0)
    toTile.premultiply(new Matrix4().makeScale(1 / columns, 1 / rows, 1))
    const matrix = new Matrix4()
    Object.assign(cascade, {
      getFrameExtents: () => new Vector2(columns, rows),
      getViewport: () => new Vector4(tile.x, fromBelow, 1, 1),
      getMatrix: () => matrix.multiplyMatrices(toTile, cascade.matrix)
    })
  }

  override setup(builder: NodeBuilder): Node | null | undefined {
    if (builder.renderer.shadowMap.type === VSMShadowMap)
      fail('CascadedShadowNode', 'renderer.shadowMap.type must not be VSMShadowMap')
    return super.setup(builder)
  }

  override setupRenderTarget({ mapType }: { mapType: number }, builder: NodeBuilder): Targets {
    const atlas = this.#atlas
    atlas.setTileSize(this.#cascade.mapSize)
    return (atlas.targets ??= super.setupRenderTarget({ mapSize: atlas.size, mapType }, builder))
  }

  override setupShadowFilter(builder: NodeBuilder, inputs: FilterInputs): Node {
    const { columns, rows } = this.#atlas
    const { x, y } = this.#tile
    const shadow = this.#filtered
    // Three asks whether a place is in the tile; then the tile is in the atlas.
    const filterFn: Filter = given => {
      const { xy, z } = given.shadowCoord
      const shadowCoord = vec3(xy.add(vec2(x, y)).div(vec2(columns, rows)), z) as Vec3
      return inputs.filterFn({ ...given, shadowCoord, shadow })
    }
    return super.setupShadowFilter(builder, { ...inputs, filterFn })
  }

  override renderShadow({ renderer, scene }: NodeFrame): void {
    const cascade = this.#cascade
    const { width, height } = cascade.mapSize
    cascade.updateMatrices((this as unknown as { light: DirectionalLight }).light)
    this.#atlas.setTileSize(cascade.mapSize)
    this.shadowMap.setSize(this.#atlas.size.x, this.#atlas.size.y)
    // Three draws all cascades in their order, and puts `autoClear` back.
    renderer!.autoClear = false
    if (this.#index === 0) renderer!.clear()
    this.shadowMap.viewport.set(this.#tile.x * width, this.#tile.y * height, width, height)
    renderer!.render(scene!, cascade.camera)
  }
}

/**
 * Three's cascades in one shadow map: the same shadows as those of its `CSMShadowNode`, which samples a texture for each.
 *
 * ```ts
 * sun.castShadow = renderer.shadowMap.enabled = true
 * sun.shadow.shadowNode = cascadedShadow(sun, { cascades: 4, maxFar: 500 })
 * ```
 *
 * The map has a tile of `light.shadow.mapSize` for each cascade. Light shafts read it as they do three's.
 */
export class CascadedShadowNode extends BaseCascades {
  static get type(): string {
    return 'CascadedShadowNode'
  }

  /**
   * @param light - Light that casts the shadows; shared, not owned.
   * @param options - Options of `CSMShadowNode`: `cascades`, `maxFar` [world units], `mode`, `lightMargin` [world units].
   */
  constructor(light: DirectionalLight, options: CSMShadowNodeData = {}) {
    if (!light?.shadow?.isDirectionalLightShadow)
      fail('CascadedShadowNode', 'light must be a DirectionalLight', light)
    super(light, options)
  }

  override _init(builder: NodeBuilder): void {
    super._init(builder)
    const atlas = new Atlas(this.cascades)
    this._shadowNodes = this.lights.map(
      (light, i) => new CascadeShadowNode(light, light.shadow!, atlas, i)
    )
  }
}

/** Three's cascades in one shadow map: see {@link CascadedShadowNode}. */
export const cascadedShadow = (
  light: DirectionalLight,
  options?: CSMShadowNodeData
): CascadedShadowNode => new CascadedShadowNode(light, options)
