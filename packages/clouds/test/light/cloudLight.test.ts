import fc from 'fast-check'
import { gaussLegendre } from '@welkin/atmosphere'
import { beforeAll, describe, expect, it } from 'vitest'
import { flowOver, flowTerms } from '../../scripts/flow'
import { sphereLight, RINGS, STEPS } from '../../scripts/sphere'
import { CloudLightTable } from '../../src/light/CloudLightTable'
import { scalePhase } from '../../src/light/cpu/cloudPhase'
import { SlabSolver } from '../../src/light/cpu/solveSlab'
import { cloudAmbient, cloudSource, flow, lateralLeak, litGround } from '../twins/cloudLight'
import { sampleBeamSource, slabColumn, slabRow, solveCloudLight } from '../twins/cloudLightTable'
import { aureolePhase, cloudPhase } from '../twins/cloudPhase'

const unit = fc.double({ min: 0, max: 1, noNaN: true })
const depths = fc.double({ min: -4, max: 5, noNaN: true }).map(Math.exp)
/** Parts of a slab's depth, as often near either face as in between. */
const parts = fc.oneof(
  unit,
  fc.double({ min: -12, max: 0, noNaN: true }).map(Math.exp),
  fc.double({ min: -12, max: 0, noNaN: true }).map(logarithm => 1 - Math.exp(logarithm))
)
const { phase } = new CloudLightTable()
const rule = gaussLegendre(200)

let table: Float32Array
beforeAll(() => {
  table = solveCloudLight(phase)
})

describe('cloud-light table', () => {
  // Against all scattered light: in thin slabs nearly all of it was scattered but once.
  it('is what the solver says between its texels, within 4 % of the light', () => {
    const solver = new SlabSolver(scalePhase(phase))
    fc.assert(
      fc.property(parts, depths, fc.double({ min: 0.1, max: 1, noNaN: true }), (part, t, mu0) => {
        const [exact] = solver.slab(t, [part * t]).fromBeam(mu0)
        const sampled = sampleBeamSource(table, part * t, t, mu0)
        const once = Math.exp((-part * t) / mu0) / (4 * Math.PI)
        const light = exact.s00 + once
        for (const key of ['s00', 's10', 's20', 's11', 's21', 's22'] as const) {
          // 3.7 % in the thickest slab under the lowest sun, near its faces; 3 % elsewhere.
          expect(Math.abs(sampled[key] - exact[key]) / light).toBeLessThan(0.04)
        }
      }),
      { numRuns: 100 }
    )
  })

  it('places both faces of a slab at its ends, and the middle in the middle', () => {
    fc.assert(
      fc.property(depths, t => {
        expect(slabColumn(0, t)).toBeCloseTo(0, 9)
        expect(slabColumn(t, t)).toBeCloseTo(1, 9)
        expect(slabColumn(t / 2, t)).toBeCloseTo(0.5, 9)
        expect(slabRow(t)).toBeLessThanOrEqual(1)
      })
    )
  })

  it('bakes in steps; a change on the way starts over', () => {
    const light = new CloudLightTable()
    light.update(3)
    expect(light.isReady).toBe(false)
    light.set({ forwardShare: 0.5 })
    light.update(28)
    expect(light.isDirty).toBe(true)
    light.update(1)
    const changed = new CloudLightTable({ forwardShare: 0.5 })
    changed.bake()
    expect(light.isDirty).toBe(false)
    expect(light.isReady).toBe(true)
    expect(light.texture.image.data).toEqual(changed.texture.image.data)
    expect(light.nodes.depthScale.value).toBe(changed.nodes.depthScale.value)
    // Until a table is solved, the old one stands with its phase function.
    light.set({ forwardShare: 0.9 })
    for (let frames = 1; light.isDirty; frames++) {
      expect(light.nodes.forwardShare.value).toBe(0.5)
      expect(frames).toBeLessThan(30)
      light.update(1)
    }
    expect(light.nodes.forwardShare.value).toBe(0.9)
  })

  it.for([
    [{ forwardAsymmetry: 1 }, /forwardAsymmetry must be .* got 1/],
    [{ forwardShare: NaN }, /forwardShare must be .* got NaN/],
    [{ scatteringAlbedo: 1 }, /scatteringAlbedo must be .* got 1/],
    [{ asymmetry: 0.8 }, /unknown option 'asymmetry', there are forwardAsymmetry/]
  ] as [object, RegExp][])('rejects %o', ([parameters, message]) => {
    expect(() => new CloudLightTable(parameters)).toThrow(message)
  })
})

describe('aureole', () => {
  it('is the phase function where nothing was crossed', () => {
    for (const cosine of [-1, 0, 0.9, 0.99, 1]) {
      expect(aureolePhase(phase, cosine, 0) / cloudPhase(phase, cosine)).toBeCloseTo(1, 2)
    }
  })

  it('is fainter in its middle the more cloud was crossed, and scatters no light away', () => {
    let previous = Infinity
    for (const depth of [0, 0.5, 1, 2, 4, 8]) {
      const middle = aureolePhase(phase, 1, depth)
      expect(middle).toBeLessThan(previous)
      previous = middle
      const whole = rule.nodes.reduce(
        (sum, x, i) => sum + 4 * Math.PI * rule.weights[i] * aureolePhase(phase, 2 * x - 1, depth),
        0
      )
      expect(whole).toBeCloseTo(1, 6)
    }
  })
})

const isolated = { depthToCamera: 0, layered: 0, cosLight: 1, cosView: 1, cosViewLight: 1 }

describe('lateral leak', () => {
  it('gives spheres the light that Monte Carlo gives them, for phase functions between those fitted', () => {
    for (const [diameter, chi1] of [
      [0.9, 0.1],
      [4, 0.4],
      [14, 0.25]
    ]) {
      const solver = new SlabSolver({ depthScale: 1, albedo: 0.99999, moments: [1, chi1, 0.15] })
      const { source: sources } = sphereLight(diameter, chi1, 0.15, diameter < 1 ? 400_000 : 60_000)
      let error = 0
      let total = 0
      for (let ring = 0; ring < RINGS; ring++) {
        const depthThrough = diameter * Math.sqrt(1 - (ring + 0.5) / RINGS)
        for (let step = 0; step < STEPS; step++) {
          const depthToLight = ((step + 0.5) / STEPS) * depthThrough
          const [{ s00 }] = solver.slab(depthThrough, [depthToLight]).fromBeam(1)
          const sample = { ...isolated, depthToLight, depthThrough, depthAcross: diameter }
          const source = sources[ring * STEPS + step]
          error += Math.abs(s00 * lateralLeak(sample, 1 - chi1) - source)
          total += source
        }
      }
      expect(error / total).toBeLessThan(0.12)
    }
  })

  it('is a sphere’s where all chords are as deep, and takes more where the cloud is open to other sides', () => {
    const sphere = { ...isolated, depthToLight: 2, depthThrough: 5, depthAcross: 7 }
    const leak = (view: [number, number], vertical: [number, number]): number =>
      lateralLeak({ ...sphere, viewChord: view, verticalChord: vertical }, 0.7)
    const whole = lateralLeak(sphere, 0.7)
    expect(leak([2, 3], [1.5, 4])).toBeCloseTo(whole, 12)
    // Rays end before they know of more.
    expect(leak([4, 9], [1.5, 4])).toBeGreaterThanOrEqual(whole)
    expect(leak([2, 0.1], [1.5, 4])).toBeLessThan(0.8 * whole)
    expect(leak([2, 3], [1.5, 0.1])).toBeLessThan(0.9 * whole)
    expect(leak([2, 3], [9, 4])).toBeGreaterThan(1.05 * whole)
  })

  it('takes more where a body shades another over a gap, the more the deeper they are, and less of shaded ends', () => {
    const bodies = (toLight: number, through: number, filled?: number): number =>
      lateralLeak(
        { ...isolated, depthToLight: toLight, depthThrough: through, depthAcross: 7, filled },
        0.7
      )
    const taken = (toLight: number, filled: number): number =>
      bodies(toLight, 8, filled) / bodies(toLight, 8, 1)
    // Two halves, with as much clear air between.
    expect(taken(4, 0.5)).toBeLessThan(0.85)
    expect(taken(4, 0.2)).toBeLessThan(taken(4, 0.5))
    expect(taken(7, 0.2)).toBeLessThan(taken(1, 0.2))
    expect(taken(4, 3)).toBe(1)
    const comesRound = (toLight: number): number => bodies(toLight, 8, 1) / bodies(toLight, 8)
    expect(comesRound(0.5)).toBeCloseTo(1, 3)
    expect(comesRound(8)).toBeGreaterThan(1.5)
  })
})

describe('flow', () => {
  it('is that of Monte-Carlo solutions of spheres, for phase functions between those fitted', () => {
    for (const [diameter, chi1, chi2] of [
      [0.9, 0.25, 0.15],
      [4, 0.4, 0.2],
      [14, 0.55, 0.25]
    ]) {
      const solver = new SlabSolver({ depthScale: 1, albedo: 0.99999, moments: [1, chi1, chi2] })
      const light = sphereLight(diameter, chi1, chi2, 150_000)
      const found = flowOver(light, solver, diameter, chi1, chi2)
      flowTerms(diameter, chi1, chi2).forEach((term, i) => {
        expect(Math.abs(found[i] - term)).toBeLessThan(0.2 * term + 0.01)
      })
    }
  })

  it('goes outwards: towards a camera that is nearer than the sphere’s middle, away from one beyond it', () => {
    const { moments } = scalePhase(phase)
    // Level with the middle, on a line at right angles to the light.
    const at = (front: number): number =>
      flow(
        {
          ...isolated,
          cosViewLight: 0,
          depthToLight: Math.sqrt(25 - (5 - front) ** 2),
          depthThrough: 2 * Math.sqrt(25 - (5 - front) ** 2),
          depthAcross: 10,
          viewChord: [front, 10 - front]
        },
        moments,
        0
      )
    expect(at(5) - at(9)).toBeCloseTo(at(1) - at(5), 9)
    expect(at(1)).toBeGreaterThan(at(5) + 0.1)
    expect(at(5)).toBeCloseTo(
      flow({ ...isolated, depthToLight: 5, depthThrough: 10, depthAcross: 10 }, moments, 0),
      9
    )
  })

  it('takes a chord for no longer than a sphere’s: beyond it another bulge begins', () => {
    const { moments } = scalePhase(phase)
    const place = { ...isolated, cosViewLight: 0, depthToLight: 2, depthThrough: 5, depthAcross: 7 }
    const along = (behind: number): number => flow({ ...place, viewChord: [1, behind] }, moments, 0)
    expect(along(40)).toBe(along(6))
    expect(along(3)).toBeLessThan(along(6))
  })
})

describe('cloudSource', () => {
  it('knows no leak and no width in layers', () => {
    const sample = {
      ...isolated,
      layered: 1,
      depthToLight: 1,
      depthThrough: 4,
      cosLight: 0.5,
      cosView: 0.3
    }
    const narrow = cloudSource(phase, table, { ...sample, cosViewLight: 0.2, depthAcross: 1 })
    const wide = cloudSource(phase, table, { ...sample, cosViewLight: 0.2, depthAcross: 1e3 })
    expect(narrow).toBe(wide)
  })

  it('is the same from below under a sun below the horizon as from above', () => {
    const sample = { ...isolated, layered: 1, depthToLight: 1, depthThrough: 4, depthAcross: 1 }
    const above = { ...sample, cosLight: 0.2, cosView: 0.5, cosViewLight: 0.3 }
    const below = { ...sample, cosLight: -0.2, cosView: -0.5, cosViewLight: 0.3 }
    expect(cloudSource(phase, table, below)).toBeCloseTo(cloudSource(phase, table, above), 12)
  })
})

describe('cloudAmbient', () => {
  it('hides a cloud between a sky and a ground of equal radiance', () => {
    fc.assert(
      fc.property(unit, unit, unit, unit, (above, below, layered, cosView) => {
        // The default droplets absorb: it shows in clouds thicker than these.
        const [depthAbove, depthBelow] = [15 * above, 15 * below]
        const { sky, ground } = cloudAmbient(table, { depthAbove, depthBelow, layered, cosView })
        expect(Math.abs(sky + ground - 1)).toBeLessThan(0.005)
      })
    )
  })

  it('lights tops more than bases from the sky, thick clouds from above more than from below', () => {
    const share = (depthAbove: number, depthBelow: number, cosView: number): number =>
      cloudAmbient(table, { depthAbove, depthBelow, layered: 0, cosView }).sky
    expect(share(0, 20, 0)).toBeGreaterThan(share(10, 10, 0) + 0.1)
    expect(share(10, 10, 0)).toBeGreaterThan(share(20, 0, 0) + 0.1)
    expect(share(10, 10, -1)).toBeGreaterThan(share(10, 10, 1) + 0.05)
    // A wisp scatters forwards.
    expect(share(0, 0, 1)).toBeGreaterThan(share(0, 0, -1) + 0.1)
  })

  it('has the upside-down cloud’s ground for a sky', () => {
    const sample = { depthAbove: 1, depthBelow: 4, layered: 0, cosView: 0.3 }
    const turned = { depthAbove: 4, depthBelow: 1, layered: 0, cosView: -0.3 }
    expect(cloudAmbient(table, turned).ground).toBeCloseTo(cloudAmbient(table, sample).sky, 12)
  })
})

describe('litGround', () => {
  const cloud = {
    depthThrough: 40,
    layered: 0,
    radius: 5000,
    altitude: 800,
    cosLight: 0.7,
    albedo: 0.1
  }
  const lit = (changes: Partial<typeof cloud>): number => litGround(phase, { ...cloud, ...changes })

  it('is dark below the base of a storm, less so farther up and under a low light, and hardly below a small cloud', () => {
    expect(lit({})).toBeLessThan(0.3)
    expect(lit({ altitude: 8000 })).toBeGreaterThan(lit({}) + 0.3)
    expect(lit({ cosLight: 0.1 })).toBeGreaterThan(lit({}) + 0.2)
    expect(lit({ radius: 400, altitude: 1200 })).toBeGreaterThan(0.9)
    expect(lit({ depthThrough: 5 })).toBeGreaterThan(lit({}) + 0.2)
    expect(lit({ depthThrough: 0 })).toBe(1)
  })

  it('is what comes through a deck, times the light that goes to and fro over snow', () => {
    const grey = lit({ layered: 1, depthThrough: 10 })
    expect(grey).toBeLessThan(0.3)
    expect(lit({ layered: 1, depthThrough: 10, altitude: 8000 })).toBeCloseTo(grey, 12)
    expect(lit({ layered: 1, depthThrough: 10, albedo: 0.8 })).toBeGreaterThan(2 * grey)
    expect(lit({ layered: 1, depthThrough: 10, albedo: 1 })).toBeGreaterThan(0.99)
  })
})
