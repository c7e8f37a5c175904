import { Fn, If, bitAnd, float, shiftRight, step, uvec3, vec3 } from 'three/tsl'
import { layout, loop, type Float, type Vec3 } from '../../tsl-types'
import { cellOf, digitsOf, hashCell, wrapped, type UVec3 } from './cellHash'

/**
 * 1 − F₁, with F₁ the distance to the nearest of the points scattered one in each cell: round bulges
 * that meet in sharp creases, as on cauliflowers. Period 1, in [0, 1]. Parameters as of `perlin`.
 *
 * The eight nearest cells are visited first, then others, unless they lie beyond the nearest point so
 * far: 9.3 of 27 on average.
 *
 * @see Worley 1996, "A cellular texture basis function", SIGGRAPH, pp. 291–294, on F₁. Twin: test/twins/noise.ts
 */
export const billow = /*#__PURE__*/ Fn(
  ([p, cells, seed]: [Vec3, Vec3, Float]) => {
    const { base, part, origin, index } = cellOf(p, cells, seed)
    // Towards the nearer neighbour along each axis.
    const side = step(vec3(0.5), part).mul(2).sub(1).toConst()
    const nearStep = wrapped(base.add(side), cells).sub(origin).toConst()
    const farStep = wrapped(base.sub(side), cells).sub(origin).toConst()
    const nearest = float(1).toVar()
    const visit = (cell: UVec3, offset: Vec3): void => {
      const gap = offset.add(hashCell(cell)).sub(part).toConst()
      nearest.assign(nearest.min(gap.dot(gap)))
    }
    loop('nearCell', 8, corner => {
      const digits = digitsOf(corner, 2).toConst()
      visit(index.add(nearStep.mul(digits)), side.mul(vec3(digits)))
    })
    // Squared distances to the cells beside this one.
    const nearGap = part.min(part.oneMinus()).toConst()
    const farGap = part.max(part.oneMinus()).toConst()
    const nearSquare = nearGap.mul(nearGap).toConst()
    const farSquare = farGap.mul(farGap).toConst()
    If(farSquare.x.min(farSquare.y).min(farSquare.z).lessThan(nearest), () => {
      loop('farCell', 27, neighbour => {
        // Digits 0, 1 and 2: this cell's row, the nearer one's, the farther one's.
        const digits = digitsOf(neighbour, 3).toConst()
        const isNear = bitAnd(digits as never, uvec3(1) as never) as unknown as UVec3
        const isFar = shiftRight(digits as never, uvec3(1) as never) as unknown as UVec3
        const near = vec3(isNear).toConst()
        const far = vec3(isFar).toConst()
        const beyond = nearSquare.dot(near).add(farSquare.dot(far))
        const isBeside = far.x.max(far.y).max(far.z).greaterThan(0)
        If(isBeside.and(beyond.lessThan(nearest)), () => {
          const cell = index.add(nearStep.mul(isNear)).add(farStep.mul(isFar))
          visit(cell, side.mul(near.sub(far)))
        })
      })
    })
    return nearest.sqrt().oneMinus()
  },
  layout('welkinBillow', 'float', { p: 'vec3', cells: 'vec3', seed: 'float' })
) as unknown as (p: Vec3, cells: Vec3, seed: Float) => Float
