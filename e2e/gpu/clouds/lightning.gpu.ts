import { CloudLayers, lightning } from '@welkin/clouds'
import { BoxGeometry, Mesh, MeshBasicMaterial, Vector3 } from 'three'
import { float, vec3, vec4 } from 'three/tsl'
import { meanInverseSquareOf } from '../../../packages/clouds/test/twins/lightning'
import {
  CHANNEL_COLOR,
  lightningChannel,
  type Point
} from '../../../packages/clouds/src/lightning/channel'
import { flashCurve, lightBetween } from '../../../packages/clouds/src/lightning/flashCurve'
import { OPEN, REACH, StormDensity } from '../../../packages/clouds/src/lightning/StormDensity'
import { LEAST_TRANSMITTANCE } from '../../../packages/clouds/src/light/tsl/lighting'
import { POINTS } from '../../../packages/clouds/src/march/tsl/seenPoints'
import { seeded } from '../../../packages/clouds/src/lightning/random'
import { meanInverseSquare } from '../../../packages/clouds/src/lightning/tsl/lineLight'
import { random } from '../harness/atmosphere'
import { coarse, CloudView, fog, inFog, middle } from '../harness/cloud-view'
import { cloudExtinction } from '../harness/cloud-extinction'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

gpuTest('light of a line is that of float64, near and far, along and aside', async t => {
  const renderer = await t.createRenderer()
  const draw = random(3)
  const inputs = Array.from({ length: 200 }, () => {
    const reach = 10 ** (2 + 2.5 * draw())
    return [...[1, 1, 1].map(() => Math.fround(reach * (2 * draw() - 1))), 10 ** (1 + 1.5 * draw())]
  })
  const way: Point = [310, -2400, 1250]
  const results = await evaluateOnGpu(renderer, inputs, input =>
    meanInverseSquare(input.xyz, input.xyz.add(vec3(...way)), input.w)
  )
  inputs.forEach(([x, y, z, softness], i) => {
    const end: Point = [x + way[0], y + way[1], z + way[2]]
    const expected = meanInverseSquareOf([x, y, z], end, softness)
    expectClose([results[4 * i]], [expected], { relative: 2e-3 }, `line ${i}`)
  })
})

/** Frames in which where the camera is and what it sees is the same for all, and in which history settles. */
const FRAMES = 8
const EXPOSURE = 0.5
const SEED = 9

/** Steps of the fog's height over which its density is summed up. */
const HEIGHTS = 400

/** Scaled depths of clouds from a base up to even heights, by default of the fog, north of the camera [m]: that of its ends is less. */
async function depthsUpwards(
  { renderer, node }: CloudView,
  north: number,
  [base, top] = [fog.baseAltitude!, fog.topAltitude!]
): Promise<number[]> {
  const { field } = node
  const thickness = top - base
  const altitudes = Array.from(
    { length: HEIGHTS },
    (_, i) => base + (thickness * (i + 0.5)) / HEIGHTS
  )
  const found = await evaluateOnGpu(
    renderer,
    altitudes.map(altitude => [altitude]),
    ({ x: altitude }) => {
      const { up, height } = field.view
      const northward = vec3(0, 0, 1).sub(up.mul(up.z)).normalize()
      const offset = up.mul(altitude.sub(height)).add(northward.mul(north)).toConst()
      return cloudExtinction(field, { offset, altitude, up, distance: float(3000) }, false)
    }
  )
  let sum = 0
  const scale = (field.depthScale.value * thickness) / HEIGHTS
  return [0, ...altitudes.map((_, i) => (sum += found[4 * i] * scale))]
}

/** Harmonic mean of the scaled depths out of the fog and `OPEN`, over 20,000 directions. */
function meanWayOut(height: number, depths: readonly number[]): number {
  const thickness = fog.topAltitude! - fog.baseAltitude!
  const depthAt = (up: number): number => {
    const at = Math.min(Math.max((up - fog.baseAltitude!) / thickness, 0), 1) * HEIGHTS
    const first = Math.min(Math.floor(at), HEIGHTS - 1)
    return depths[first] + (at - first) * (depths[first + 1] - depths[first])
  }
  let sum = 0
  for (let i = 0; i < 20_000; i++) {
    const z = -1 + (2 * (i + 0.5)) / 20_000
    const depth = Math.abs(depthAt(height + z * REACH) - depthAt(height)) / Math.abs(z)
    sum += 1 / (depth + OPEN)
  }
  return 20_000 / sum
}

gpuTest('fog glows about a flash as in float64, and not before or after it', t =>
  inFog(t, async view => {
    const { node, atmosphere, camera, scene } = view
    node.quality = { ...coarse, block: 1 }
    // At night: half floats beside daylight would round a glow away.
    atmosphere.setSunAngles(-30, 150)
    const before = await view.draw(FRAMES)
    const storm = lightning(node, { limit: null, exposure: EXPOSURE, time: 0, seed: SEED })
    view.show(node)
    let struck = 0
    storm.addEventListener('strike', () => {
      struck++
      storm.time = EXPOSURE
    })
    expectClose([middle(await view.draw(FRAMES))], [middle(before)], { relative: 0.01 }, 'before')
    const at = new Vector3(0, 0, -3000)
    storm.strike({ kind: 'cloud', at })
    const lit = await view.draw(FRAMES)
    expectTrue(struck === 1 && storm.isFlashing, 'it flashes')

    const numbers = seeded(SEED)
    const { stem } = lightningChannel(
      'cloud',
      { base: fog.baseAltitude!, top: fog.topAltitude! },
      numbers
    )
    const light = lightBetween(flashCurve('cloud', numbers), 0, EXPOSURE).all
    const power = (light / EXPOSURE) * atmosphere.luminanceScale
    // Mean places of the strata that stand for a ray in uniform fog, which is opaque from `LEAST_TRANSMITTANCE` on. East is +x, north −z, up +y there.
    const depths = await depthsUpwards(view, -at.z)
    const meanOut = meanWayOut(stem[2][2], depths)
    // Of the even middle [1/m].
    const [low, high] = [0.5 * HEIGHTS, 0.6 * HEIGHTS]
    const scaled = (depths[high] - depths[low]) / (0.1 * (fog.topAltitude! - fog.baseAltitude!))
    const depthSum = (opacity: number): number => opacity + (1 - opacity) * Math.log(1 - opacity)
    let sum = 0
    for (let stratum = 0; stratum < POINTS; stratum++) {
      const [from, to] = [stratum, stratum + 1].map(i => (i / POINTS) ** 2)
      const end = Math.min(to, 1 - LEAST_TRANSMITTANCE)
      const seen = (depthSum(end) - depthSum(from)) / (end - from) / scaled
      const points = stem.map(([e, n, u]): Point => [
        e + at.x,
        u - camera.position.y,
        -n + at.z + seen
      ])
      let line = 0
      for (let i = 1; i < points.length; i++)
        line += meanInverseSquareOf(points[i - 1], points[i], 250) / (points.length - 1)
      const out = meanOut / (scaled * Math.hypot(...points[2]) + OPEN)
      sum += line * out * (to - from)
    }
    const [r, g, b] = CHANNEL_COLOR
    const expected = (((r + g + b) / 3) * power * sum) / (4 * Math.PI ** 2)
    const added = middle(lit) - middle(before)
    t.note(`${added.toExponential(3)} for ${expected.toExponential(3)}`)
    expectClose([added], [expected], { relative: 0.05 }, 'glow')
    expectTrue(storm.light.intensity > 0, 'it lights surfaces')

    // What was drawn hides it.
    const board = new Mesh(new BoxGeometry(100, 100, 1), new MeshBasicMaterial({ color: 0 }))
    board.position.set(0, camera.position.y, -5)
    scene.add(board)
    expectTrue(middle(await view.draw(FRAMES)) < 0.05 * middle(lit), 'a board hides it')
    scene.remove(board)

    storm.time = 100
    expectClose([middle(await view.draw(FRAMES))], [middle(before)], { relative: 0.01 }, 'after')
    expectTrue(!storm.isFlashing && storm.light.intensity === 0, 'it is over')
    storm.dispose()
    board.geometry.dispose()
    board.material.dispose()
  })
)

gpuTest(
  'a storm is struck where its columns are strong, at the same place for the same seed',
  t =>
    inFog(t, async view => {
      const { node } = view
      node.field.layers.at(0).set({ topAltitude: 6000 })
      const distances: number[] = []
      for (let i = 0; i < 2; i++) {
        const storm = lightning(node, { seed: 4, time: 0 })
        view.show(node)
        storm.addEventListener('strike', ({ distance, delay, duration }) => {
          distances.push(distance)
          expectClose([delay], [distance / 340], { relative: 1e-6 }, 'delay')
          expectTrue(duration > 0, 'thunder rolls')
        })
        let heard = 0
        storm.addEventListener('thunder', () => heard++)
        storm.strike()
        for (let frame = 0; frame < 30 && distances.length === i; frame++) await view.draw(2)
        expectTrue(distances.length === i + 1, 'it strikes')
        storm.time = distances[i] / 340 + 0.1
        await view.draw(2)
        expectTrue(heard === 1, `thunder is heard ${heard} times`)
        storm.dispose()
      }
      t.note(`${distances.map(d => d.toFixed(0)).join(', ')} m`)
      expectClose([distances[1]], [distances[0]], { relative: 1e-6 }, 'distance')
      expectTrue(distances[0] > 500 && distances[0] < 30_000, 'it is in reach')
    }),
  { backends: ['webgpu'] }
)

gpuTest(
  'light of a flash passes clouds of other layers as slabs of their depth',
  t =>
    inFog(t, async ({ renderer, atmosphere }, shared) => {
      const [base, top] = [500, 4500]
      const layers = new CloudLayers([
        { ...fog, topAltitude: 1500 },
        { ...fog, baseAltitude: 2500, topAltitude: top }
      ])
      const view = new CloudView(renderer, atmosphere, layers, shared)
      view.camera.position.set(0, 2000, 0)
      await view.draw(2)
      const { space, parameters } = atmosphere
      const viewpoint = space.position(view.camera.position, new Vector3())
      const up = viewpoint.clone().normalize()
      const east = new Vector3(0, 0, 1).cross(up).normalize()
      const axes = [east, up.clone().cross(east), up] as const
      const place = up.clone().multiplyScalar(parameters.bottomRadius).sub(viewpoint)
      const storm = new StormDensity(view.node.field)
      const stem = Array.from({ length: 5 }, (): Point => [0, 0, 1000])
      storm.bake(renderer, place, { axes, stem, place, pieces: [], brightLength: 1 }, { base, top })
      const altitudes = [1300, 2000, 3000, 4000]
      const found = await evaluateOnGpu(
        renderer,
        altitudes.map(altitude => up.clone().multiplyScalar(altitude).add(place).toArray()),
        input => vec4(storm.lightOut(input.xyz), 0, 0)
      )
      const depths = await depthsUpwards(view, 0, [base, top])
      const depthTo = (altitude: number): number =>
        depths[Math.round(((altitude - base) / (top - base)) * HEIGHTS)]
      const [own, between, near, far] = altitudes.map((_, i) => found[4 * i])
      const others = altitudes.map((_, i) => found[4 * i + 1])
      const [, , ...ofOther] = others
      expectClose([others[0], ...ofOther], [0, 1, 1], { absolute: 0.05 }, 'out of another cloud')
      // Within a cloud, by the depth from the flash.
      const out = (altitude: number): number => 1 / (depthTo(altitude) - depthTo(1000) + OPEN)
      expectClose([own / between], [out(1300) / out(1500)], { relative: 0.08 }, 'own cloud')
      const passed = (altitude: number): number => OPEN / (depthTo(altitude) - depthTo(2500) + OPEN)
      t.note(`${(near / between).toFixed(3)} and ${(far / between).toFixed(3)} pass`)
      expectClose([near / between], [passed(3000)], { relative: 0.08 }, 'into the next cloud')
      expectClose([far / between], [passed(4000)], { relative: 0.08 }, 'through the next cloud')
      storm.dispose()
      view.dispose()
    }),
  { backends: ['webgpu'] }
)
