import { Fn } from 'three/tsl'
import { layout, type Float } from '../../tsl-types'
import { fallForm, streakBound, STRONGEST } from '../fallForm'

/** Deviation of the streaks' noise near by. */
const STREAK_DEVIATION = Math.hypot(fallForm.coarseStreaks, fallForm.fineStreaks)

/**
 * Rate of a streak over that of its column: of a normal distribution of logarithms, as rates of rain have, cut off at `STRONGEST`, with
 * mean 1. Twin: test/twins/precipitation.ts
 *
 * @param noise - Sum of billows, whose variance is that of `fallForm` where none are lost.
 * @param amount - Factor of the noise.
 * @param lost - Share of the billows' deviation that blur has taken, in [0, 1].
 * @see Crow & Shimizu 1988, "Lognormal distributions", chapter 8, "Applications in atmospheric sciences"
 */
export const fallStreak = /*#__PURE__*/ Fn(
  ([noise, amount, lost]: [Float, Float, Float]) => {
    const deviation = amount.mul(lost.oneMinus()).mul(STREAK_DEVIATION).toConst()
    const { from, factor } = streakBound
    const cut = deviation.sub(from).max(0).toConst()
    const median = cut.mul(cut).mul(factor).sub(deviation.mul(deviation).div(2))
    return noise.mul(amount).add(median).exp().min(STRONGEST)
  },
  layout('precipitationStreak', 'float', { noise: 'float', amount: 'float', lost: 'float' })
)
