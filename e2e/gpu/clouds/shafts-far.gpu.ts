import { CloudLayers } from '@welkin/clouds'
import { float, step, vec3, vec4 } from 'three/tsl'
import { inScatter } from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import { QualityUniforms } from '../../../packages/clouds/src/march/quality'
import { litClouds } from '../../../packages/clouds/src/march/tsl/shadePoints'
import type { Float, Vec3 } from '../../../packages/clouds/src/tsl-types'
import {
  castsOnce,
  lookAt,
  marchedLoss,
  measuredLoss,
  radians as inRadians,
  raySize,
  unseenClouds
} from '../harness/cloud-shafts'
import { coarse, fog, SparseNoise } from '../harness/cloud-view'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { setShadowSize } from '../harness/shadow-size'
import { parameters, stage } from '../harness/shaft-stage'

const radians = Math.PI / 180

/**
 * A block of cloud [1/m] between two corners [m]. Above the equator, x is up, y east and z north. Without branches, which the march that it
 * becomes a part of would take long to compile.
 */
function block(place: Vec3, low: [number, number, number], high: [number, number, number]): Float {
  const within = step(vec3(...low), place)
    .mul(step(place, vec3(...high)))
    .toConst()
  return within.x.mul(within.y).mul(within.z).mul(0.05)
}

gpuTest(
  'has a tower of cloud shade the cloud behind it, and not one without a tower',
  async t => {
    const renderer = await t.createRenderer(raySize)
    const sun = 25
    const set = stage(renderer, sun, null)
    // Two clouds beside the camera, alike from it, and a tower north of the one in the east, where the sun is.
    const middle = 2000
    const { node, draw, dispose } = await unseenClouds(
      renderer,
      set,
      new CloudLayers([{ ...fog, baseAltitude: 400, topAltitude: 2400 }]),
      new SparseNoise(),
      ({ offset }) => {
        const { x, y, z } = offset
        const corner = middle - 300
        const both = block(vec3(x, y.abs(), z), [400, corner, -300], [800, corner + 600, 300])
        return both.add(block(offset, [400, middle - 700, 1400], [2400, middle + 700, 2600]))
      }
    )
    for (let i = 0; i < 2; i++) await draw()
    const { field, light, shadows } = node
    const quality = new QualityUniforms()
    quality.set(coarse)
    const found = await evaluateOnGpu(
      renderer,
      [-1, 1].map(side => [side, 0, 0, 0]),
      ({ x: side }) => {
        const { up, lightDirection } = field.view
        const east = lightDirection.cross(up).normalize().mul(side)
        const place = up.mul(600).add(east.mul(middle)).toConst() as Vec3
        const ray = { direction: place.normalize().toConst() as Vec3, end: float(3500) }
        const context = { field, light: light.nodes, shadows: shadows.nodes, quality }
        const { radiance, transmittance } = litClouds(context, { ...ray, jitter: float(0.5) })
        return vec4(radiance.y, transmittance, 0, 0)
      }
    )
    const [lit, litThrough, shaded, shadedThrough] = [0, 1, 4, 5].map(i => found[i])
    t.note(`behind the tower ${(shaded / lit).toFixed(3)} of the light`)
    expectTrue(Math.max(litThrough, shadedThrough) < 0.05, 'both clouds are seen')
    // What is left is light of sky and ground.
    expectTrue(shaded > 0.05 * lit && shaded < 0.6 * lit, `${shaded} of ${lit}`)
    dispose()
    set.dispose()
  },
  { backends: ['webgpu'] }
)

/** A storm, whose edges are 40 km long, by the elevation of the sun below 400 km [°], and its middle north and east of there [m]. */
interface Storm {
  sun: number
  north: number
  east: number
}

/** Base and top of the storm, and half an edge [m]. */
const [BASE, TOP, HALF] = [1000, 12_000, 20_000]

/** Cover of storms: there is one. */
const SELDOM = 0.001

/** Steps of a ray of light in float64, and pieces of the view ray. */
const [RAY_STEPS, PIECES] = [400, 80]

/** True if the storm stands between the sun and the air at an altitude straight below the camera. */
function isShaded(altitude: number, { sun, north, east }: Storm): boolean {
  const { bottomRadius } = parameters()
  const [up, along] = [Math.sin(sun * radians), Math.cos(sun * radians)]
  if (Math.abs(east) > HALF) return false
  return Array.from({ length: RAY_STEPS }, (_, i) => {
    const level = north - HALF + 2 * HALF * ((i + 0.5) / RAY_STEPS)
    const distance = level / along
    const height = Math.hypot(bottomRadius + altitude + distance * up, level) - bottomRadius
    return height > BASE && height < TOP
  }).some(Boolean)
}

/** Light scattered once on the way from the top of the air down to the ground, and what the storm takes of it. */
function stormLoss(storm: Storm): { whole: number[]; lost: number[] } {
  const air = parameters()
  const thickness = air.topRadius - air.bottomRadius
  const up = Math.sin(storm.sun * radians)
  const ray = { radius: air.topRadius, cosView: -1, cosLight: up, cosViewLight: -up }
  const lost = [0, 0, 0]
  let before = [0, 0, 0, 0]
  for (let i = 1; i <= PIECES; i++) {
    // Even near the ground, where the light is.
    const altitudeAt = (part: number): number => thickness * (1 - part) ** 2
    const sum = inScatter(air, null, ray, thickness - altitudeAt(i / PIECES))
    if (isShaded(altitudeAt((i - 0.5) / PIECES), storm))
      lost.forEach((_, k) => (lost[k] += sum[k] - before[k]))
    before = sum
  }
  return { whole: before, lost }
}

for (const [label, storm, least] of [
  ["takes the light from the air in a storm's shadow", { sun: 5, north: 60_000, east: 0 }, 0.2],
  ["takes it in a storm's shadow cone 150 km long", { sun: -1, north: 150_000, east: 0 }, 0.04],
  ['takes none beside the cone', { sun: -1, north: 150_000, east: 40_000 }, 0]
] as const) {
  gpuTest(
    `${label}, as seen from 400 km at dusk`,
    async t => {
      setShadowSize('fine')
      const renderer = await t.createRenderer(raySize)
      const { sun, north, east } = storm
      const set = stage(renderer, sun, { quality: 'reference' })
      const { camera, shafts } = set
      camera.position.y = 400_000
      camera.fov = 0.2
      camera.near = 1000
      camera.updateProjectionMatrix()
      camera.up.set(0, 0, -1)
      camera.lookAt(0, 0, 0)
      const { node, draw, dispose } = await unseenClouds(
        renderer,
        set,
        new CloudLayers([{ ...fog, baseAltitude: BASE, topAltitude: TOP, coverage: SELDOM }]),
        new SparseNoise(),
        ({ offset: { y, z } }) => {
          const outside = y.sub(east).abs().max(z.sub(north).abs()).greaterThan(HALF)
          return outside.select(0, 0.02)
        }
      )
      shafts.add(castsOnce(node))
      for (let i = 0; i < 2; i++) await draw()
      const { whole, lost } = stormLoss(storm)
      const got = await measuredLoss(set)
      for (let k = 0; k < 3; k++) {
        const part = lost[k] / whole[k]
        t.note(`lost ${part.toFixed(3)}, got ${(got[k] / whole[k]).toFixed(3)}`)
        expectTrue(part >= least, `${part} is lost`)
        expectClose(got[k], lost[k], { absolute: 0.015 * whole[k] }, `#${k}`)
      }
      dispose()
      set.dispose()
    },
    // The numbers of one place are the same on both, and so are those of others.
    { backends: storm.sun > 0 ? ['webgpu', 'webgl'] : ['webgpu'] }
  )
}

/** Sun after its setting [°], and tops of decks that are closed as far as the eye sees [m]. */
const DUSK = -3
const DECK_TOPS = [1600, 6000]

/** True if light of the sun passes the deck on its way to a place on a ray to the north, where the sun has set. */
function isBehindDeck(top: number, distance: number, view: number): boolean {
  const { bottomRadius } = parameters()
  const [up, north] = [Math.sin(inRadians(view)) * distance, Math.cos(inRadians(view)) * distance]
  const [rise, run] = [Math.sin(inRadians(DUSK)), Math.cos(inRadians(DUSK))]
  const radial = (bottomRadius + up) * rise + north * run
  const radius = Math.hypot(bottomRadius + up, north)
  // Light from below the horizon has passed its lowest place.
  const lowest = radial < 0 ? Math.sqrt(radius ** 2 - radial ** 2) : radius
  return lowest < bottomRadius + top
}

gpuTest(
  'leaves the light that has passed over a closed deck, after sunset',
  async t => {
    const renderer = await t.createRenderer(raySize)
    for (const top of DECK_TOPS) {
      const set = stage(renderer, DUSK, { quality: 'reference' })
      const { shafts } = set
      const layer = { ...fog, baseAltitude: top - 100, topAltitude: top, density: 0.5 }
      const { node, draw, dispose } = await unseenClouds(
        renderer,
        set,
        new CloudLayers([layer]),
        new SparseNoise(),
        () => float(0.5)
      )
      shafts.add(castsOnce(node))
      for (const view of [8, 150]) {
        lookAt(set, view)
        for (let i = 0; i < 2; i++) await draw()
        const darkAt = (distance: number): number => Number(isBehindDeck(top, distance, view))
        const { whole, lost } = marchedLoss({ view, sun: DUSK }, Infinity, darkAt)
        for (const quality of ['reference', 'medium'] as const) {
          shafts.set({ quality })
          const got = await measuredLoss(set)
          const parts = (light: number[]): string =>
            got.map((_, k) => (light[k] / whole[k]).toFixed(3)).join(' ')
          t.note(`${top} m, ${view}°, ${quality}: lost ${parts(lost)}, got ${parts(got)}`)
          for (let k = 0; k < 3; k++)
            expectClose(
              got[k],
              lost[k],
              { absolute: 0.015 * whole[k] },
              `${view}°, ${quality}, #${k}`
            )
        }
      }
      dispose()
      set.dispose()
    }
  },
  { backends: ['webgpu'] }
)
