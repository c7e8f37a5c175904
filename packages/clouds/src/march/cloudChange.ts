import type { CloudField } from '../density/CloudField'
import { LAYER_STRIDE, movedVectors } from '../layers/layerUniforms'

const { first, count, last } = movedVectors

/** True for vectors of a layer that camera and wind move. */
const isMoved = (slot: number): boolean =>
  (slot >= first && slot < first + count) || slot >= LAYER_STRIDE - last

/** Form of the clouds, without what camera and wind move: of each layer, vectors one after the other. */
export const cloudForms = ({ values }: CloudField): readonly number[] =>
  values.flatMap((vector, i) => (isMoved(i % LAYER_STRIDE) ? [] : vector.toArray()))

/** Numbers of a layer among `cloudForms`. */
const LAYER_NUMBERS = 4 * (LAYER_STRIDE - count - last)

/**
 * All that shapes and lights the clouds, as numbers to compare with the last frame's.
 *
 * @param forms - The frame's `cloudForms`.
 */
export function cloudInputs(
  forms: readonly number[],
  { night, ambient }: CloudField,
  lightVersion: number
): readonly number[] {
  const { moonDirection, moonIrradiance, skyRadiance } = night
  const light = [moonDirection, moonIrradiance, skyRadiance]
  return [...forms, ...light.flatMap(({ value }) => value.toArray()), ambient.value, lightVersion]
}

/** Difference of some numbers of two lists over the greatest of either, in [0, 2]. Called often: it makes no lists. */
function relativeChange(
  a: readonly number[],
  b: readonly number[],
  first: number,
  length = 1
): number {
  let most = 0
  let change = 0
  for (let i = first; i < first + length; i++) {
    most = Math.max(most, Math.abs(a[i]), Math.abs(b[i]))
    change = Math.max(change, Math.abs(a[i] - b[i]))
  }
  return most && change / most
}

/**
 * Change of the clouds' form between two frames: the greatest of any layer's coverage, of its altitude in thicknesses, and of what
 * else shapes it, as a part of that.
 *
 * @param now - Forms by `cloudForms`.
 * @param before - Forms of the last frame; empty for the first one.
 */
export function formChange(now: readonly number[], before: readonly number[]): number {
  let most = 0
  for (let first = 0; first < before.length; first += LAYER_NUMBERS) {
    const coverage = first + 2
    // What covers nothing is not seen to change.
    if (Math.max(now[coverage], before[coverage]) === 0) continue
    const rise = Math.abs(now[first] - before[first]) * now[first + 1]
    most = Math.max(most, rise, Math.abs(now[coverage] - before[coverage]))
    // Thickness, density and the period of the shape each by itself; all others with those of their vector, since some are often 0.
    for (const k of [1, 3, 7]) most = Math.max(most, relativeChange(now, before, first + k))
    for (let k = 4; k < LAYER_NUMBERS; k += 4) {
      most = Math.max(most, relativeChange(now, before, first + k, 4))
    }
  }
  return most
}
