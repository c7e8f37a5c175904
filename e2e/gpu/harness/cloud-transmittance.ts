import type { CloudLightTable, CloudsNode } from '@welkin/clouds'
import { float } from 'three/tsl'
import type { WebGPURenderer } from 'three/webgpu'
import { loop, type Vec3 } from '../../../packages/clouds/src/tsl-types'
import { cloudExtinction } from './cloud-extinction'
import { evaluateOnGpu } from './evaluate'

/** Length of the march towards the sun [m], and its steps. */
const LENGTH = 3500
const STEPS = 64

/**
 * Part of the sunlight that clouds let through to places, by a march towards the sun.
 *
 * @param places - In the view of the clouds' camera [m].
 */
export async function cloudTransmittance(
  renderer: WebGPURenderer,
  { field }: CloudsNode,
  light: CloudLightTable,
  places: readonly [number, number, number][]
): Promise<number[]> {
  const inputs = places.map(place => [...place, 0])
  const depths = await evaluateOnGpu(renderer, inputs, input => {
    const depth = float(0).toVar()
    const start = field.view.toMapped(input.xyz).toConst()
    const length = LENGTH / STEPS
    loop('step', STEPS, index => {
      const distance = float(index).add(0.5).mul(length)
      const offset = start.add(field.view.lightDirection.mul(distance)).toConst() as Vec3
      const { altitude, up } = field.view.localCoordinates(offset)
      const sample = { offset, altitude, up, distance: float(1000).toConst() }
      depth.addAssign(cloudExtinction(field, sample, false).mul(length))
    })
    return depth.mul(light.nodes.depthScale)
  })
  return places.map((_, i) => Math.exp(-depths[4 * i]))
}
