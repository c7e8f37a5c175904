import { expectLight, random } from './harness/atmosphere'
import { expectTrue } from './harness/expect'
import {
  featureNames,
  features,
  featureSize,
  FeatureStage,
  hours,
  type FeatureName
} from './harness/features'
import { gpuTest } from './harness/gpu-test'
import type { Picture } from './harness/picture'
import { watchFragmentShaders } from './harness/shaders'

const SEED = 20_260
const COUNT = 60
/** Textures that a stage may sample. */
const LIMIT = 16
/** Change of a pixel that counts as one, and the error of what is predicted, over its brightness. */
const CHANGE = 3e-4
const TOLERANCE = 4e-3
/** Error with clouds, whose shadows follow the sun over some frames. */
const CLOUD_TOLERANCE = 0.03

interface Combination {
  names: FeatureName[]
  hour: (typeof hours)[number]
}

const cloudless = featureNames.filter(name => name !== 'clouds')

/** Pairs and triples of features, the same in every run. */
function combinations(): Combination[] {
  const next = random(SEED)
  const below = (count: number): number => Math.floor(next() * count)
  return Array.from({ length: COUNT }, () => {
    const chosen = new Set<FeatureName>()
    const size = 2 + below(2)
    // Clouds take the longest to compile, and are in one of eight.
    if (below(8) === 0) chosen.add('clouds')
    while (chosen.size < size) chosen.add(cloudless[below(cloudless.length)])
    const names = featureNames.filter(name => chosen.has(name))
    return { names, hour: hours[below(hours.length)] }
  })
}

/** Least and greatest that a number may be, by those of the parts alone. */
function predict(
  none: number,
  parts: readonly { name: FeatureName; value: number }[],
  error: number
): readonly [number, number] | null {
  const changing = parts.filter(({ value }) => Math.abs(value - none) > error)
  const others = changing.filter(({ name }) => features[name] !== 'adds')
  const added = changing
    .filter(({ name }) => features[name] === 'adds')
    .reduce((sum, { value }) => sum + value - none, 0)
  const bends = parts.some(({ name }) => features[name] === 'bends')
  const isAlone = changing.every(({ name }) => features[name] === 'bends')
  if (others.length > 1 || (bends && !isAlone)) return null
  const base = others.length === 1 ? others[0].value : none
  const dims = parts.filter(({ name }) => features[name] === 'dims')
  if (added !== 0 && others.some(({ name }) => features[name] === 'changes')) return null
  if (dims.length === 0) return [base + added, base + added]
  // In the dark a fog shows nothing of its own, and dims the others all the same.
  const isDimmed = dims.some(({ name }) => changing.every(each => each.name !== name))
  return [isDimmed ? Math.min(none, base) : base, Math.max(isDimmed ? none : base, base) + added]
}

/** Compares a picture with its parts: the share of numbers that they say anything of, and the first that is wrong. */
function check(
  { names, hour }: Combination,
  drawn: Picture,
  none: Picture,
  singles: readonly Picture[]
): { known: number; wrong: string | undefined } {
  const label = `${names.join(' + ')} ${hour.name}`
  expectLight(drawn, label)
  const tolerance = names.includes('clouds') ? CLOUD_TOLERANCE : TOLERANCE
  let known = 0
  let wrong: string | undefined
  for (let i = 0; i < drawn.data.length; i++) {
    if (i % 4 === 3) continue
    const parts = names.map((name, k) => ({ name, value: singles[k].data[i] }))
    // Rounding is that of the pixel's brightest part: colours mix.
    const first = i - (i % 4)
    const bright = Math.max(
      ...[none, drawn, ...singles].map(({ data }) => Math.max(...data.subarray(first, first + 3)))
    )
    const range = predict(none.data[i], parts, CHANGE * bright)
    if (range === null) continue
    known++
    const error = tolerance * bright
    const [least, most] = range
    const value = drawn.data[i]
    const [x, y] = [(first >> 2) % featureSize.width, Math.floor((first >> 2) / featureSize.width)]
    if (value >= least - error && value <= most + error) continue
    const alone = parts.map(part => part.value.toPrecision(4)).join(', ')
    const found = `${value.toPrecision(4)}, not in [${least.toPrecision(4)}, ${most.toPrecision(4)}]`
    wrong ??= `${label}: channel ${i % 4} of (${x}, ${y}) is ${found}; without ${none.data[i].toPrecision(4)}, alone ${alone}`
  }
  return { known: known / (0.75 * drawn.data.length), wrong }
}

gpuTest(
  'pairs and triples of features draw what each of them draws alone',
  async t => {
    const renderer = await t.createRenderer(featureSize)
    const shaders = watchFragmentShaders(renderer)
    const stage = new FeatureStage(renderer)
    const kept = new Map<string, Promise<Picture>>()
    const draw = (names: readonly FeatureName[], hour: (typeof hours)[number]) => {
      const key = `${names.join(' ')} ${hour.name}`
      const before = kept.get(key)
      if (before !== undefined) return before
      stage.show(names)
      const drawn = stage.draw(hour)
      kept.set(key, drawn)
      return drawn
    }
    // Half of them on each backend.
    const own = combinations().filter((_, i) => (i % 2 === 0) === (t.backend === 'webgpu'))
    // Features one by one, so that a shader is compiled once for all hours.
    for (const name of featureNames) {
      for (const hour of hours) {
        if (own.some(each => each.hour === hour && each.names.includes(name))) {
          await draw([name], hour)
        }
      }
    }
    let known = 0
    const wrong: string[] = []
    for (const each of own) {
      const singles = []
      for (const name of each.names) singles.push(await draw([name], each.hour))
      const none = await draw([], each.hour)
      const found = check(each, await draw(each.names, each.hour), none, singles)
      known += found.known / own.length
      if (found.wrong !== undefined) wrong.push(found.wrong)
    }
    const most = Math.max(...shaders.map(({ textures }) => textures))
    t.note(`seed ${SEED}, ${own.length} sets, ${(100 * known).toFixed(0)} % of all numbers known`)
    t.note(`${shaders.length} shaders, at most ${most} textures`)
    expectTrue(wrong.length === 0, wrong.join('\n'))
    expectTrue(known > 0.4, `parts say something of ${(100 * known).toFixed(0)} % only`)
    expectTrue(most <= LIMIT, `a shader samples ${most} textures`)
    stage.dispose()
  },
  { timeoutSeconds: 240 }
)
