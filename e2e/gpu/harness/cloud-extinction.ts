import { If, float } from 'three/tsl'
import type { CloudField } from '../../../packages/clouds/src/density/CloudField'
import {
  forLayers,
  heightIn,
  isWithin,
  layerAt
} from '../../../packages/clouds/src/density/tsl/layer'
import { subpointOffset, type CloudSample } from '../../../packages/clouds/src/density/tsl/sample'
import { sampleLayer } from '../../../packages/clouds/src/density/tsl/sampleLayer'
import { backgroundAt } from '../../../packages/clouds/src/density/tsl/sampler'
import { effectiveOpticalDepth } from '../../../packages/clouds/src/density/tsl/unresolved'
import { filteredCoverageAt } from '../../../packages/clouds/src/density/tsl/weather'
import type { Float } from '../../../packages/clouds/src/tsl-types'

/**
 * Extinction of all clouds at a place, in the weather of that very place: pixels, shadows and light come near
 * to it with backgrounds that they share between places.
 *
 * @param detail - True if edges have detail.
 * @returns [1/m], at least 0. Twin: packages/clouds/test/twins/density.ts
 */
export function cloudExtinction(field: CloudField, sample: CloudSample, detail: boolean): Float {
  const sum = float(0).toVar()
  forLayers(field, index => {
    const layer = layerAt(field, index)
    If(isWithin(layer, heightIn(layer, sample.altitude)), () => {
      const background = backgroundAt(field, layer, sample)
      sum.addAssign(sampleLayer(field, layer, background, sample, { detail }).extinction)
    })
  })
  return sum
}

/**
 * Vertical optical depth of all clouds above or below a place of the ground, from the weather alone.
 *
 * @param sample - Any altitude: that is not looked at, but `offset` must agree with it.
 */
export function verticalOpticalDepth(field: CloudField, sample: CloudSample): Float {
  const subpoint = subpointOffset(field, sample).toConst()
  const sum = float(0).toVar()
  forLayers(field, index => {
    const layer = layerAt(field, index)
    const filteredCoverage = filteredCoverageAt(field, layer, subpoint, sample)
    sum.addAssign(effectiveOpticalDepth(field, layer, filteredCoverage))
  })
  return sum
}
