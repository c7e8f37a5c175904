import { horizontalIrradiance } from '@welkin/atmosphere'
import {
  cloudAirShadow,
  cloudPreset,
  CloudLayers,
  CloudLightTable,
  CloudNoise,
  clouds
} from '@welkin/clouds'
import { float, vec4 } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { meanDecks } from '../../../packages/clouds/src/environment/tsl/decks'
import {
  diffuseRatio,
  overcastIrradiance
} from '../../../packages/clouds/src/environment/tsl/overcast'
import { loop, type Float, type Vec3, type Vec4 } from '../../../packages/clouds/src/tsl-types'
import { cloudExtinction } from '../harness/cloud-extinction'
import {
  castsOnce,
  lookAt,
  marchedLoss,
  measuredLoss,
  radians,
  raySize,
  unseenClouds,
  type North
} from '../harness/cloud-shafts'
import { drawForward, drawToFloat } from '../harness/atmosphere'
import { coarse, fog, SparseNoise } from '../harness/cloud-view'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { setShadowSize } from '../harness/shadow-size'
import { expectSame, stage, stageSize as size } from '../harness/shaft-stage'

const deck = { ...fog, baseAltitude: 1500, topAltitude: 1600 }

/** Decks of a given extinction [1/m] that is a function of the distance north of the eye, and the clear part there. */
const decks: [string, (north: Float) => Float, (north: number) => boolean][] = [
  ['a half plane', north => north.greaterThan(1200).select(0.5, 0), north => north <= 1200],
  [
    'a slit in a deck',
    north => north.sub(2600).abs().greaterThan(400).select(0.5, 0),
    north => Math.abs(north - 2600) <= 400
  ]
]

/** Dark part of the air at distances on a ray that begins at an altitude [m], under a deck with clear parts. */
const darkUnder =
  (isClear: (north: number) => boolean, { view, sun }: North, start: number) =>
  (distance: number): number => {
    const altitude = start + distance * Math.sin(radians(view)) + distance ** 2 / 12.8e6
    if (altitude > deck.topAltitude) return 0
    const from = Math.max(altitude, deck.baseAltitude)
    const at = (height: number): number =>
      distance * Math.cos(radians(view)) + (height - altitude) / Math.tan(radians(sun))
    return isClear(at(from)) && isClear(at(deck.topAltitude)) ? 0 : 1
  }

for (const [name, extinction, isClear] of decks) {
  gpuTest(
    `takes the light from air under ${name}`,
    async t => {
      setShadowSize('fine')
      const renderer = await t.createRenderer(raySize)
      const sun = 40
      const set = stage(renderer, sun, { quality: 'reference' })
      const { shafts } = set
      const { node, draw, dispose } = await unseenClouds(
        renderer,
        set,
        new CloudLayers([deck]),
        new SparseNoise(),
        // Above the equator, x is up and z is north.
        ({ offset }) => extinction(offset.z)
      )
      const occluder = castsOnce(node)
      shafts.add(occluder)
      for (const view of [10, 25, 60, 150]) {
        lookAt(set, view)
        await draw()
        const north = { view, sun }
        const { whole, lost } = marchedLoss(north, Infinity, darkUnder(isClear, north, 2))
        const got = await measuredLoss(set)
        for (let k = 0; k < 3; k++) {
          t.note(
            `${name}, ${view}°: lost ${(lost[k] / whole[k]).toFixed(4)}, got ${(got[k] / whole[k]).toFixed(4)}`
          )
          expectClose(
            got[k],
            lost[k],
            { absolute: 0.012 * whole[k] },
            `${name}, view ${view}°, #${k}`
          )
        }
      }
      dispose()
      set.dispose()
    },
    // The same passes: WebGL reads them as the last one does.
    { backends: name.startsWith('a slit') ? ['webgpu', 'webgl'] : ['webgpu'] }
  )
}

gpuTest(
  'takes no light under layers that cast no shadow, beside what casts one',
  async t => {
    const renderer = await t.createRenderer(raySize)
    const set = stage(renderer, 40, { quality: 'medium' })
    const { node, draw, dispose } = await unseenClouds(
      renderer,
      set,
      new CloudLayers([{ ...deck, shadow: false }]),
      new SparseNoise(),
      () => float(0.5)
    )
    // It might take light, and takes none.
    set.shafts.add(cloudAirShadow(node), {
      castInto: () => ({ transmittance: () => () => float(1) })
    })
    lookAt(set, 25)
    for (let i = 0; i < 2; i++) await draw()
    for (const lost of await measuredLoss(set))
      expectClose(lost, 0, { absolute: 1e-6 }, 'lost light')
    dispose()
    set.dispose()
  },
  { backends: ['webgpu'] }
)

/** Middle and half width of a gap in a deck, north of the eye [m]. */
const gap = { middle: 300, half: 400 }

/**
 * Altitudes of eyes above that gap or in it [m], and views of the air below. Long ones: shadows of a deck this thick are wider than it by up to a
 * texel of the clouds' map, 39 m.
 */
const eyes = [
  { altitude: 1550, views: [-15, -165] },
  { altitude: 10_000, views: [-84, -95] }
]

gpuTest(
  'takes the light from air under a deck as seen from among its clouds and from 10 km',
  async t => {
    setShadowSize('fine')
    const sun = 40
    const renderer = await t.createRenderer(raySize)
    const set = stage(renderer, sun, { quality: 'reference' })
    const { node, draw, dispose } = await unseenClouds(
      renderer,
      set,
      new CloudLayers([deck]),
      new SparseNoise(),
      ({ offset }) => offset.z.sub(gap.middle).abs().greaterThan(gap.half).select(0.5, 0)
    )
    set.shafts.add(castsOnce(node))
    const isClear = (north: number): boolean => Math.abs(north - gap.middle) <= gap.half
    for (const { altitude, views } of eyes) {
      set.camera.position.y = altitude
      const parts: number[] = []
      for (const view of views) {
        lookAt(set, view)
        await draw()
        const north = { view, sun }
        const ground = altitude / Math.sin(radians(-view))
        const darkAt = darkUnder(isClear, north, altitude)
        const { whole, lost } = marchedLoss(north, ground, darkAt, altitude)
        const got = await measuredLoss(set)
        parts.push(lost[1] / whole[1])
        t.note(
          `${altitude} m, ${view}°: lost ${parts.at(-1)!.toFixed(4)}, got ${(got[1] / whole[1]).toFixed(4)}`
        )
        for (let k = 0; k < 3; k++) {
          expectClose(got[k], lost[k], { absolute: 0.012 * whole[k] }, `view ${view}°, #${k}`)
        }
      }
      expectTrue(Math.abs(parts[0] - parts[1]) > 0.03, `${altitude} m: ${parts.join()} is lost`)
    }
    dispose()
    set.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'takes the light from air under broken clouds as a dense march through them does',
  async t => {
    const renderer = await t.createRenderer(size)
    const sun = 25
    const set = stage(renderer, sun)
    const { shafts } = set
    const layers = cloudPreset('fairWeather')
    layers.at(0).set({ coverage: 0.5 })
    const { node, draw, dispose } = await unseenClouds(renderer, set, layers, new CloudNoise())
    const occluder = castsOnce(node)
    shafts.add(occluder)
    await draw()
    const { field, light } = node
    const steps = 64
    const places = 48
    const end = 14_000
    const views = [10, 15, 35, 150]
    const distances = Array.from({ length: places }, (_, i) => end * ((i + 0.5) / places) ** 2)
    const inputs = views.flatMap(view =>
      distances.map(distance => {
        const [up, north] = [Math.sin(radians(view)), Math.cos(radians(view))]
        return [up * distance, 0, north * distance, 0]
      })
    )
    const depths = await evaluateOnGpu(renderer, inputs, input => {
      const depth = float(0).toVar()
      const start = input.xyz.toConst() as Vec3
      const length = 6000 / steps
      loop('step', steps, index => {
        const offset = start
          .add(field.view.lightDirection.mul(float(index).add(0.5).mul(length)))
          .toConst() as Vec3
        const sample = {
          offset,
          ...field.view.localCoordinates(offset),
          distance: float(3000).toConst()
        }
        depth.addAssign(cloudExtinction(field, sample, false).mul(length))
      })
      return depth.mul(light.nodes.depthScale)
    })
    const [errors, high]: [number[], number[]] = [[], []]
    for (const [index, view] of views.entries()) {
      lookAt(set, view)
      await draw()
      const darkAt = (distance: number): number => {
        // There the ray is above all clouds.
        if (distance > end) return 0
        const i = Math.floor(Math.sqrt(distance / end) * places)
        return 1 - Math.exp(-depths[4 * (index * places + i)])
      }
      const { whole, lost } = marchedLoss({ view, sun }, Infinity, darkAt)
      for (const quality of ['reference', 'high'] as const) {
        shafts.set({ quality })
        const got = await measuredLoss(set)
        const all = quality === 'reference' ? errors : high
        for (let k = 0; k < 3; k++) all.push((got[k] - lost[k]) / whole[k])
      }
      t.note(
        `${view}°: ${(lost[1] / whole[1]).toFixed(3)} is lost, apart ${errors.at(-2)!.toFixed(3)}, high ${high.at(-2)!.toFixed(3)}`
      )
    }
    const mean = (all: readonly number[]): number =>
      all.reduce((sum, value) => sum + Math.abs(value), 0) / all.length
    t.note(`mean ${mean(errors).toFixed(4)}, high ${mean(high).toFixed(4)}`)
    expectTrue(mean(errors) < 0.05, `lost light is off by ${mean(errors)}`)
    dispose()
    set.dispose()
  },
  // The look-up is that of the decks above, which WebGL runs, too.
  { backends: ['webgpu'] }
)

gpuTest(
  'has shafts in front of clouds, by which a closed deck is darker, and none after they are taken out',
  async t => {
    const renderer = await t.createRenderer({ width: size.width / 2, height: size.height / 2 })
    const [sun, view] = [40, 4]
    const set = stage(renderer, sun, { quality: 'reference' })
    const { shafts, camera, air, depth, atmosphere } = set
    const [light, noise] = [new CloudLightTable(), new SparseNoise()]
    const layers = new CloudLayers([deck])
    const node = clouds(air, depth, camera, atmosphere, layers, {
      quality: coarse,
      noise,
      light,
      extinction: () => float(0.5)
    })
    node.time = 0
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = node
    lookAt(set, view)
    const draw = async (frames = 4): Promise<Picture> => {
      camera.updateMatrixWorld()
      for (let i = 1; i < frames; i++) {
        await nextFrame()
        pipeline.render()
      }
      await nextFrame()
      return drawToFloat(renderer, () => pipeline.render())
    }
    const mean = ({ data }: Picture): number[] =>
      [0, 1, 2].map(
        k => data.reduce((sum, value, i) => sum + (i % 4 === k ? value : 0), 0) / (data.length / 4)
      )
    const plain = mean(await draw(12))
    const occluder = castsOnce(node)
    shafts.add(occluder)
    pipeline.needsUpdate = true
    const pictures: number[][] = []
    for (const enabled of [true, false, true]) {
      shafts.enabled = enabled
      pictures.push(mean(await draw(1)))
    }
    const [shadowed, lit, after] = pictures
    const base = deck.baseAltitude / Math.sin(radians(view))
    const { whole } = marchedLoss({ view, sun }, base, () => 1)
    for (let k = 0; k < 3; k++) {
      // History goes on to converge meanwhile.
      const lost = (lit[k] - (shadowed[k] + after[k]) / 2) / whole[k]
      t.note(`${lost.toFixed(3)} of the light before the deck is lost`)
      // The deck is seen a little inside of its base.
      expectClose(lost, 1, { absolute: 0.05 }, `lost light, #${k}`)
    }
    shafts.remove(occluder)
    pipeline.needsUpdate = true
    const again = mean(await draw(2))
    for (let k = 0; k < 3; k++) expectClose(again[k], plain[k], { relative: 0.02 }, 'lit again')
    for (const owned of [node, pipeline, light, noise, set]) owned.dispose()
  },
  // A slit in a deck is drawn on both backends.
  { backends: ['webgpu'] }
)

gpuTest(
  'is the same to the last bit under a clear sky, and draws clouds in materials as in the post effect',
  async t => {
    // Room for what materials read is as wide as the maps.
    setShadowSize('fine')
    const renderer = await t.createRenderer(size)
    const plain = stage(renderer, 20, null)
    const clear = await plain.draw()
    const set = stage(renderer, 20, { quality: 'reference' })
    const { shafts, scene, camera, atmosphere } = set
    const layers = new CloudLayers([{ ...deck, coverage: 0 }])
    const { node, draw, dispose } = await unseenClouds(
      renderer,
      set,
      layers,
      new SparseNoise(),
      // Stripes, one of them overhead.
      ({ offset }) =>
        offset.y
          .mul(Math.PI / 8000)
          .cos()
          .greaterThan(0)
          .select(0.5, 0)
    )
    const occluder = castsOnce(node)
    shafts.add(occluder)
    await draw()
    expectSame(await set.draw(), clear, 'no clouds')
    layers.at(0).set({ coverage: 1 })
    // Three cascades, in four strips each.
    for (let i = 0; i < 14; i++) await draw()
    const post = await set.draw()
    shafts.enabled = false
    const lit = await set.draw()
    shafts.enabled = true
    atmosphere.add(shafts)
    await nextFrame()
    const forward = await drawForward(renderer, scene, camera, atmosphere)
    const apart = (a: Picture, b: Picture): number =>
      a.data.reduce((sum, value, i) => sum + Math.abs(value - b.data[i]), 0)
    const [errors, shadows] = [apart(forward, post), apart(post, lit)]
    const all = lit.data.reduce((sum, value, i) => sum + (i % 4 < 3 ? value : 0), 0)
    t.note(
      `${(errors / shadows).toFixed(3)} of the lost light apart, of ${(shadows / all).toFixed(3)}`
    )
    expectTrue(shadows > 0.01 * all, 'clouds cast shadows')
    expectTrue(errors < 0.15 * shadows, 'forward')
    // Beside the clouds' shadows materials read what they read in a texture of its own.
    shafts.remove(occluder).quality = 'medium'
    const read: Picture[] = []
    for (const hasRoom of [false, true]) {
      const caster = castsOnce(node, hasRoom)
      shafts.add(caster)
      await draw()
      const { height } = node.shadows.target
      expectTrue(height > 256 === hasRoom, `the clouds' shadows have ${height} rows`)
      for (let i = 0; i < 2; i++) {
        await nextFrame()
        read[Number(hasRoom)] = await drawForward(renderer, scene, camera, atmosphere)
      }
      shafts.remove(caster)
    }
    const [own, beside] = read
    t.note(
      `beside the clouds' shadows ${apart(beside, own) / apart(own, lit)} of the lost light apart`
    )
    expectTrue(apart(own, lit) > 0.5 * shadows, 'clouds cast shadows at medium quality')
    expectTrue(apart(beside, own) < 1e-3 * shadows, "beside the clouds' shadows")
    for (const owned of [plain, set]) owned.dispose()
    dispose()
  },
  // A slit in a deck has shafts on both.
  { backends: ['webgpu'] }
)

gpuTest(
  'dims light scattered more than once as it dims that on surfaces',
  async t => {
    const renderer = await t.createRenderer(raySize)
    const set = stage(renderer, 40, { quality: 'reference' })
    const { node, draw, dispose } = await unseenClouds(
      renderer,
      set,
      new CloudLayers([{ ...fog, density: 0.02 }]),
      new SparseNoise()
    )
    await draw()
    const { field, light } = node
    const { view } = field
    const heights = [0, 200, 1000, 1800, 3000, 9000, 20_000]
    const found = await evaluateOnGpu(
      renderer,
      heights.map(height => [height, 0, 0, 0]),
      ({ x }) => {
        // The camera is 2 m above the ground.
        const offset = view.up.mul(x).toConst()
        const place = { offset, ...view.localCoordinates(offset) }
        const { altitude, cosLight } = place
        const { uniforms, diffuse } = view.air
        const clear = horizontalIrradiance(uniforms, diffuse!, altitude, cosLight)
        const facing = (plane: Vec4, cosNormal: number): Vec4 => {
          const lit = { view, ...place, cosNormal: float(cosNormal) }
          return overcastIrradiance(field, light.nodes, lit, offset, plane)
        }
        const [up, down] = [clear.up.toConst() as Vec4, clear.down.toConst() as Vec4]
        const cloudy = facing(up, 1).add(facing(down, -1))
        const decks = meanDecks(field, light.nodes, altitude, cosLight)
        const ratio = diffuseRatio(view, decks, altitude, cosLight)
        return vec4(ratio.y, cloudy.div(up.add(down)).y, ratio.x, ratio.w)
      }
    )
    heights.forEach((height, i) => {
      const [ratio, expected, red, infrared] = found.subarray(4 * i, 4 * i + 4)
      t.note(`\n${height} m: ${[red, ratio, infrared].map(value => value.toFixed(3)).join(', ')}`)
      expectClose(ratio, expected, { relative: 2e-3 }, `${height} m`)
    })
    dispose()
    set.dispose()
  },
  { backends: ['webgpu'] }
)
