import { RGFormat, UnsignedByteType, Vector2 } from 'three'
import type { Camera, RenderTarget } from 'three'
import {
  Fn,
  If,
  float,
  int,
  outputStruct,
  property,
  screenUV,
  texture,
  uv,
  vec2,
  vec4
} from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import { FragmentPass, tableTarget, type Outputs } from '../tables/FragmentPass'
import { rowAndColumn } from '../tables/tsl/texels'
import { RADIANCE_SCALE } from '../tables/tableSizes'
import { loop, sampleLevel0, type Float, type Vec2, type Vec4 } from '../tsl-types'
import { number, vector2 } from '../uniforms'
import { DepthRays } from '../view/DepthRays'
import type { ViewNodes } from '../view/ViewNodes'
import type { CameraShafts } from './CameraShafts'
import { lostInSlice, type Slice } from './tsl/lostInSlice'
import { lostLight, staggered } from './tsl/lostLight'
import type { ShadowedAir, ShaftRay } from './tsl/shadowsAlong'
import { FAR } from './tsl/without'

/** Slices of a ray, each in a tile. Fewer: light before surfaces in shadow is blurred with that behind. */
const SLICES = 24

/** Tiles in a row, and rows: one tile is left for the sky. */
const TILE_COLUMNS = 5

/** Distance of the last slice over the first one's length. */
const REACH = 1000

/** Farthest shafts that materials tell apart [m]; times how far shadow maps reach to the sides, where there are maps alone. */
const AIR_REACH = 150_000
const MAP_REACH = 4

/** Greatest light that targets keep: half floats hold a little more. */
const MOST = 6e4

const _size = new Vector2()

/** A shader of two attachments. */
function lightAndEdges(body: (renderer: Renderer) => { light: Vec4; edges: Vec4 }): Outputs {
  const first = property('vec4') as unknown as Vec4
  const second = property('vec4') as unknown as Vec4
  const assign = Fn(({ renderer }): Vec4 => {
    const { light, edges } = body(renderer)
    first.assign(light.clamp(-MOST, MOST))
    second.assign(edges)
    return vec4(0)
  })
  return { color: assign(), output: outputStruct(first, second) }
}

/** Shafts whose light a volume has; `version` grows whenever its shader changes. */
type ShaftsInVolume = Pick<CameraShafts, 'view' | 'shadowedAir' | 'steps' | 'version'>

/** Fineness of a {@link ShaftVolume}. */
export interface VolumeQuality {
  /** Rays along the longer edge of the picture. */
  readonly rays: number
  /** Look-ups of the shadow in each slice of a ray. */
  readonly looks: number
}

/**
 * Light that shadows keep from a grid of view rays, up to any distance: what materials read that draw the air
 * themselves, transparent ones too. Each ray is cut into slices at distances that are the same for all, and sums of
 * their light are kept. Within a slice light is lost between the first dark place and the last one, so that what lies behind a
 * surface is not taken from the air before it. Rays into the sky are marched whole, since some fogs are not in front of it.
 */
export class ShaftVolume {
  /** Light that slices lose; where in them dark air begins and ends. */
  readonly #slices: RenderTarget
  /** Light that rays lose up to the end of each slice, and edges of the dark in it, in the middle of four rays. */
  readonly #sums: RenderTarget
  /** Textures of both: light, and edges of the dark. */
  readonly #textures: readonly (readonly TextureNode[])[]
  readonly #rays: DepthRays
  /** Number of rays in each direction, with one beyond each edge of the picture. */
  readonly #grid = vector2()
  /** Size of the picture, in steps from ray to ray. */
  readonly #size = vector2()
  readonly #looks = number(1)
  /** Distances of slices: where they begin, and those of the first, grow by e per `growth` [m]. */
  readonly #start = number()
  readonly #first = number(1)
  readonly #growth = Math.log1p(REACH) / (SLICES - 1)
  #passes: readonly FragmentPass[] = []
  /** Version of the shafts that the passes are of. */
  #compiled = -1

  constructor(camera: Camera) {
    this.#rays = new DepthRays(float(0.5), camera)
    this.#slices = tableTarget('Welkin.LightShafts', 1, 1, 2)
    this.#sums = tableTarget('Welkin.LightShafts', 1, 1, 2)
    this.#textures = [this.#slices, this.#sums].map(({ textures }) => {
      textures[1].format = RGFormat
      textures[1].type = UnsignedByteType
      return textures.map(each => texture(each))
    })
  }

  /**
   * Sizes its targets, before anything is drawn with them in a frame.
   *
   * @param quality - Fineness; null while nothing reads them, to free all but a texel.
   */
  resize(renderer: Renderer, quality: VolumeQuality | null): void {
    if (quality === null) {
      for (const target of [this.#slices, this.#sums]) target.setSize(1, 1)
      return
    }
    const { rays, looks } = quality
    const { width, height } = renderer.getRenderTarget() ?? renderer.getDrawingBufferSize(_size)
    const step = Math.max(Math.max(width, height) / rays, 1)
    this.#size.value.set(Math.max(width, 1), Math.max(height, 1)).divideScalar(step)
    this.#grid.value.copy(this.#size.value).ceil().addScalar(2)
    const { x, y } = this.#grid.value
    for (const target of [this.#slices, this.#sums])
      target.setSize(TILE_COLUMNS * x, TILE_COLUMNS * y)
    this.#looks.value = looks
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
      this.#passes = [this.#march(shafts, shadowedSky), this.#sum()].map(
        output => new FragmentPass('Welkin.LightShafts', output)
      )
      this.#compiled = version
    }
    this.#passes[0].render(renderer, this.#slices)
    this.#passes[1].render(renderer, this.#sums)
  }

  /** Distance at which a slice begins [m]. */
  #distanceTo(slice: Float): Float {
    const grown = slice.mul(this.#growth).exp().sub(1)
    return grown.mul(this.#first).add(this.#start).toConst()
  }

  /** Slice and place in it of a texel. */
  #texel(): { slice: Float; place: Vec2 } {
    const texel = uv().mul(this.#grid.mul(TILE_COLUMNS)).floor().toConst() as unknown as Vec2
    const tile = texel.div(this.#grid).add(1e-4).floor().toConst() as Vec2
    const slice = tile.y.mul(TILE_COLUMNS).add(tile.x).toConst() as Float
    return { slice, place: texel.sub(tile.mul(this.#grid)).toConst() }
  }

  /** Reads a texture in the tile of a slice. */
  #read(source: TextureNode, slice: Float, place: Vec2): Vec4 {
    const { row, column } = rowAndColumn(slice, TILE_COLUMNS)
    const at = vec2(column, row).mul(this.#grid).add(place)
    return sampleLevel0(source, at.div(this.#grid.mul(TILE_COLUMNS))).toConst()
  }

  #march({ view, shadowedAir, steps }: ShaftsInVolume, shadowedSky: ShadowedAir): Outputs {
    return lightAndEdges(renderer => {
      const { slice, place } = this.#texel()
      const [from, next] = [slice, slice.add(1)].map(number => this.#distanceTo(number))
      const isLast = slice.greaterThan(SLICES - 1.5)
      const part: Slice = { from, to: isLast.select(FAR, next).toConst() }
      const ray = this.#rayAt(renderer, view, place.sub(0.5).div(this.#size))
      const jitter = staggered(place)
      const light = vec4(0).toVar()
      const edges = vec4(0).toVar()
      If(slice.lessThan(SLICES - 0.5), () => {
        const { lost, dark } = lostInSlice(view, shadowedAir, ray, part, this.#looks, jitter)
        light.assign(lost)
        edges.xy.assign(dark.sub(from).div(next.sub(from)).clamp())
      }).Else(() => {
        light.assign(lostLight(view, shadowedSky, ray, steps, jitter))
      })
      return { light: light.mul(RADIANCE_SCALE), edges }
    })
  }

  #rayAt(renderer: Renderer, view: ViewNodes, at: Vec2): ShaftRay {
    const position = this.#rays.position(renderer, at, float(0.5))
    const direction = view.toMapped(position).normalize().toConst()
    const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
    const cosViewLight = direction.dot(view.lightDirection).toConst() as Float
    return { direction, cosView, cosViewLight, distance: float(FAR) }
  }

  #sum(): Outputs {
    const [light, edges] = this.#textures[0]
    return lightAndEdges(() => {
      const { slice, place } = this.#texel()
      const sum = vec4(0).toVar()
      // Between four rays, which have samples in all places of their steps.
      const first = slice
        .greaterThan(SLICES - 0.5)
        .select(slice, 0)
        .toConst()
      loop('slice', int(slice.sub(first)).add(1), index => {
        sum.addAssign(this.#read(light, first.add(float(index)), place.add(1)))
      })
      return { light: sum, edges: this.#read(edges, slice, place.add(1)) }
    })
  }

  /** Light that the sky loses at a fragment, for unit irradiance of the source [1/sr]. */
  lostToSky(): Vec4 {
    return this.#read(this.#textures[1][0], float(SLICES), this.#centre).div(RADIANCE_SCALE)
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
    const [sums, dark] = this.#textures[1]
    const ahead = distance.sub(this.#start).max(0).div(this.#first).add(1).log()
    const slice = ahead
      .div(this.#growth)
      .floor()
      .clamp(0, SLICES - 1)
      .toConst() as Float
    const [from, next] = [slice, slice.add(1)].map(number => this.#distanceTo(number))
    const inSlice = distance.sub(from).div(next.sub(from)).toConst()
    const centre = this.#centre
    const edges = this.#read(dark, slice, centre)
    const part = inSlice.sub(edges.x).div(edges.y.sub(edges.x).max(1e-3)).clamp().toConst()
    const after = this.#read(sums, slice, centre)
    const before = vec4(0).toVar()
    If(slice.greaterThan(0.5), () => {
      before.assign(this.#read(sums, slice.sub(1), centre))
    })
    return before.add(after.sub(before).mul(part)).div(RADIANCE_SCALE)
  }

  /** Frees its textures. It can be used again. */
  dispose(): void {
    for (const owned of [...this.#passes, this.#slices, this.#sums]) owned.dispose()
    this.#passes = []
    this.#compiled = -1
  }
}
