import { CloudLayers, CloudNoise, precipitationShafts } from '@welkin/clouds'
import { float, int, vec4 } from 'three/tsl'
import { layerAt } from '../../../packages/clouds/src/density/tsl/layer'
import { loop, type Float, type Vec3 } from '../../../packages/clouds/src/tsl-types'
import { depthToSun } from '../../../packages/clouds/test/twins/cloudShafts'
import {
  castsOnce,
  lookAt,
  marchedLoss,
  measuredLoss,
  radians,
  raySize,
  unseenClouds
} from '../harness/cloud-shafts'
import { fog, SparseNoise } from '../harness/cloud-view'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest, takeFineShadows } from '../harness/gpu-test'
import { parameters, stage, stageSize as size } from '../harness/shaft-stage'

takeFineShadows()

/** Elevation of the sun [°]; a deck of waves of cloud, their length and mean extinction [m, 1/m]. */
const SUN = 35
const deck = { ...fog, baseAltitude: 1200, topAltitude: 1800 }
const WAVE = (2 * Math.PI) / 3000
const MEAN = 0.0015

gpuTest(
  'takes the light from air under waves of cloud as a float64 march through them',
  async t => {
    const renderer = await t.createRenderer(raySize)
    const set = stage(renderer, SUN, { quality: 'reference' })
    const { shafts } = set
    // Above the equator, x is up, y east and z north.
    const { node, draw, dispose } = await unseenClouds(
      renderer,
      set,
      new CloudLayers([deck]),
      new SparseNoise(),
      ({ offset }) => offset.z.mul(WAVE).sin().add(1).mul(MEAN)
    )
    shafts.add(castsOnce(node))
    const { bottomRadius: planetRadius } = parameters()
    const shading = {
      planetRadius,
      base: deck.baseAltitude,
      top: deck.topAltitude,
      extinction: (_up: number, _east: number, north: number) => MEAN * (1 + Math.sin(WAVE * north))
    }
    const errors: number[] = []
    for (const view of [12, 30, 75, 150]) {
      lookAt(set, view)
      for (let i = 0; i < 2; i++) await draw()
      const { value: scale } = node.field.depthScale
      const darkAt = (distance: number): number => {
        const [up, north] = [Math.sin(radians(view)), Math.cos(radians(view))]
        const depth = depthToSun(shading, 2 + up * distance, north * distance, radians(SUN))
        return 1 - Math.exp(-depth * scale)
      }
      const { whole, lost } = marchedLoss({ view, sun: SUN }, Infinity, darkAt)
      for (const [quality, goal] of [
        ['reference', 0.006],
        ['medium', 0.015]
      ] as const) {
        shafts.set({ quality })
        const got = await measuredLoss(set)
        for (let k = 0; k < 3; k++) {
          errors.push((got[k] - lost[k]) / whole[k])
          expectClose(
            got[k],
            lost[k],
            { absolute: goal * whole[k] },
            `${quality}, view ${view}°, #${k}`
          )
        }
        const [part, found] = [lost[1] / whole[1], got[1] / whole[1]]
        t.note(`${view}°, ${quality}: lost ${part.toFixed(4)}, got ${found.toFixed(4)}`)
      }
      expectTrue(lost[1] > 0.02 * whole[1], `view ${view}°: the deck casts a shadow`)
    }
    dispose()
    set.dispose()
  },
  { backends: ['webgpu'] }
)

/** Steps of the march through rain, places on a view ray and how far it goes [m]. */
const STEPS = 48
const PLACES = 32
const REACH = 9000

gpuTest(
  "takes the light from air in rain's shade as a dense march through the rain does",
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, SUN, { quality: 'reference' })
    const { shafts } = set
    const [base, top] = [1500, 1800]
    // Clouds that are next to nothing, from which it rains everywhere.
    const precipitation = { rate: 4, share: 1, freezingLevel: 9000 }
    const layers = new CloudLayers([
      { ...fog, baseAltitude: base, topAltitude: top, density: 1e-7, precipitation }
    ])
    const medium = precipitationShafts()
    const noise = new CloudNoise()
    const { node, draw, dispose } = await unseenClouds(
      renderer,
      set,
      layers,
      noise,
      undefined,
      medium
    )
    await node.bake(renderer)
    shafts.add(castsOnce(node))
    for (let i = 0; i < 3; i++) await draw()
    const { field } = node
    const views = [12, 40, 150]
    const distances = Array.from({ length: PLACES }, (_, i) => REACH * ((i + 0.5) / PLACES) ** 2)
    const inputs = views.flatMap(view =>
      distances.map(distance => {
        const [up, north] = [Math.sin(radians(view)), Math.cos(radians(view))]
        return [up * distance, 0, north * distance, 0]
      })
    )
    const depths = await evaluateOnGpu(renderer, inputs, input => {
      const depth = float(0).toVar()
      const length = (top + 50) / Math.sin(radians(SUN)) / STEPS
      loop('step', STEPS, index => {
        const along = float(index).add(0.5).mul(length) as Float
        const offset = (input.xyz as Vec3).add(field.view.lightDirection.mul(along)).toConst()
        const place = { offset: offset as Vec3, ...field.view.localCoordinates(offset) }
        const sample = { ...place, distance: float(3000).toConst() as Float }
        depth.addAssign(medium.extinctionAt(field, layerAt(field, int(0)), sample).mul(length))
      })
      return vec4(depth, 0, 0, 0)
    })
    const errors: number[] = []
    for (const [index, view] of views.entries()) {
      lookAt(set, view)
      await draw()
      const darkAt = (distance: number): number => {
        if (distance > REACH) return 0
        const i = Math.floor(Math.sqrt(distance / REACH) * PLACES)
        return 1 - Math.exp(-depths[4 * (index * PLACES + i)])
      }
      const { whole, lost } = marchedLoss({ view, sun: SUN }, Infinity, darkAt)
      const got = await measuredLoss(set)
      for (let k = 0; k < 3; k++) errors.push((got[k] - lost[k]) / whole[k])
      const [part, found] = [lost[1] / whole[1], got[1] / whole[1]]
      t.note(`${view}°: lost ${part.toFixed(4)}, got ${found.toFixed(4)}`)
      expectTrue(part > 0.01, `view ${view}°: rain casts a shadow`)
    }
    const worst = Math.max(...errors.map(Math.abs))
    expectTrue(worst < 0.01, `lost light is off by ${worst}`)
    dispose()
    set.dispose()
  },
  // The shadow maps' look-up is that of a slit in a deck (`clouds/shafts`), which WebGL draws, too.
  { backends: ['webgpu'] }
)
