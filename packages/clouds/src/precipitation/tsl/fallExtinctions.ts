import { Fn, vec2 } from 'three/tsl'
import { layout, type Float } from '../../tsl-types'
import { extinctionForm } from '../fallForm'

/**
 * Extinction [1/m]: `extinctionForm`; all of it (x), and that of flakes and stones, which have no bow (y). Twin:
 * test/twins/precipitation.ts
 */
export const fallExtinctions = /*#__PURE__*/ Fn(
  ([rate, snow, hail]: [Float, Float, Float]) => {
    const { rain: r, snow: s, hail: h } = extinctionForm
    const drops = rate
      .pow(r[1])
      .mul(snow.oneMinus())
      .mul(r[0] / 1000)
    const others = rate
      .pow(s[1])
      .mul(snow)
      .mul(s[0] / 1000)
      .add(hail.mul(h / 1000))
      .toConst()
    return vec2(drops.add(others), others)
  },
  layout('precipitationExtinctions', 'vec2', { rate: 'float', snow: 'float', hail: 'float' })
)
