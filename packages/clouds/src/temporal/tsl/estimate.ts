import { If, float, mix, vec2, vec4 } from 'three/tsl'
import { loop, type Bool, type Float, type Vec2, type Vec4 } from '../../tsl-types'
import { fitsCell, type Cell } from './cells'
import { brightness, fits, LOOK_PARTS, type CloudPictures } from './pictures'
import type { ViewRayNodes } from '../../march/tsl/viewRay'

/** Sharpness of the kernel that spreads marched pixels, per marched pixels squared. */
const SPREADING = 7

/** Sharpness of the kernel that says how much a marched pixel counts, per pixels squared. */
const LOOKING = 5

/** What pixels that no marched one is near to count nevertheless. */
const LEAST_LOOK = 1 / LOOK_PARTS

/** What this frame's marched pixels say about a pixel. */
export interface Estimate {
  light: Vec4
  /** What is around; a texture read where the whole cell fits. */
  mean: () => Vec4
  /** Means of brightness and transmittance around, and their standard deviations. */
  around: Vec4
  /** log₂ of the clouds' distance. */
  distance: Float
  /** How much it counts. */
  look: Float
}

/** Where a pixel is between marched ones. */
export interface CellPlace {
  /** Index of the cell's first corner. */
  readonly corner: Vec2
  /** From there on, in [0, 1). */
  readonly part: Vec2
}

/** The cell that a pixel is in. */
export function cellPlace({ frame }: ViewRayNodes, pixel: Vec2): CellPlace {
  const at = pixel.sub(frame.jitter).div(frame.block).add(1e-3).toConst() as Vec2
  const corner = at.floor().toConst() as Vec2
  return { corner, part: at.sub(corner).toConst() }
}

/**
 * What a pixel that sees as far as `end` may know from its cell: of all corners if they are alike, which
 * takes a single look-up, or else of those that fit.
 */
export function estimate(
  { frame }: ViewRayNodes,
  marched: CloudPictures,
  { corner, part }: CellPlace,
  cell: Cell,
  end: Float
): Estimate {
  // Weights e^{−s p²} and e^{−s (1−p)²}, in proportion: how far filtering has to go.
  const blend = part.mul(2).oneMinus().mul(SPREADING).exp().add(1).reciprocal().toConst() as Vec2
  const at = (index: Vec2): Vec2 => index.add(0.5).div(frame.marchedSize).toConst()
  const squares = part.mul(part).toConst() as Vec2
  const others = part.oneMinus().mul(part.oneMinus()).toConst() as Vec2
  const nearest = squares.min(others).toConst() as Vec2

  const isLike = fitsCell(end, cell.place).toConst() as Bool
  const light = vec4(0).toVar() as Vec4
  const mean = vec4(0, 0, 0, 1).toVar() as Vec4
  const around = cell.light.toVar() as Vec4
  const distance = cell.place.x.toVar() as Float
  /** Square of the distance to the nearest that fits [marched pixels²]. */
  const apart = nearest.x.add(nearest.y).toVar() as Float
  If(isLike, () => {
    light.assign(marched.light.sample(at(corner.add(blend))).level(0))
  }).Else(() => {
    const first = vec4(0).toVar() as Vec4
    const moments = vec4(0).toVar() as Vec4
    /** Sums of weights; of what fits; of distances and their weights. */
    const sums = vec4(0).toVar() as Vec4
    apart.assign(100)
    loop('corner', 4, index => {
      const step = vec2(float(index.mod(2)), float(index.div(2))).toConst() as Vec2
      const place = at(corner.add(step).clamp(vec2(0), frame.marchedSize.sub(1)))
      const color = marched.light.sample(place).level(0).toConst() as Vec4
      const about = marched.place.sample(place).level(0).toConst() as Vec4
      const fit = fits(end, about).toConst() as Float
      const share = mix(blend.oneMinus(), blend, step).toConst() as Vec2
      const weight = share.x.mul(share.y).mul(fit).toConst() as Float
      const seen = weight.mul(color.w.oneMinus().add(1e-3)).toConst() as Float
      const value = vec2(brightness(color), color.w).toConst() as Vec2
      light.addAssign(color.mul(weight))
      first.addAssign(color.mul(fit))
      moments.addAssign(vec4(value, value.mul(value)).mul(fit))
      sums.addAssign(vec4(weight, fit, about.x.mul(seen), seen))
      const square = mix(squares, others, step).toConst() as Vec2
      apart.assign(apart.min(fit.greaterThan(0).select(square.x.add(square.y), 100)))
    })
    const count = sums.y.max(1)
    // Nothing was marched as far as this pixel sees: what is in front of clouds sees none.
    If(sums.y.greaterThan(0), () => {
      mean.assign(first.div(count))
    })
    const average = moments.div(count).toConst() as Vec4
    const variance = average.zw.sub(average.xy.mul(average.xy)).max(0)
    around.assign(vec4(brightness(mean), mean.w, variance.sqrt()))
    light.assign(sums.x.greaterThan(1e-6).select(light.div(sums.x.max(1e-7)), mean))
    distance.assign(sums.w.greaterThan(0).select(sums.z.div(sums.w.max(1e-9)), end))
  })
  const look = apart.mul(frame.block).mul(frame.block).mul(-LOOKING).exp()
  return {
    light,
    mean: () => {
      If(isLike, () => {
        mean.assign(marched.light.sample(at(corner.add(0.5))).level(0))
      })
      return mean
    },
    around,
    distance,
    look: look.max(LEAST_LOOK).toConst()
  }
}
