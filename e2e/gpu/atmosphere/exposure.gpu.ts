import {
  Atmosphere,
  autoExposure,
  photographicToneMapping,
  purkinjeShift,
  type PhotographicLook,
  type AutoExposureOptions
} from '@welkin/atmosphere'
import {
  ACESFilmicToneMapping,
  AgXToneMapping,
  CustomToneMapping,
  DataTexture,
  FloatType,
  NearestFilter,
  type Texture,
  type ToneMapping
} from 'three'
import { agxToneMapping, float, texture, uniform, vec3, vec4 } from 'three/tsl'
import { RenderPipeline, type Node, type WebGPURenderer } from 'three/webgpu'
import {
  cellWeights,
  meteredLogLuminance,
  meterForm
} from '../../../packages/atmosphere/src/exposure/cpu/meteredLuminance'
import { ExposureMeter } from '../../../packages/atmosphere/src/exposure/ExposureMeter'
import { purkinjeShift as shiftTwin } from '../../../packages/atmosphere/test/twins/exposure/purkinjeShift'
import { tonesOf } from '../../harness/tones'
import { days, ExposureStage, nights, type ExposureScene } from '../harness/exposure-scenes'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import type { GpuContext } from '../harness/context'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'

const size = { width: 160, height: 90 }
/** Size of scenes: their pixels take long in software. */
const sceneSize = { width: 64, height: 36 }
/** Luminance scale that exposure starts from. */
const DAYLIGHT = 1e-4

type Color = readonly [number, number, number]

const luminance = ([r, g, b]: Color): number => 0.2126729 * r + 0.7151522 * g + 0.072175 * b

/**
 * A high range, the same upside down: nine stops from left to right, two from the edges to the middle, hues, a
 * sun of infinite light, pixels that are black or no number.
 */
function pattern(width: number, height: number): { colors: Color[]; picture: Texture } {
  const colors = Array.from({ length: width * height }, (_, i): Color => {
    const x = (i % width) + 0.5
    const y = Math.floor(i / width) + 0.5
    const sun = Math.hypot(x - 0.7 * width, y - height / 2) < height / 30
    if (sun) return [Infinity, Infinity, Infinity]
    if ((i % width) % 11 === 3) return [NaN, NaN, NaN]
    if ((i % width) % 13 === 5) return [0, 0, 0]
    const base = 2 ** ((9 * x) / width - 6 + 2 * (1 - Math.abs((2 * y) / height - 1)))
    return [base, base * (0.4 + (0.6 * x) / width), base * 0.3]
  })
  const data = new Float32Array(colors.flatMap(color => [...color, 1]))
  const picture = new DataTexture(data, width, height, undefined, FloatType)
  picture.minFilter = picture.magFilter = NearestFilter
  picture.needsUpdate = true
  return { colors, picture }
}

/** Float64 twin of `logLuminance` for all of a picture, four samples a cell, row by row. */
function logLuminances(colors: readonly Color[], width: number, height: number): number[] {
  const [columns, rows] = meterForm.cells
  const sample = (left: number, top: number): number => {
    const logs = Array.from({ length: meterForm.taps * meterForm.taps }, (_, tap) => {
      const x = left + ((tap % meterForm.taps) + 0.5) / (2 * meterForm.taps)
      const y = top + (Math.floor(tap / meterForm.taps) + 0.5) / (2 * meterForm.taps)
      const column = Math.floor((x / columns) * width)
      const row = Math.floor((y / rows) * height)
      return Math.log2(Math.min(luminance(colors[row * width + column]), 65_536))
    }).filter(log => log > -24)
    return logs.length > 0 ? logs.reduce((sum, log) => sum + log, 0) / logs.length : -24
  }
  return Array.from({ length: columns * rows * 4 }, (_, i) => {
    const [column, row] = [(i >> 2) % columns, Math.floor((i >> 2) / columns)]
    return sample(column + (i % 2) / 2, row + ((i >> 1) % 2) / 2)
  })
}

gpuTest(
  'log luminance agrees with its float64 twin, in a picture with a sun and holes',
  async t => {
    const renderer = await t.createRenderer(size)
    const [width, height] = [333, 187]
    const { colors, picture } = pattern(width, height)
    const meter = new ExposureMeter()
    const read = await new Promise<Float32Array>(resolve => {
      meter.meter(renderer, picture, 1, reading => {
        resolve(reading.logs)
      })
    })
    // A read-back comes bottom-up on WebGL 2.
    const row = (i: number): number => Math.floor(i / 4 / meterForm.cells[0])
    const flipped = (i: number): number =>
      i + (meterForm.cells[1] - 1 - 2 * row(i)) * 4 * meterForm.cells[0]
    const logs = t.backend === 'webgl' ? read.map((_, i) => read[flipped(i)]) : read
    const expected = logLuminances(colors, width, height)
    // Half floats hold eight stops within 1/256; a place between two pixels may be rounded to either.
    const differences = logs.map((log, i) => Math.abs(log - expected[i])).toSorted()
    const [median, most] = [0.5, 0.99].map(part => differences[Math.floor(part * logs.length)])
    t.note(`differences: median ${median.toFixed(4)}, 99 % ${most.toFixed(4)} stops`)
    expectTrue(median < 1 / 256, `median difference ${median}`)
    expectTrue(most < 1 / 64, `difference ${most} in 1 %`)
    meter.dispose()
    picture.dispose()
  }
)

/** Draws a picture through an exposure, and meters it. */
async function metered(
  renderer: WebGPURenderer,
  picture: Texture,
  isTexture: boolean
): Promise<{ luminance: number; inTime: boolean; scale: number }> {
  const atmosphere = new Atmosphere({ luminanceScale: 1e-3 })
  const color = texture(picture)
  const exposure = autoExposure(isTexture ? color : color.mul(1), atmosphere, {
    darkNights: false,
    centerWeight: 0.5,
    percentiles: [0.1, 0.97],
    highlightPriority: 0
  })
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputNode = exposure
  await nextFrame()
  pipeline.render()
  const inTime = exposure.luminance === null
  atmosphere.luminanceScale = 1
  await exposure.settle()
  const result = { luminance: exposure.luminance!, inTime, scale: atmosphere.luminanceScale }
  exposure.dispose()
  pipeline.dispose()
  return result
}

gpuTest('meters a high range within 2 %, by the scale that it was drawn with', async t => {
  const renderer = await t.createRenderer(size)
  const { colors, picture } = pattern(size.width, size.height)
  const logs = logLuminances(colors, size.width, size.height)
  const expected = 1000 * 2 ** meteredLogLuminance(logs, cellWeights(0.5), [0.1, 0.97]).mean
  for (const isTexture of [true, false]) {
    const { luminance, inTime, scale } = await metered(renderer, picture, isTexture)
    t.note(`${isTexture ? 'texture' : 'node'}: ${(luminance / expected - 1).toExponential(1)}`)
    expectTrue(inTime, 'the picture was read back within its frame')
    expectClose(luminance, expected, { relative: 0.02 }, 'metered luminance')
    expectClose(scale * luminance, 0.17, { relative: 1e-6 }, 'grey')
  }
  picture.dispose()
})

gpuTest('meters an even picture exactly, however large', async t => {
  for (const [width, height] of [
    [7, 3],
    [64, 36],
    [1000, 600]
  ]) {
    const renderer = await t.createRenderer(size)
    const picture = new DataTexture(
      new Float32Array(4 * width * height).fill(3),
      width,
      height,
      undefined,
      FloatType
    )
    picture.needsUpdate = true
    const { luminance } = await metered(renderer, picture, true)
    expectClose(luminance, 3000, { relative: 0.005 }, `${width}×${height}`)
    picture.dispose()
  }
})

gpuTest(
  'photographic tones: AgX with an S-curve, black and white where they were',
  async t => {
    const renderer = await t.createRenderer(size)
    const greys = [0, 1e-4, 0.01, 0.05, 0.18, 0.5, 2, 8, 40].map(grey => [grey])
    const pairs = await evaluateOnGpu(renderer, greys, input => {
      const light = vec3(input.x)
      const agx = agxToneMapping(light, float(1)) as Node<'vec3'>
      const mapped = (look: PhotographicLook, color: Node<'vec3'> = light): Node<'vec3'> =>
        photographicToneMapping(look)(color, float(1)) as Node<'vec3'>
      const white = [1, 1, 1] as const
      const plain = mapped({ contrast: 1, saturation: 1, white })
      const steep = mapped({ contrast: 1.5, saturation: 0, white })
      const sunlit = mapped({}, light.mul(vec3(1.116, 1, 0.978))).toConst()
      return vec4(agx.x, plain.x, steep.x, sunlit.x.sub(sunlit.z))
    })
    for (let i = 0; i < greys.length; i++) {
      const [agx, plain, steep, tint] = pairs.subarray(4 * i)
      const what = `grey ${greys[i][0]}`
      expectClose(plain, agx, { absolute: 2e-4 }, `${what}, contrast 1`)
      const x = agx ** (1 / 2.2)
      const curve = x ** 1.5 / (x ** 1.5 + (1 - x) ** 1.5)
      const expected = (curve + 0.6 * (1 - x) * (x - curve)) ** 2.2
      expectClose(steep, expected, { absolute: 1e-3 }, `${what}, contrast 1.5`)
      expectClose(tint, 0, { absolute: 1e-3 }, `${what} in sunlight`)
    }
  },
  { backends: ['webgpu'] }
)

gpuTest("Purkinje's shift agrees with its float64 twin, from stars to daylight", async t => {
  const renderer = await t.createRenderer(size)
  const hues = [
    [1, 1, 1],
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0.7, 0.4],
    [0, 0, 0]
  ] as const
  const levels = Array.from({ length: 33 }, (_, i) => 10 ** (i / 4 - 5))
  for (const [scale, adaptation, strength] of [
    [1, 1e-5, 1],
    [1e3, 1e-5, 1],
    [1e-4, 0.1, 0.6],
    [50, 20, 1]
  ] as const) {
    const inputs = hues.flatMap(hue =>
      levels.map(level => hue.map(value => value * level * scale) as [number, number, number])
    )
    const got = await evaluateOnGpu(renderer, inputs, input => {
      const sight = { luminanceScale: scale, adaptation, strength }
      const [a, b, c] = Object.values(sight).map(value => float(value))
      return vec4(purkinjeShift(input.xyz, { luminanceScale: a, adaptation: b, strength: c }), 0)
    })
    const sight = { luminanceScale: scale, adaptation, strength }
    for (const [i, input] of inputs.entries()) {
      const expected = shiftTwin(input, sight)
      const most = Math.max(...input, ...expected)
      const label = `colour ${input.join(', ')} per ${scale}`
      expectClose(got.subarray(4 * i, 4 * i + 3), expected, { absolute: 2e-5 * most }, label)
      if (adaptation > 5)
        expectClose(got.subarray(4 * i, 4 * i + 3), input, { relative: 1e-6 }, label)
    }
  }
})

/** Mean colour of an even, warm scene through an exposure that has adapted to it. */
async function shownWarm(
  t: GpuContext,
  luminanceOfScene: number,
  options: AutoExposureOptions,
  isOther: boolean
): Promise<number[]> {
  const renderer = await t.createRenderer(size)
  const atmosphere = new Atmosphere()
  const scale = uniform(atmosphere.luminanceScale)
  const color = vec4(vec3(1.3, 0.95, 0.6).mul(luminanceOfScene).mul(scale), 1)
  const exposure = autoExposure(color, atmosphere, options)
  const pipeline = new RenderPipeline(renderer)
  // What meters is to be drawn, too.
  pipeline.outputNode = isOther ? exposure.mul(0).add(exposure.exposed(color)) : exposure
  for (let frame = 0; frame < 4; frame++) {
    await nextFrame()
    scale.value = atmosphere.luminanceScale
    pipeline.render()
    await exposure.settle()
  }
  scale.value = atmosphere.luminanceScale
  const { data } = await t.capture(renderer, () => pipeline.render())
  const pixels = data.length / 4
  const mean = [0, 1, 2].map(i => data.reduce((sum, v, k) => (k % 4 === i ? sum + v : sum), 0))
  exposure.dispose()
  pipeline.dispose()
  atmosphere.dispose()
  return mean.map(sum => sum / pixels)
}

gpuTest('automatic exposure shows a warm night bluish, unless told otherwise', async t => {
  for (const [luminance, options, isBluish, isOther] of [
    [0.01, {}, true, false],
    [0.01, {}, true, true],
    [0.01, { purkinjeShift: 0 }, false, false],
    [0.01, { darkNights: false }, false, false],
    [20, {}, false, false]
  ] as const) {
    const [r, g, b] = await shownWarm(t, luminance, options, isOther)
    const figures = [r, g, b].map(value => value.toFixed(3)).join(', ')
    const label = `${luminance} cd/m², ${JSON.stringify(options)}${isOther ? ', exposed as another' : ''}: ${figures}`
    t.note(label)
    expectTrue(isBluish ? b > 1.1 * g && g > r : r > 1.1 * g && g > 1.1 * b, label)
  }
})

/** Tone mappings that pictures are judged by. */
const mappings: readonly [string, ToneMapping][] = [
  ['photographic', CustomToneMapping],
  ['AgX', AgXToneMapping],
  ['ACES', ACESFilmicToneMapping]
]

/** A scene, how nights are shown, and the least and greatest mean of its picture. */
interface Judged {
  scene: ExposureScene
  darkNights: boolean
  range: readonly [number, number]
}

const judged = (
  scenes: readonly ExposureScene[],
  range: Judged['range'],
  darkNights = true
): Judged[] => scenes.map(scene => ({ scene, darkNights, range }))

/** Checks scenes' tones as viewers see them. */
async function judge(t: GpuContext, all: readonly Judged[]): Promise<void> {
  const renderer = await t.createRenderer(sceneSize)
  const isNight = nights.includes(all[0].scene)
  const stage = new ExposureStage(renderer, isNight)
  renderer.library.addToneMapping(photographicToneMapping(), CustomToneMapping)
  /** Luminance scale, and luminance that it is of, by scene. */
  const exposed = new Map<Judged, readonly [scale: number, metered: number]>()
  for (const [name, toneMapping] of mappings) {
    renderer.toneMapping = toneMapping
    stage.refresh()
    for (const each of all) {
      const { scene, darkNights, range } = each
      stage.show(scene)
      stage.exposure.darkNights = darkNights
      const before = exposed.get(each)
      if (before === undefined) {
        // From a scale for daylight; half floats hold no night in that.
        stage.atmosphere.luminanceScale = DAYLIGHT
        await stage.settle(isNight ? 4 : 2)
        exposed.set(each, [stage.atmosphere.luminanceScale, stage.exposure.luminance!])
      } else {
        stage.atmosphere.luminanceScale = before[0]
      }
      await nextFrame()
      const picture = await t.capture(renderer, () => stage.draw())
      const { mean, clipped } = tonesOf(picture.data, 1)
      const figures = `mean ${mean.toFixed(3)}, clipped ${(100 * clipped).toFixed(2)} %`
      const metered = exposed.get(each)![1].toPrecision(3)
      const shown = `${scene.name}${darkNights ? '' : ' as a day'}`
      const label = `${shown}, ${metered} cd/m², ${name}: ${figures}`
      t.note(label)
      expectTrue(clipped <= 0.03, label)
      expectTrue(mean >= range[0] && mean <= range[1], label)
    }
  }
  stage.dispose()
}

gpuTest(
  'days, faced suns, snow and orbit: at most 3 % clipped, mean 0.2 to 0.5',
  async t => judge(t, judged(days, [0.2, 0.5])),
  // What meters is what the tests above run on both.
  { backends: ['webgpu'] }
)

gpuTest(
  'nights with and without a moon stay dark, not black, and with darkNights off they are shown as days: at most 3 % clipped',
  async t => judge(t, [...judged(nights, [0.02, 0.2]), ...judged(nights, [0.2, 0.5], false)]),
  // As with days.
  { backends: ['webgpu'] }
)
