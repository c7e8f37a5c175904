import {
  Atmosphere,
  AtmosphereParameters,
  iceCrystals,
  standardEarthParameters
} from '@welkin/atmosphere'
import { PerspectiveCamera } from 'three'
import { float, vec4 } from 'three/tsl'
import { AtmosphereUniforms } from '../../../packages/atmosphere/src/air/AtmosphereUniforms'
import * as boundaryTwin from '../../../packages/atmosphere/src/air/cpu/boundary'
import {
  diffuseColumnCosine,
  sampleDiffuseLight
} from '../../../packages/atmosphere/src/diffuseLight/cpu/diffuseLight'
import { densities as densitiesTwin } from '../../../packages/atmosphere/src/air/cpu/medium'
import { crystalPhase } from '../../../packages/atmosphere/test/twins/optics/sunDog'
import * as phaseTwin from '../../../packages/atmosphere/src/air/cpu/phase'
import { skyIrradiance as skyIrradianceTwin } from '../../../packages/atmosphere/src/diffuseLight/cpu/skyIrradiance'
import { solveDiffuseLight } from '../../../packages/atmosphere/src/diffuseLight/cpu/solveDiffuseLight'
import { lightTransmittance as lightTransmittanceTwin } from '../../../packages/atmosphere/src/transmittance/cpu/transmittance'
import {
  altitudeAlong,
  distanceToGround,
  distanceToTop,
  groundDiscriminant
} from '../../../packages/atmosphere/src/air/tsl/boundary'
import { densities } from '../../../packages/atmosphere/src/air/tsl/medium'
import { miePhase, rayleighPhase } from '../../../packages/atmosphere/src/air/tsl/phase'
import { skyIrradiance } from '../../../packages/atmosphere/src/diffuseLight/tsl/skyIrradiance'
import { lightTransmittance } from '../../../packages/atmosphere/src/transmittance/tsl/transmittance'
import { viewNodes } from '../../../packages/atmosphere/src/view/ViewNodes'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { keepTables, reuseTables } from '../harness/reuse-tables'

const earth = new AtmosphereParameters()
const bottom = earth.bottomRadius
const thickness = 60_000

/** Evenly spread numbers in [0, 1), the same in every run. */
const spread = (i: number, k: number): number =>
  (i * [0.6180339887, 0.7548776662, 0.5698402911, 0.8191725134][k]) % 1

const count = 1000
const table = (row: (i: number) => number[]): number[][] =>
  Array.from({ length: count }, (_, i) => row(i).map(Math.fround))
const first = (results: Float32Array): number[] =>
  Array.from({ length: results.length / 4 }, (_, i) => results[4 * i])

// First: others take what it bakes.
gpuTest(
  'bakes the diffuse light that float64 solves',
  async t => {
    // Keeps what it bakes, and takes nothing.
    reuseTables(true, false)
    const renderer = await t.createRenderer()
    const atmosphere = new Atmosphere({ parameters: earth })
    await atmosphere.bake(renderer)
    const baked = atmosphere.tables.data!
    const solved = solveDiffuseLight(earth)
    let worst = 0
    for (const altitude of [0, 0.05, 0.3, 0.9]) {
      for (let column = 30; column < 96; column += 5) {
        const cosLight = diffuseColumnCosine(column)
        const [got, want] = [baked, solved].map(data =>
          sampleDiffuseLight(data, altitude, cosLight)
        )
        // Density of light and irradiances; the other moments cross zero.
        for (const tile of [0, 6, 7]) {
          got[tile].forEach((value, k) => {
            const expected = want[tile][k]
            worst = Math.max(worst, Math.abs(value - expected) / (expected + 1e-6))
          })
        }
      }
    }
    t.note(`worst difference ${(100 * worst).toFixed(2)} %`)
    expectTrue(worst < 0.03, `worst relative difference is ${worst}`)
    await keepTables()
    atmosphere.dispose()
  },
  // Light and skies on WebGL are those of float64 by tables that it has baked: see `atmosphere/light`.
  { bakes: true, backends: ['webgpu'] }
)

gpuTest('finds the top of the air within 2 m', async t => {
  const inputs = table(i => [thickness * spread(i, 0), 2 * spread(i, 1) - 1])
  const results = await t.evaluate(inputs, input =>
    distanceToTop(input.x, input.y, float(bottom), float(thickness))
  )
  const expected = inputs.map(([h, mu]) =>
    boundaryTwin.distanceToTop(bottom + h, mu, bottom + thickness)
  )
  expectClose(first(results), expected, { absolute: 2, relative: 3e-7 })
})

gpuTest('finds the ground where float64 does', async t => {
  const inputs = table(i => {
    const height = Math.exp(Math.log(2) + spread(i, 0) * Math.log(1e7))
    const horizon = -Math.sqrt(height * (2 * bottom + height)) / (bottom + height)
    // Not at the horizon itself, where one digit of the cosine is kilometres.
    return [height, -1 + (horizon + 1) * 0.99 * spread(i, 1)]
  })
  const results = await t.evaluate(inputs, input => {
    const discriminant = groundDiscriminant(input.x, input.y, float(bottom))
    return vec4(distanceToGround(input.x, input.y, discriminant, float(bottom)), discriminant, 0, 1)
  })
  const expected = inputs.map(([h, mu]) => boundaryTwin.distanceToGround(bottom + h, mu, bottom))
  expectClose(first(results), expected, { absolute: 0.1, relative: 1e-4 })
  inputs.forEach((_, i) => expectTrue(results[4 * i + 1] >= 0, `input ${i} meets the ground`))
})

gpuTest('knows heights along rays within 10 cm + 3e-6 of the way', async t => {
  const inputs = table(i => [
    thickness * spread(i, 0),
    2 * spread(i, 1) - 1,
    Math.exp(13 * spread(i, 2))
  ])
  const results = await t.evaluate(inputs, input =>
    altitudeAlong(input.x, input.y, input.z, float(bottom))
  )
  inputs.forEach(([h, mu, d], i) => {
    const r = bottom + h
    const expected = Math.hypot(r * Math.sqrt(1 - mu ** 2), r * mu + d) - bottom
    expectClose(results[4 * i], expected, { absolute: 0.1 + 3e-6 * (d + h) }, `height ${h}`)
  })
})

gpuTest('scatters as the phase functions say', async t => {
  const inputs = table(i => [2 * spread(i, 0) - 1])
  for (const g of [-0.5, 0, 0.8, 0.9]) {
    const uniforms = new AtmosphereUniforms()
    uniforms.update(new AtmosphereParameters({ mieAsymmetry: g }), 1)
    const results = await t.evaluate(inputs, input =>
      vec4(rayleighPhase(input.x), miePhase(uniforms, input.x).x, 0, 1)
    )
    inputs.forEach(([nu], i) => {
      const expected = [phaseTwin.rayleighPhase(nu), phaseTwin.cornetteShanksPhase(g, nu)]
      expectClose(results.subarray(4 * i, 4 * i + 2), expected, { relative: 1e-4 }, `g ${g}`)
    })
  }
})

gpuTest(
  'has halo and sun dogs of crystals where float64 has them',
  async t => {
    const crystals = iceCrystals({ regular: 0.8, level: 0.6 })
    const renderer = await t.createRenderer()
    const degrees = Math.PI / 180
    const angles = Array.from({ length: 400 }, (_, i) => {
      const sun = 5 + 50 * spread(i, 0)
      // Half of them beside the sun.
      const aside = i % 2 === 0 ? 15 + 45 * spread(i, 1) : 179 * spread(i, 1)
      return [sun + (i % 2 === 0 ? 1 : 30) * (2 * spread(i, 2) - 1), sun, aside]
    })
    const inputs = angles.map(([view, sun, aside]) => {
      const [v, s] = [view, sun].map(angle => Math.sin(angle * degrees))
      const level = Math.cos(view * degrees) * Math.cos(sun * degrees)
      return [v * s + level * Math.cos(aside * degrees), v, s].map(Math.fround)
    })
    const results = await evaluateOnGpu(renderer, inputs, input =>
      crystals.phase({ cosViewLight: input.x, cosView: input.y, cosLight: input.z })
    )
    const found = inputs.map((_, i) => results[4 * i + 2])
    const expected = angles.map(([view, sun, aside]) => crystalPhase(0.8, 0.6, view, sun, aside))
    // At the edges of halos a texel is a third of a degree.
    const errors = found.map((value, i) => Math.abs(value - expected[i]) / (expected[i] + 0.01))
    const sorted = errors.toSorted((a, b) => a - b)
    const [p90, worst] = [sorted[360], sorted[399]]
    t.note(`90th percentile ${(100 * p90).toFixed(2)} %, worst ${(100 * worst).toFixed(1)} %`)
    expectTrue(p90 < 0.01 && worst < 0.1, `${p90}, ${worst}`)
    expectTrue(Math.max(...expected) > 3, 'sun dogs are among them')
    crystals.dispose()
  },
  // The same numbers on both.
  { backends: ['webgpu'] }
)

gpuTest('knows the densities of the air', async t => {
  const inputs = table(i => [120_000 * spread(i, 0) ** 2])
  for (const air of [
    earth,
    standardEarthParameters(),
    new AtmosphereParameters({ rayleighLayers: [[7000, 5000]] }),
    new AtmosphereParameters({
      rayleighLayers: [
        [1000, 9000],
        [20_000, 4000]
      ]
    })
  ]) {
    const uniforms = new AtmosphereUniforms()
    uniforms.update(air, 1)
    const results = await t.evaluate(inputs, input => vec4(densities(uniforms, input.x), 1))
    inputs.forEach(([h], i) => {
      const expected = densitiesTwin(air, h)
      const tolerance = { relative: 2e-5, absolute: 1e-6 * Math.max(...expected) }
      expectClose(results.subarray(4 * i, 4 * i + 3), expected, tolerance, `height ${h}`)
    })
  }
})

gpuTest('reads sunlight within 0.2 % of the sun from the transmittance table', async t => {
  const renderer = await t.createRenderer()
  for (const [air, absolute] of [
    [earth, 2e-3],
    [standardEarthParameters({ ozone: 0 }), 2e-3],
    // The ozone ends between rows of the table, which are 2 km apart there.
    [standardEarthParameters(), 7e-3]
  ] as const) {
    const atmosphere = new Atmosphere({ parameters: air })
    // The first step of a bake draws the transmittance.
    atmosphere.bakeStepsPerFrame = 1
    atmosphere.update(renderer, new PerspectiveCamera())
    const { uniforms, transmittance } = viewNodes(atmosphere).air
    const inputs = table(i => {
      const height = (air.topRadius - bottom) * spread(i, 0) ** 3
      const horizon = -Math.acos(bottom / (bottom + height))
      // Where the whole disc is seen.
      const low = horizon + 1.1 * air.sunAngularRadius
      return [height, Math.sin(low + (Math.PI / 2 - low) * spread(i, 1) ** 2)]
    })
    const results = await evaluateOnGpu(renderer, inputs, input =>
      lightTransmittance(uniforms, transmittance, input.x, input.y)
    )
    const expected = inputs.flatMap(([h, mu]) => lightTransmittanceTwin(air, bottom + h, mu))
    expectClose(results, expected, { absolute })
    atmosphere.dispose()
  }
})

gpuTest('gathers sky light on planes as float64 does', async t => {
  const renderer = await t.createRenderer()
  const atmosphere = new Atmosphere({ parameters: earth })
  await atmosphere.bake(renderer)
  const data = atmosphere.tables.data!
  const { uniforms, diffuse } = viewNodes(atmosphere).air
  const inputs = table(i => {
    const [cosNormal, cosLight] = [2 * spread(i, 0) - 1, 1.2 * spread(i, 1) - 0.2]
    const across = Math.sqrt((1 - cosNormal ** 2) * (1 - cosLight ** 2))
    const cosNormalLight = cosNormal * cosLight + across * Math.cos(2 * Math.PI * spread(i, 2))
    return [thickness * spread(i, 3) ** 2, cosNormal, cosLight, cosNormalLight]
  })
  const results = await evaluateOnGpu(renderer, inputs, input =>
    skyIrradiance(uniforms, diffuse!, input.x, input.y, input.z, input.w)
  )
  inputs.forEach(([h, normal, sun, normalSun], i) => {
    const expected = skyIrradianceTwin(earth, data, h, normal, sun, normalSun)
    const all = Math.max(...skyIrradianceTwin(earth, data, h, 1, sun, sun))
    // Filtering has eight bits between texels.
    const tolerance = { absolute: 0.01 * all + 1e-6, relative: 0.01 }
    expectClose(results.subarray(4 * i, 4 * i + 4), expected, tolerance, `input ${i}`)
  })
  atmosphere.dispose()
})
