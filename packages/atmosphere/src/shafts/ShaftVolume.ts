import { RGFormat, UnsignedByteType, Vector2 } from 'three'
import type { Camera } from 'three'
import { Fn, If, float, getViewPosition, int, screenUV, texture, uniform, vec4 } from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import { FragmentPass, outputs, tableTarget, type Outputs } from '../tables/FragmentPass'
import { RADIANCE_SCALE } from '../tables/tableSizes'
import { loop, type Float, type Mat4, type Vec2, type Vec4 } from '../tsl-types'
import { number, vector2 } from '../uniforms'
import type { ViewNodes } from '../view/ViewNodes'
import type { CameraShafts } from './CameraShafts'
import { RayTiles } from './RayTiles'
import { lostInSlice, type Slice } from './tsl/lostInSlice'
import { lostLight, staggered } from './tsl/lostLight'
import type { ShadowedAir, ShaftRay } from './tsl/shadowsAlong'
import { FAR } from './tsl/without'

/** Rays along the longer edge of the picture. */
const RAYS = 144

/** Slices of a ray, each in a tile. Fewer: light before surfaces in shadow is blurred with that behind. */
const SLICES = 24

/** Tiles: of slices one more, for the sky; of sums twelve more, each with the edges of two slices. */
const SLICE_TILES = SLICES + 1
const SUM_TILES = SLICE_TILES + SLICES / 2

/** Factor on the distance of rays where they are too many for the room that there is. */
const COARSER = 1.05

/** Distance of the last slice over the first one's length. */
const REACH = 1000

/** Farthest shafts that materials tell apart [m]; times how far shadow maps reach to the sides, where there are maps alone. */
const AIR_REACH = 150_000
const MAP_REACH = 4

/** Greatest light that targets keep: half floats hold a little more. */
const MAX_LIGHT = 6e4

const _size = new Vector2()

/** Shafts whose light a volume has; `version` grows whenever its shader changes. */
type ShaftsInVolume = Pick<CameraShafts, 'view' | 'shadowedAir' | 'steps' | 'version'>

/**
 * Light that shadows keep from a grid of view rays, up to any distance: what materials read that draw the air
 * themselves, transparent ones too. Each ray is cut into slices at distances that are the same for all, and sums of
 * their light are kept. Within a slice light is lost between the first dark place and the last one, so that what lies behind a
 * surface is not taken from the air before it. Rays into the sky are marched whole, since some fogs are not in front of it.
 */
export class ShaftVolume {
  /** Light that slices lose; where in them dark air begins and ends: five by five tiles, since each more would be marched for nothing. */
  readonly #slices = new RayTiles(tableTarget('Welkin.LightShafts', 1, 1, 2), SLICE_TILES, 5)
  /** Light that rays lose up to the end of each slice, and edges of the dark in it, in the middle of four rays: one texture, for materials have few left. */
  readonly sums = new RayTiles(tableTarget('Welkin.LightShafts', 1, 1), SUM_TILES, 13)
  readonly #sliceLight: TextureNode
  readonly #sliceEdges: TextureNode
  readonly #projectionInverse: Mat4
  /** Size of the picture, in steps from ray to ray. */
  readonly #size = vector2()
  /** Distances of slices: where they begin, and those of the first, grow by e per `growth` [m]. */
  readonly #start = number()
  readonly #first = number(1)
  readonly #growth = Math.log1p(REACH) / (SLICES - 1)
  #passes: readonly FragmentPass[] = []
  /** Version of the shafts that the passes are of. */
  #compiled = -1

  constructor(camera: Camera) {
    this.#projectionInverse = uniform(camera.projectionMatrixInverse) as unknown as Mat4
    const [light, edges] = this.#slices.own.textures
    edges.format = RGFormat
    edges.type = UnsignedByteType
    this.#sliceLight = texture(light)
    this.#sliceEdges = texture(edges)
  }

  /**
   * Sizes its targets, before anything is drawn with them in a frame.
   *
   * @param isUsed - False while nothing reads them, to free them.
   */
  resize(renderer: Renderer, isUsed: boolean): void {
    if (!isUsed) {
      for (const tiles of [this.#slices, this.sums]) tiles.dispose()
      return
    }
    const { width, height } = renderer.getRenderTarget() ?? renderer.getDrawingBufferSize(_size)
    let step = Math.max(Math.max(width, height) / RAYS, 1)
    do {
      this.#size.value.set(Math.max(width, 1), Math.max(height, 1)).divideScalar(step)
      // One ray more beyond each edge of the picture.
      _size.copy(this.#size.value).ceil().addScalar(2)
      step *= COARSER
    } while (!this.sums.resize(_size))
    this.#slices.resize(_size)
  }

  /**
   * Draws it, for a view whose uniforms are set.
   *
   * @param shadowedSky - Their `shadowedAir` in front of the sky.
   * @param mapped - Greatest ρ of shadow maps; infinite where there are other shadows [m].
   */
  draw(renderer: Renderer, shafts: ShaftsInVolume, shadowedSky: ShadowedAir, mapped: number): void {
    const { view, version } = shafts
    const { topRadius, bottomRadius } = view.atmosphere.parameters
    const height = view.height.value
    this.#start.value = Math.max(height - (topRadius - bottomRadius), 0)
    const most = AIR_REACH + 2 * Math.max(height, 0)
    this.#first.value = Math.min(MAP_REACH * mapped, most) / REACH
    if (this.#compiled !== version) {
      for (const pass of this.#passes) pass.dispose()
      const summed = Fn(() => this.#sum())()
      this.#passes = [this.#march(shafts, shadowedSky), summed].map(
        output => new FragmentPass('Welkin.LightShafts', output)
      )
      this.#compiled = version
    }
    this.#slices.render(renderer, this.#passes[0])
    this.sums.render(renderer, this.#passes[1])
  }

  /** Distance at which a slice begins [m]. */
  #distanceTo(slice: Float): Float {
    const grown = slice.mul(this.#growth).exp().sub(1)
    return grown.mul(this.#first).add(this.#start).toConst()
  }

  /** Reads a sum, or edges in a tile after those of the sums. */
  #sumAt(tile: Float, place: Vec2): Vec4 {
    return this.sums.read(texture(this.sums.target.texture), tile, place)
  }

  #march({ view, shadowedAir, steps }: ShaftsInVolume, shadowedSky: ShadowedAir): Outputs {
    return outputs<[Vec4, Vec4]>(2, ([lightOut, edgesOut]) => {
      const { tile: slice, place } = this.#slices.texel()
      const [from, next] = [slice, slice.add(1)].map(number => this.#distanceTo(number))
      const isLast = slice.greaterThan(SLICES - 1.5)
      const part: Slice = { from, to: isLast.select(FAR, next).toConst() }
      // Aside by a quarter of a step, so that four rays have edges at four places. Without: edges displaced by 0.29°.
      const aside = place.yx.mod(2).sub(0.5).mul(0.5)
      const ray = this.#rayAt(view, place.sub(0.5).add(aside).div(this.#size))
      const jitter = staggered(place)
      const light = vec4(0).toVar()
      const edges = vec4(0).toVar()
      If(slice.lessThan(SLICES - 0.5), () => {
        const { lost, dark } = lostInSlice(view, shadowedAir, ray, part, steps.samples, jitter)
        light.assign(lost)
        edges.xy.assign(dark.sub(from).div(next.sub(from)).clamp())
      }).Else(() => {
        light.assign(lostLight(view, shadowedSky, ray, steps, jitter))
      })
      lightOut.assign(light.mul(RADIANCE_SCALE).clamp(-MAX_LIGHT, MAX_LIGHT))
      edgesOut.assign(edges)
    })
  }

  #rayAt(view: ViewNodes, at: Vec2): ShaftRay {
    const position = getViewPosition(at, float(0.5), this.#projectionInverse)
    const direction = view.toMapped(position).normalize().toConst()
    const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
    const cosViewLight = direction.dot(view.lightDirection).toConst() as Float
    return { direction, cosView, cosViewLight, distance: float(FAR) }
  }

  /** A texel of the sums: between four rays, which have samples in all places of their steps. */
  #sum(): Vec4 {
    const { tile, place } = this.sums.texel()
    const between = place.add(1).toConst()
    const sum = vec4(0).toVar()
    If(tile.lessThan(SLICE_TILES - 0.5), () => {
      const first = tile
        .greaterThan(SLICES - 0.5)
        .select(tile, 0)
        .toConst()
      loop('slice', int(tile.sub(first)).add(1), index => {
        const light = this.#slices.read(this.#sliceLight, first.add(float(index)), between)
        sum.addAssign(light)
      })
      sum.assign(sum.clamp(-MAX_LIGHT, MAX_LIGHT))
    }).Else(() => {
      const even = tile.sub(SLICE_TILES).mul(2).toConst()
      const edges = [even, even.add(1)].map(slice =>
        this.#slices.read(this.#sliceEdges, slice.min(SLICES), between)
      )
      sum.assign(vec4(edges[0].xy, edges[1].xy))
    })
    return sum
  }

  /** Light that the sky loses at a fragment, for unit irradiance of the source [1/sr]. */
  lostToSky(): Vec4 {
    return this.#sumAt(float(SLICES), this.#centre).div(RADIANCE_SCALE)
  }

  /** Place of a fragment among the rays. */
  get #centre(): Vec2 {
    return (screenUV as unknown as Vec2).mul(this.#size).add(0.5).toConst()
  }

  /**
   * Light that a fragment loses, for unit irradiance of the source [1/sr].
   *
   * @param distance - Distance to it [m].
   */
  lostTo(distance: Float): Vec4 {
    const ahead = distance.sub(this.#start).max(0).div(this.#first).add(1).log()
    const slice = ahead
      .div(this.#growth)
      .floor()
      .clamp(0, SLICES - 1)
      .toConst() as Float
    const [from, next] = [slice, slice.add(1)].map(number => this.#distanceTo(number))
    const inSlice = distance.sub(from).div(next.sub(from)).toConst()
    const centre = this.#centre
    const pair = slice.mul(0.5).floor().toConst() as Float
    const both = this.#sumAt(pair.add(SLICE_TILES), centre)
    const edges = slice.sub(pair.mul(2)).greaterThan(0.5).select(both.zw, both.xy).toConst()
    const part = inSlice.sub(edges.x).div(edges.y.sub(edges.x).max(1e-3)).clamp().toConst()
    const after = this.#sumAt(slice, centre)
    const before = vec4(0).toVar()
    If(slice.greaterThan(0.5), () => {
      before.assign(this.#sumAt(slice.sub(1), centre))
    })
    return before.add(after.sub(before).mul(part)).div(RADIANCE_SCALE)
  }

  /** Frees its textures. It can be used again. */
  dispose(): void {
    for (const owned of [...this.#passes, this.#slices, this.sums]) owned.dispose()
    this.#passes = []
    this.#compiled = -1
  }
}
