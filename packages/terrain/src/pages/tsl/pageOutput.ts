import { Fn, int, ivec2, positionGeometry, texture, vec2, vec4 } from 'three/tsl'
import type { DataArrayTexture, Texture } from 'three'
import type { HeightSource, SurfacePoint } from '../../heights/HeightSource'
import { heightAndSky } from './skyShare'
import { packed } from './packing'
import { gradientAlong } from '../../surface/tsl/gradientAlong'
import { climates, patches } from '../../surface/tsl/groundNoise'
import { faceAxes } from '../../tiles/tsl/cubeSphere'
import type { ShaderFigure } from '../../tiles/tsl/figure'
import type { Float, Vec2, Vec3, Vec4 } from '../../tsl-types'

/**
 * Shortest wavelength in pages for pixels, over the shortest that their texels resolve. 1: only octaves of four texels and more count, and
 * land from 10 km and 400 km looks out of focus (*Terrain*).
 */
const SHARPNESS = 0.5

/** Tile that a page is drawn for, as nodes that are the same for all pixels of the page. */
export interface PageUniforms {
  /** Point of the cube above the centre, and its face. */
  readonly cube: Vec3
  readonly face: Float
  /** Half width on the cube. */
  readonly extent: Float
  /** Point near the centre in whole multiples of 256 m [256 m]. */
  readonly reference: Vec3
  /** Reference to centre [m]. */
  readonly center: Vec3
  /** Shortest wavelength that vertices show [m]. */
  readonly shortest: Float
  readonly radii: Vec3
  readonly figure: ShaderFigure
  /** Seed of patches and climate. */
  readonly seed: Float
  /** Number of the page in the drawing. */
  readonly row: Float
}

/** A place of a page. */
interface PagePlace extends SurfacePoint {
  /** Centre to the place [m]. */
  readonly fromCenter: Vec3
}

/** Axes along a face. */
type Axes = ReturnType<typeof faceAxes>

/** Column and row of the texel that is drawn. */
const texelOf = (side: number): Vec2 =>
  (positionGeometry.xy as unknown as Vec2).mul(side).floor().toConst()

/** @param cells - Steps between texels from the tile's first corner. */
function placeAt(
  { cube, extent, reference, center, radii, figure }: PageUniforms,
  { first, second }: Axes,
  cells: Vec2,
  side: number
): PagePlace {
  const place = cells.mul(2 / (side - 1)).sub(1)
  const delta = first.mul(place.x).add(second.mul(place.y)).mul(extent)
  const fromCenter = figure.difference(cube, delta, radii).toConst() as Vec3
  return { fromCenter, reference, offset: center.add(fromCenter).toConst() }
}

/** Geodetic up at a place. */
const upAt = (tile: PageUniforms, { fromCenter }: PagePlace): Vec3 => {
  const { cube, radii, figure } = tile
  const center = cube.normalize().mul(radii)
  return figure.upAt(center.add(fromCenter), radii.x.div(radii)).toConst()
}

/** Texel for vertices: height, and climate with the share of the sky. */
const vertexTexel = (
  { shortest, seed }: PageUniforms,
  { reference, offset }: PagePlace,
  height: Float,
  sky: Float
): Vec4 => vec4(height, packed(climates(reference, offset, shortest, seed).w, sky), 0, 1)

/** Height, and climate with the share of the sky, of a vertex, from a function. */
export const heightsOf = (source: HeightSource, tile: PageUniforms, side: number): Vec4 =>
  Fn(() => {
    const place = placeAt(tile, faceAxes(tile.face), texelOf(side), side)
    const ground = heightAndSky(source, place, upAt(tile, place), tile.shortest).toConst()
    return vertexTexel(tile, place, ground.x, ground.y)
  })()

/** Texel for pixels: the gradient along the ellipsoid by a face's axes, height and patchiness. */
function surfaceTexel(
  tile: PageUniforms,
  { first, second }: Axes,
  place: PagePlace,
  ground: { gradient: Vec3; height: Float },
  shortest: Float
): Vec4 {
  const up = upAt(tile, place)
  const gradient = gradientAlong(ground.gradient, up).toConst()
  const along = vec2(gradient.dot(first), gradient.dot(second))
  const { reference, offset } = place
  return vec4(along, ground.height, patches(reference, offset, shortest, tile.seed))
}

/** Gradient, height and patchiness for pixels, from a function. */
export const surfaceOf = (
  source: HeightSource,
  tile: PageUniforms,
  side: number,
  density: number
): Vec4 =>
  Fn(() => {
    const axes = faceAxes(tile.face)
    const place = placeAt(tile, axes, texelOf(side), side)
    const shortest = tile.shortest.mul(SHARPNESS / density).toConst() as Float
    const ground = source.sample(place, shortest).toConst() as Vec4
    return surfaceTexel(tile, axes, place, { gradient: ground.xyz, height: ground.w }, shortest)
  })()

/** Colours that were loaded, a step beyond each edge too. */
export const imageOf = (image: Texture, side: number): Vec4 =>
  Fn(() =>
    (texture(image) as unknown as { load(at: unknown): Vec4 }).load(
      ivec2(texelOf(side).add(1) as never)
    )
  )()

/** Heights that were loaded, a page to a layer, a step beyond each edge too. */
const loaded = (heights: DataArrayTexture, { row }: PageUniforms, texel: Vec2): Float => {
  const node = texture(heights) as unknown as {
    load(at: unknown): { depth(layer: unknown): Vec4 }
  }
  return node.load(ivec2(texel as never)).depth(int(row)).x
}

/** Height, and climate with the share of the sky, of a vertex, from what was loaded. */
export const loadedHeightsOf = (
  heights: DataArrayTexture,
  tile: PageUniforms,
  side: number,
  density: number
): Vec4 =>
  Fn(() => {
    const texel = texelOf(side)
    const place = placeAt(tile, faceAxes(tile.face), texel, side)
    // Shares of the sky follow the heights, in rows as long.
    const wide = density * (side - 1) + 3
    const index = texel.y.mul(side).add(texel.x).toConst()
    const row = index.add(0.5).div(wide).floor().toConst()
    const sky = loaded(heights, tile, vec2(index.sub(row.mul(wide)), row.add(wide)))
    return vertexTexel(tile, place, loaded(heights, tile, texel.mul(density).add(1)), sky)
  })()

/** Gradient by central differences, height and patchiness for pixels, from heights that were loaded. */
export const loadedSurfaceOf = (
  heights: DataArrayTexture,
  tile: PageUniforms,
  side: number,
  density: number
): Vec4 =>
  Fn(() => {
    const texel = texelOf(side)
    const axes = faceAxes(tile.face)
    const place = placeAt(tile, axes, texel, side)
    const at = (x: number, y: number): Float => loaded(heights, tile, texel.add(vec2(x + 1, y + 1)))
    const along = (x: number, y: number): { step: Vec3; rise: Float } => {
      const [after, before] = [1, -1].map(sign =>
        placeAt(tile, axes, texel.add(vec2(sign * x, sign * y)) as Vec2, side)
      )
      const step = after.fromCenter.sub(before.fromCenter).toConst() as Vec3
      return { step, rise: at(x, y).sub(at(-x, -y)).toConst() }
    }
    const [a, b] = [along(1, 0), along(0, 1)]
    // The gradient g in the plane of both steps has g·a and g·b equal to the rises.
    const area = a.step.cross(b.step).toConst()
    const gradient = b.step
      .cross(area)
      .mul(a.rise)
      .add(area.cross(a.step).mul(b.rise))
      .div(area.dot(area))
      .toConst()
    const shortest = tile.shortest.mul(SHARPNESS / density)
    return surfaceTexel(tile, axes, place, { gradient, height: at(0, 0) }, shortest)
  })()
