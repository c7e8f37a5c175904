import { Fn, vec2 } from 'three/tsl'
import { select } from '../../select'
import { layout, type Float } from '../../tsl-types'
import { extinctionForm } from '../fallForm'

/**
 * Extinction [1/m]: `extinctionForm`; all of it (x), and that of flakes and stones, which have no bow (y). Twin:
 * test/twins/precipitation.ts
 */
export const fallExtinctions = /*#__PURE__*/ Fn(
  ([rate, snow, hail]: [Float, Float, Float]) => {
    const { rain: r, snow: s, hail: h } = extinctionForm
    const positive = rate.max(1e-6).toConst()
    const isThere = select(rate.greaterThan(0), 1 / 1000, 0).toConst()
    const drops = positive.pow(r[1]).mul(r[0]).mul(snow.oneMinus()).mul(isThere)
    const others = positive
      .pow(s[1])
      .mul(s[0])
      .mul(snow)
      .mul(isThere)
      .add(hail.mul(h / 1000))
    return vec2(drops.add(others), others)
  },
  layout('precipitationExtinctions', 'vec2', { rate: 'float', snow: 'float', hail: 'float' })
)
