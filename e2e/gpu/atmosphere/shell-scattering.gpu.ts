import { AtmosphereParameters, type Spectrum } from '@welkin/atmosphere'
import { vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { AtmosphereUniforms } from '../../../packages/atmosphere/src/air/AtmosphereUniforms'
import {
  distanceToGround as distanceToGround64,
  distanceToTop as distanceToTop64,
  hitsGround
} from '../../../packages/atmosphere/src/air/cpu/boundary'
import { inScatter } from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import { opticalDepth } from '../../../packages/atmosphere/src/transmittance/cpu/transmittance'
import {
  ProfileUniforms,
  columnsToSpace,
  profileAt
} from '../../../packages/atmosphere/src/shell/tsl/chapman'
import {
  distanceToGround,
  distanceToTop,
  groundDiscriminant
} from '../../../packages/atmosphere/src/air/tsl/boundary'
import type { Air } from '../../../packages/atmosphere/src/scattering/tsl/ray'
import type { AirSegment } from '../../../packages/atmosphere/src/shell/tsl/shellMarch'
import { singleScatteringLight } from '../../../packages/atmosphere/src/shell/tsl/singleScattering'
import { random } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { RADIUS } from '../harness/shell'

gpuTest('knows how much air is between a point and the sun without a table', async t => {
  // A wavelength per constituent, so that depths are columns; and air that ends where none is left.
  const one = (k: number): Spectrum => [0, 1, 2, 3].map(i => (i === k ? 1e-5 : 0)) as never
  const parameters = new AtmosphereParameters({
    topRadius: RADIUS + 120_000,
    rayleighScattering: one(0),
    mieScattering: [0, 0, 0, 0],
    mieExtinction: one(1),
    absorptionExtinction: one(2)
  })
  const uniforms = new AtmosphereUniforms()
  uniforms.update(parameters, 1)
  const constants = new ProfileUniforms()
  constants.update(parameters)
  const { bottomRadius, topRadius } = parameters
  const inputs = Array.from({ length: 600 }, (_, i) => {
    const altitude = 3e4 * ((i * 0.6180339887) % 1) ** 2
    const horizon = -Math.sqrt(altitude * (2 * bottomRadius + altitude)) / (bottomRadius + altitude)
    return [altitude, horizon + (1 - horizon) * ((i * 0.7548776662) % 1) ** 2].map(Math.fround)
  })
  const results = await t.evaluate(inputs, input => {
    const profile = profileAt(uniforms, constants, input.x)
    return vec4(columnsToSpace(uniforms, constants, input.x, input.y, profile), 1)
  })
  const worst = [0, 0, 0]
  inputs.forEach(([altitude, cosView], i) => {
    const radius = bottomRadius + altitude
    const length = distanceToTop64(radius, cosView, topRadius)
    const expected = opticalDepth(parameters, radius, cosView, length)
    worst.forEach((most, k) => {
      // Less than a hundredth of the vertical column is no air to speak of.
      const least = [80, 12, 150][k]
      const error = Math.abs(results[4 * i + k] - expected[k] * 1e5) / (expected[k] * 1e5 + least)
      worst[k] = Math.max(most, error)
    })
  })
  t.note(`worst: ${worst.map(error => error.toFixed(3)).join(', ')}`)
  const [molecules, aerosols, absorber] = worst
  expectTrue(molecules < 0.015, `molecules are off by ${molecules}`)
  expectTrue(aerosols < 0.015, `aerosols are off by ${aerosols}`)
  expectTrue(absorber < 0.3, `the absorber is off by ${absorber}`)
})

/** Segment in the air of a ray of altitude, μ, μ_s and ν, from within the air. */
function segmentOf({ bottomRadius, thickness }: AtmosphereUniforms, ray: Node<'vec4'>): AirSegment {
  const { x: altitude, y: cosView, z: cosLight, w: cosViewLight } = ray
  const radius = bottomRadius.add(altitude).toConst()
  const discriminant = groundDiscriminant(altitude, cosView, bottomRadius).toConst()
  const meetsGround = discriminant.greaterThanEqual(0).and(cosView.lessThan(0)).toConst()
  const nearest = cosView.mul(cosView).oneMinus().sqrt().mul(radius).sub(bottomRadius).max(0)
  return {
    altitude,
    radius,
    radiusCosView: radius.mul(cosView).toConst(),
    radiusCosSun: radius.mul(cosLight).toConst(),
    cosViewLight,
    lowestAltitude: meetsGround.select(0, cosView.lessThan(0).select(nearest, altitude)).toConst(),
    hitsGround: meetsGround,
    length: meetsGround
      .select(
        distanceToGround(altitude, cosView, discriminant, bottomRadius),
        distanceToTop(altitude, cosView, bottomRadius, thickness)
      )
      .toConst()
  }
}

gpuTest(
  'scatters once as float64 has it, with few points',
  async t => {
    const parameters = new AtmosphereParameters()
    const uniforms = new AtmosphereUniforms()
    uniforms.update(parameters, 1)
    const constants = new ProfileUniforms()
    constants.update(parameters)
    const { bottomRadius, topRadius } = parameters
    const next = random(7)
    for (const [name, sunRange, most] of [
      ['by day', [0.2, 1], [0.003, 0.02]],
      ['at dusk', [-0.05, 0.15], [0.015, 0.12]]
    ] as const) {
      const rays = Array.from({ length: 400 }, (_, i) => {
        // From the ground, from within the air, and from its top, where rays from space come in.
        const altitude = [2, 2 + 2e4 * next() ** 2, topRadius - bottomRadius][i % 3]
        const cosView =
          i % 3 === 2 ? -0.2 - 0.8 * next() : (i % 2 ? 1 : -1) * (0.01 + 0.99 * next())
        const cosLight = sunRange[0] + (sunRange[1] - sunRange[0]) * next()
        const [sinView, sinLight] = [cosView, cosLight].map(x => Math.sqrt(1 - x * x))
        const cosViewLight = cosView * cosLight + sinView * sinLight * Math.cos(Math.PI * next())
        return [altitude, i % 3 === 0 ? Math.abs(cosView) : cosView, cosLight, cosViewLight].map(
          Math.fround
        )
      })
      const results = await t.evaluate(rays, input => {
        const ray = input.toVar()
        return singleScatteringLight({ uniforms } as Air, constants, segmentOf(uniforms, ray))
          .radiance
      })
      const errors: number[] = []
      rays.forEach(([altitude, cosView, cosLight, cosViewLight], i) => {
        const radius = bottomRadius + altitude
        const length = hitsGround(radius, cosView, bottomRadius)
          ? distanceToGround64(radius, cosView, bottomRadius)
          : distanceToTop64(radius, cosView, topRadius)
        const ray = { radius, cosView, cosLight, cosViewLight }
        const [, green] = inScatter(parameters, null, ray, length)
        if (green > 1e-5) errors.push(Math.abs(results[4 * i + 1] / green - 1))
      })
      errors.sort((x, y) => x - y)
      const [middle, high] = [0.5, 0.95].map(part => errors[Math.floor(part * errors.length)])
      t.note(`${name}: median ${(100 * middle).toFixed(2)} %, p95 ${(100 * high).toFixed(1)} %`)
      expectTrue(errors.length > 300, `${name}: only ${errors.length} rays have light`)
      expectTrue(middle < most[0] && high < most[1], `${name}: off by ${middle}, ${high}`)
    }
  },
  // The same numbers on both.
  { backends: ['webgpu'] }
)
