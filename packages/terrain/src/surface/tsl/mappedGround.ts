import {
  Fn,
  If,
  dFdx,
  dFdy,
  float,
  int,
  mat4,
  mix,
  smoothstep,
  step,
  texture,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import type { Texture, Vector3 } from 'three'
import type { NodeBuilder, UniformNode } from 'three/webgpu'
import type { Float, Int, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { GRAIN_SLOPE } from '../grainTexture'
import type { GroundKind, OfKinds } from '../maps/groundKinds'
import type { GrainPlace } from './grain'
import type { GroundColors, GroundLayers } from './groundRules'
import { sharesOf, type GroundShares } from './groundShares'
import { heightMet, lineOfSight } from './lineOfSight'
import { frameNear, tilingVertices, type TilingVertex } from './stochasticTiling'

/** Cells of the lattice in 256 m that pieces of maps are moved by. */
const CELLS = 36

/** Weight of a material below which it is not read. */
const LEAST = 0.004

/** Part of the weights' range over which one material gives way to the other, and the part that heights have in which one shows. */
const BLEND = 0.18
const BY_HEIGHT = 0.5

/** Material that has maps. */
export interface MappedLayer {
  readonly kind: GroundKind
  /** 1 once its maps are there (x), periods of them in a metre (y) [1/m], and height of white over black (z) [m]. */
  readonly state: UniformNode<'vec3', Vector3>
}

/** Maps of materials: see `GroundMaps`. */
export interface MapsInShader {
  readonly texture: Texture
  readonly layers: readonly MappedLayer[]
}

/** Ground at a place by its maps. */
export interface MappedGround {
  /** Share of the ground that has maps. */
  readonly share: Float
  /** Reflectance, linear sRGB. */
  readonly color: Vec3
  /** Gradient along the ground [–]. */
  readonly slope: Vec3
  readonly roughness: Float
  /** Share of the sky's light. */
  readonly occlusion: Float
}

type Variable<T> = T & { assign(value: T): void; addAssign(value: T): void }
type Sampled = { depth(layer: Int): { grad(dx: Vec2, dy: Vec2): Vec4 } }

/** The two heaviest of some materials: weight (x), layer (y), periods in a metre (z), height of white over black (w). */
function heaviest(layers: readonly Vec4[]): [Vec4, Vec4] {
  let [first, second]: [Vec4, Vec4] = [layers[0], vec4(0, 0, 1, 0)]
  for (const layer of layers.slice(1)) {
    const isFirst = step(first.x, layer.x)
    const other = mix(layer, first, isFirst).toConst() as Vec4
    second = mix(second, other, step(second.x, other.x)).toConst()
    first = mix(first, layer, isFirst).toConst()
  }
  return [first, second]
}

/**
 * The ground by texture maps, and by procedural colours where a material has none.
 *
 * @param layers - Layers on each other.
 */
export function mappedGround(
  maps: MapsInShader,
  place: GrainPlace,
  layers: GroundLayers,
  colors: GroundColors
): MappedGround {
  const shares = sharesOf(layers)
  const mapped = readMaps(maps, place, { ...shares, sand: shares.sand.add(shares.desert) })
  const made = (Object.keys(shares) as (keyof GroundShares)[]).reduce<Vec3>((sum, kind) => {
    const layer = maps.layers.find(other => other.kind === (kind === 'desert' ? 'sand' : kind))
    const isMade = layer === undefined ? float(1) : float(1).sub(layer.state.x)
    return sum.add(colors[kind].mul(shares[kind].mul(isMade)))
  }, vec3(0))
  return { ...mapped, color: made.add(mapped.color.mul(mapped.share)) }
}

/**
 * Ground of maps: the two heaviest materials of a pixel, each by two pieces of its maps that are moved at random, the higher in front.
 *
 * @param weights - Shares of materials; their sum is 1.
 */
function readMaps(maps: MapsInShader, place: GrainPlace, weights: OfKinds<Float>): MappedGround {
  const across = dFdx(place.offset).toConst() as Vec3
  const along = dFdy(place.offset).toConst() as Vec3
  const layers = maps.layers.map(
    ({ kind, state }, n) =>
      vec4(weights[kind].mul(state.x), float(n), state.y, state.z).toConst() as Vec4
  )
  const share = layers
    .reduce<Float>((sum, { x }) => sum.add(x), float(0))
    .min(1)
    .toConst() as Float
  const found = Fn((builder: NodeBuilder) => {
    const color = vec4(0).toVar() as unknown as Variable<Vec4>
    const relief = vec4(0).toVar() as unknown as Variable<Vec4>
    const slope = vec3(0).toVar() as unknown as Variable<Vec3>
    If(share.greaterThan(LEAST), () => {
      const { tangent, bitangent } = frameNear(place.normal, place.up, place.first)
      const inFrame = (vector: Vec3): Vec2 => vec2(vector.dot(tangent), vector.dot(bitangent))
      const [dx, dy] = [inFrame(across).toConst(), inFrame(along).toConst()] as Vec2[]
      // Rows of what was drawn count from the other end on WebGL: places are turned by three, their derivatives are not.
      const isTurned = (builder as unknown as { isFlipY(): boolean }).isFlipY()
      const turn = vec2(1, isTurned ? -1 : 1)
      const { nearest, next, shares } = tilingVertices(place.reference, place.offset, CELLS)
      const total = shares.x.add(shares.y)
      const parts = shares.div(total).toConst() as Vec2
      const [here, there] = [nearest(), next()]
      const read = (part: 'color' | 'relief', layer: Vec4, at: Vec2): Vec4 =>
        (texture(maps.texture, at) as unknown as Sampled)
          .depth(int(layer.y.mul(2).add(part === 'color' ? 0 : 1)))
          .grad(dx.mul(layer.z).mul(turn), dy.mul(layer.z).mul(turn))
      const at = ({ away, random }: TilingVertex, layer: Vec4, moved: Vec2): Vec2 =>
        inFrame(away).add(moved).mul(layer.z).add(random.xy).toConst()
      const depth = lineOfSight(
        place.normal,
        { tangent, bitangent },
        across.length().max(along.length())
      )
      /** Both maps of a material, height in the relief's w. */
      const material = (layer: Vec4): [Vec4, Vec4] => {
        const sum = [vec4(0).toVar(), vec4(0).toVar()] as unknown as Variable<Vec4>[]
        const moved = vec2(0).toVar() as unknown as Variable<Vec2>
        If(depth.share.mul(layer.w).greaterThan(0), () => {
          const reach = depth.slope.mul(layer.w).mul(depth.share).toConst() as Vec2
          const movedAt = (height: Float): Vec2 => reach.mul(height.sub(0.5))
          const met = heightMet(height => read('relief', layer, at(here, layer, movedAt(height))).w)
          moved.assign(movedAt(met))
        })
        const add = (vertex: TilingVertex, part: Float): void => {
          const where = at(vertex, layer, moved)
          sum[0].addAssign(read('color', layer, where).mul(part))
          sum[1].addAssign(read('relief', layer, where).mul(part))
        }
        add(here, parts.x)
        If(parts.y.greaterThan(0), () => {
          add(there, parts.y)
        })
        return [sum[0], sum[1]]
      }
      const [first, second] = heaviest(layers)
      const [colorOne, reliefOne] = material(first)
      color.assign(colorOne)
      relief.assign(reliefOne)
      if (layers.length > 1) {
        If(second.x.greaterThan(LEAST), () => {
          const [colorTwo, reliefTwo] = material(second)
          const byWeight = second.x.div(first.x.add(second.x))
          const byHeight = reliefTwo.w.sub(reliefOne.w).mul(BY_HEIGHT)
          const mean = byWeight.add(byHeight.mul(byWeight.mul(2))).toConst() as Float
          const two = smoothstep(0.5 - BLEND, 0.5 + BLEND, mean)
          color.assign(mix(colorOne, colorTwo, two))
          relief.assign(mix(reliefOne, reliefTwo, two))
        })
      }
      const rise = relief.xy.sub(0.5).mul(2 * GRAIN_SLOPE)
      slope.assign(tangent.mul(rise.x).add(bitangent.mul(rise.y)))
    })
    return mat4(color, vec4(slope, relief.z), vec4(0), vec4(0))
  })().toConst() as unknown as { element(i: number): Vec4 }
  const [color, relief] = [found.element(0), found.element(1)]
  return {
    share,
    color: color.xyz,
    slope: relief.xyz,
    roughness: relief.w,
    occlusion: color.w
  }
}
