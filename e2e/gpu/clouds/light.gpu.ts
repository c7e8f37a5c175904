import { Atmosphere } from '@welkin/atmosphere'
import { CloudField, CloudLayers, CloudLightTable, DropletLightTable } from '@welkin/clouds'
import { DataTexture, PerspectiveCamera } from 'three'
import { float, step, texture, vec4 } from 'three/tsl'
import type { Node, NodeFrame } from 'three/webgpu'
import { weatherCacheAt } from '../../../packages/clouds/src/density/tsl/sampler'
import { lightAt } from '../../../packages/clouds/src/light/tsl/lighting'
import { localDepths } from '../../../packages/clouds/src/light/tsl/localDepths'
import type {
  ShadedSample,
  ShadingContext
} from '../../../packages/clouds/src/light/tsl/shadingContext'
import { QualityUniforms } from '../../../packages/clouds/src/march/quality'
import { layersAt } from '../../../packages/clouds/src/march/tsl/layerBoundaries'
import type { CloudShadows } from '../../../packages/clouds/src/shadow/tsl/sampleShadows'
import { number } from '../../../packages/clouds/src/uniforms'
import * as twin from '../../../packages/clouds/test/twins/cloudLight'
import { solveCloudLight } from '../../../packages/clouds/test/twins/cloudLightTable'
import { aureolePhase, cloudPhase } from '../../../packages/clouds/test/twins/cloudPhase'
import { fineStructure } from '../../../packages/clouds/test/twins/fineStructure'
import {
  scalePhase,
  type CloudPhaseParameters
} from '../../../packages/clouds/src/light/cpu/cloudPhase'
import {
  cloudAmbientShares,
  cloudSource,
  litGround
} from '../../../packages/clouds/src/light/tsl/cloudLight'
import { singlePhase } from '../../../packages/clouds/src/light/tsl/cloudPhase'
import { inFog, middle } from '../harness/cloud-view'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Evenly spread numbers in [0, 1), the same in every run. */
const spread = (i: number, k: number): number =>
  (i * [0.6180339887, 0.7548776662, 0.5698402911, 0.8191725134][k]) % 1
const rows = (count: number, row: (i: number) => number[]): number[][] =>
  Array.from({ length: count }, (_, i) => row(i).map(Math.fround))
const depthAt = (u: number): number => Math.exp(-4 + 9 * u)

const phases: Partial<CloudPhaseParameters>[] = [
  {},
  { forwardAsymmetry: 0.85, forwardShare: 1 },
  { forwardAsymmetry: 0, backwardAsymmetry: 0 }
]

gpuTest(
  'scatters sunlight like its float64 twin',
  async t => {
    const renderer = await t.createRenderer()
    for (const parameters of phases) {
      const light = new CloudLightTable(parameters)
      light.bake()
      const table = solveCloudLight(light.phase)
      for (const [layered, cosLight, filled] of [
        [1, 0.7, 0.5],
        [1, 0.03, 1],
        [1, -0.2, 1],
        [0, 0.4, 0.2],
        [0.5, 0.9, 2]
      ]) {
        const inputs = rows(200, i => {
          const through = depthAt(spread(i, 0))
          const cosView = 2 * spread(i, 2) - 1
          const sines = Math.sqrt((1 - cosView ** 2) * (1 - cosLight ** 2))
          const cosViewLight = cosView * cosLight + sines * Math.cos(2 * Math.PI * spread(i, 3))
          return [through * spread(i, 1), through, cosView, cosViewLight]
        })
        const results = await evaluateOnGpu(renderer, inputs, input =>
          vec4(
            cloudSource(light.nodes, {
              depthToLight: input.x,
              depthThrough: input.y,
              depthAcross: input.y.mul(1.3),
              depthToCamera: float(0.3),
              viewChord: [float(0.3), input.x.mul(0.4)],
              verticalChord: [input.y.mul(0.2), input.x],
              filled: float(filled),
              resolved: float(0.7),
              layered: float(layered),
              cosLight: float(cosLight),
              cosView: input.z,
              cosViewLight: input.w
            })
          )
        )
        const expected = inputs.map(([depthToLight, depthThrough, cosView, cosViewLight]) =>
          twin.cloudSource(light.phase, table, {
            depthToLight,
            depthThrough,
            depthAcross: 1.3 * depthThrough,
            depthToCamera: 0.3,
            viewChord: [0.3, 0.4 * depthToLight],
            verticalChord: [0.2 * depthThrough, depthToLight],
            filled,
            resolved: 0.7,
            layered,
            cosLight: cosLight,
            cosView,
            cosViewLight
          })
        )
        // Texels are half floats, and filtered at their positions' 1/256.
        const found = inputs.map((_, i) => results[4 * i])
        expectClose(found, expected, { absolute: 3e-4, relative: 0.01 }, `${layered} ${cosLight}`)
      }
      light.dispose()
    }
  },
  // The same numbers on both.
  { backends: ['webgpu'] }
)

gpuTest('has the phase function of its float64 twin, in the aureole too', async t => {
  const renderer = await t.createRenderer()
  const light = new CloudLightTable({ forwardAsymmetry: 0.9 })
  const inputs = rows(300, i => [1 - (i / 300) ** 3 * 2, depthAt(spread(i, 0))])
  const results = await evaluateOnGpu(renderer, inputs, input =>
    vec4(singlePhase(light.nodes, input.x, input.y))
  )
  const expected = inputs.map(([cosine, depth]) => {
    const exact = cloudPhase(light.phase, cosine)
    const towards = Math.min(Math.max(10 * cosine - 9, 0), 1)
    return exact + (aureolePhase(light.phase, cosine, depth) - exact) * towards
  })
  expectClose(
    inputs.map((_, i) => results[4 * i]),
    expected,
    { absolute: 1e-5, relative: 2e-3 }
  )
  light.dispose()
})

gpuTest(
  'has bow and glory of droplets like the float64 twin',
  async t => {
    const renderer = await t.createRenderer()
    const radius = 9
    const light = new DropletLightTable({ dropletRadius: radius })
    const { depthScale } = scalePhase(light.phase)
    const inputs = rows(300, i => {
      const angle = Math.PI * spread(i, 2)
      return [depthAt(spread(i, 0)), 0.3 * depthAt(spread(i, 1)), Math.cos(angle)]
    })
    const results = await evaluateOnGpu(renderer, inputs, input =>
      light.nodes.fineStructure!({
        depthToLight: input.x,
        depthToCamera: input.y,
        cosViewLight: input.z,
        cosView: float(0),
        cosLight: float(0),
        altitude: float(1000)
      })
    )
    inputs.forEach(([toLight, toCamera, cosine], i) => {
      const depth = (toLight + toCamera) / depthScale
      const expected = fineStructure(light.phase, radius, cosine, depth, toCamera)
      const label = `cosine ${cosine}, depth ${depth}`
      expectClose(results[4 * i + 2], expected, { absolute: 3e-4, relative: 0.02 }, label)
    })
    light.dispose()
  },
  // The same numbers on both.
  { backends: ['webgpu'] }
)

gpuTest('scatters light of sky and ground like its float64 twin', async t => {
  const renderer = await t.createRenderer()
  const light = new CloudLightTable()
  light.bake()
  const table = solveCloudLight(light.phase)
  const inputs = rows(300, i => [
    depthAt(spread(i, 0)) * spread(i, 3),
    depthAt(spread(i, 1)),
    2 * spread(i, 2) - 1,
    i % 2
  ])
  const results = await evaluateOnGpu(renderer, inputs, input => {
    const { x: depthAbove, y: depthBelow, z: cosView, w: layered } = input
    const sample = { depthAbove, depthBelow, cosView, layered }
    const { sky, ground } = cloudAmbientShares(light.nodes, sample)
    const [radius, altitude] = [float(1500), depthAbove.mul(200)]
    const shade = { layered, radius, altitude, albedo: cosView.abs() }
    const cloud = { ...shade, depthThrough: depthBelow, cosLight: cosView }
    return vec4(sky, ground, litGround(light.nodes, cloud), 0)
  })
  const expected = inputs.flatMap(([depthAbove, depthBelow, cosView, layered]) => {
    const sample = { depthAbove, depthBelow, cosView, layered }
    const { sky, ground } = twin.cloudAmbient(table, sample)
    const [radius, altitude] = [1500, 200 * depthAbove]
    const shade = { layered, radius, altitude, albedo: Math.abs(cosView) }
    const cloud = { ...shade, depthThrough: depthBelow, cosLight: cosView }
    return [sky, ground, twin.litGround(light.phase, cloud), 0]
  })
  expectClose(Array.from(results), expected, { absolute: 3e-3 })
  light.dispose()
})

gpuTest('gives no NaN at the ends of its domain', async t => {
  const renderer = await t.createRenderer()
  const light = new CloudLightTable()
  light.bake()
  const ends = [0, 1e-8, 1, 1e6]
  const inputs = ends.flatMap(toSun =>
    ends.flatMap(through => [-1, 0, 1].map(cosView => [toSun, through, cosView, cosView]))
  )
  for (const layered of [0, 1]) {
    for (const cosLight of [-1, 0, 1]) {
      const results = await evaluateOnGpu(renderer, inputs, input => {
        const sample = { layered: float(layered), cosView: input.z }
        const depths = { depthAbove: input.x, depthBelow: input.y }
        const { sky, ground } = cloudAmbientShares(light.nodes, { ...sample, ...depths })
        const source = cloudSource(light.nodes, {
          ...sample,
          depthToLight: input.x,
          depthThrough: input.y,
          depthAcross: input.y,
          depthToCamera: input.x,
          viewChord: [input.x, input.y],
          verticalChord: [input.y, input.x],
          filled: input.x,
          cosLight: float(cosLight),
          cosViewLight: input.w
        })
        return vec4(source, sky, ground, 0)
      })
      expectTrue(
        results.every(value => Number.isFinite(value) && value >= 0 && value < 100),
        'finite and positive'
      )
    }
  }
  light.dispose()
})

gpuTest(
  'scales the light of sky and ground on clouds by their `ambient`, and no sunlight',
  t =>
    inFog(t, async view => {
      view.node.accumulates = false
      const brightness = async (ambient: number): Promise<number> => {
        view.node.ambient = ambient
        return middle(await view.draw())
      }
      const before = middle(await view.draw(2))
      const [none, once, twice] = [await brightness(0), await brightness(1), await brightness(2)]
      t.note(`${none.toFixed(4)}, ${once.toFixed(4)}, ${twice.toFixed(4)}`)
      expectClose(once, before, { relative: 2e-3 }, 'by default')
      expectTrue(none > 0.1 * once && none < 0.99 * once, `without ${none} of ${once}`)
      expectClose(twice - once, once - none, { relative: 0.05 }, 'twice the light')
    }),
  { backends: ['webgpu'] }
)

gpuTest(
  'sees the lid of a place in a tall cloud, however far its layer’s top is; decks count whole',
  async t => {
    const renderer = await t.createRenderer()
    const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 })
    const layers = new CloudLayers([{ baseAltitude: 1000, topAltitude: 11_000 }])
    const lid = (altitude: Node<'float'>, from: number, to: number): Node<'float'> =>
      step(from, altitude).mul(step(altitude, float(to)))
    const field = new CloudField(atmosphere, layers, undefined, {
      // Two shelves of cloud; a lid over the lower one.
      extinction: ({ altitude }) =>
        lid(altitude, 1500, 1600)
          .add(lid(altitude, 1700, 1900))
          .add(lid(altitude, 5000, 5100))
          .mul(0.05)
    })
    const camera = new PerspectiveCamera()
    const view = atmosphere.update(renderer, camera)
    field.view.update({ renderer, camera } as unknown as NodeFrame)
    field.update(view, 0)
    const map = texture(new DataTexture(new Uint8Array(4), 1, 1))
    const shadows = { map, cascades: [], count: 1, isMoonlit: number() } as unknown as CloudShadows
    const context = { field, shadows, quality: new QualityUniforms() } as unknown as ShadingContext
    const inputs = [1550, 5050].flatMap(altitude => [0, 1].map(layered => [altitude, layered]))
    const results = await evaluateOnGpu(renderer, inputs, ({ x: altitude, y: layered }) => {
      const { up } = field.view
      const offset = up.mul(altitude.sub(field.view.height)).toConst() as Node<'vec3'>
      const sample = { offset, ...field.view.localCoordinates(offset), distance: float(1000) }
      const weather = weatherCacheAt(field, sample, layersAt(field, sample.altitude).range)
      const around = { base: float(1000), top: float(11_000), layered, density: float(1) }
      const shaded = { sample, weather, layers: around } as unknown as ShadedSample
      const source = lightAt(context, sample)
      return localDepths(context, shaded, source).above
    })
    const [under, deck, open, deckAbove] = [0, 1, 2, 3].map(i => results[4 * i])
    t.note([under, deck, open, deckAbove].map(x => x.toFixed(1)).join(', '))
    expectTrue(under > 3 * open, `${under} under the lid, ${open} without one`)
    // A deck is looked at far above, where both are clear.
    expectClose(deck / deckAbove, (11_000 - 1550) / (11_000 - 5050), { relative: 1e-3 }, 'in decks')
    field.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)
