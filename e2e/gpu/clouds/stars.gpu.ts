import { stars, starsOverlay } from '@welkin/atmosphere'
import { vec4 } from 'three/tsl'
import { expectLight } from '../harness/atmosphere'
import { coarse, fog, inFog, viewSize } from '../harness/cloud-view'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const sum = ({ data }: Picture): number =>
  data.reduce((total, value, i) => (i % 4 === 3 ? total : total + value), 0)

gpuTest(
  'clouds dim stars that are drawn last by what they let through',
  t =>
    inFog(t, async view => {
      const { atmosphere, camera, node } = view
      node.set({ accumulates: false, quality: { ...coarse, block: 1 } })
      const layer = node.field.layers.at(0)
      atmosphere.add(stars({ overlay: true }))
      camera.rotation.x = 1
      const { transmittance, depthNode } = node
      const overlay = (options = {}) =>
        starsOverlay(vec4(0), depthNode, camera, atmosphere, options)
      const outputs = [vec4(transmittance), overlay({ transmittance }), overlay()]
      for (const density of [0, 2e-4, 5e-2]) {
        layer.set(density > 0 ? { coverage: 1, density } : { coverage: 0, density: fog.density })
        view.show(node)
        expectLight(await view.draw(2), `clouds of ${density}/m`)
        const sums: number[] = []
        for (const shown of outputs) {
          view.show(shown)
          sums.push(sum(await view.draw()))
        }
        const passing = sums[0] / (3 * viewSize.width * viewSize.height)
        const left = sums[1] / sums[2]
        t.note(`${density}/m: ${passing.toFixed(4)} passes, ${left.toFixed(4)} of the stars`)
        expectTrue(sums[2] > 0, 'there are no stars')
        expectTrue(Math.abs(left - passing) < 0.03, `${left} of the stars, not ${passing}`)
        if (density === 0) expectTrue(left === 1, `without clouds ${left}`)
        if (density === 2e-4) expectTrue(left > 0.6 && left < 0.95, `behind a veil ${left}`)
        if (density === 5e-2) expectTrue(left < 1e-4, `behind a deck ${left}`)
      }
    }),
  { backends: ['webgpu'] }
)
