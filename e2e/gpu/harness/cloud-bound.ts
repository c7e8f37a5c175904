import type { CloudField } from '@welkin/clouds'
import { If, float } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { surelyEroded } from '../../../packages/clouds/src/density/tsl/emptyDistance'
import {
  forLayers,
  heightIn,
  isWithin,
  layerAt
} from '../../../packages/clouds/src/density/tsl/layer'
import { dimensionalProfile, layerHeight } from '../../../packages/clouds/src/density/tsl/profile'
import { subpointOffset, type CloudSample } from '../../../packages/clouds/src/density/tsl/sample'
import { weatherAt } from '../../../packages/clouds/src/density/tsl/weather'

/**
 * Upper bound on the density of clouds at a place, from dimensional profiles and filtered coverage alone:
 * where it is 0 there is no cloud, whatever the noise.
 *
 * @returns In [0, 1].
 */
export function cloudBound(field: CloudField, sample: CloudSample): Node<'float'> {
  const most = float(0).toVar()
  const subpoint = subpointOffset(field, sample).toConst()
  forLayers(field, index => {
    const layer = layerAt(field, index)
    const height = heightIn(layer, sample.altitude)
    If(isWithin(layer, height), () => {
      const weather = weatherAt(field, layer, subpoint, sample, 'where unresolved')
      const profile = dimensionalProfile(layer, weather.strength, layerHeight(layer, height))
      const near = profile.sub(surelyEroded(layer)).mul(layer.sharpness).clamp(0, 1)
      const isUnresolved = weather.unresolvedFraction.greaterThan(0)
      const far = isUnresolved.select(weather.filteredCoverage, float(0))
      most.assign(most.max(near).max(far))
    })
  })
  return most
}
