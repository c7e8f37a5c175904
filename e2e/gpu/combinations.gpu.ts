import type { Backend } from '../harness/backend'
import { expectLight, random } from './harness/atmosphere'
import { expectTrue } from './harness/expect'
import {
  featureNames,
  features,
  featureSize,
  FeatureStage,
  hours,
  type FeatureName,
  type Hour
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
/** Sets that are drawn with shaders of their own, too, and how much they may differ. */
const ALONE = 4
const OFF_TOLERANCE = 2e-3

interface Combination {
  names: FeatureName[]
  hour: Hour
}

/** Sets on WebGL, without clouds, which {@link COUNT} of WebGPU's begin with. */
const COUNT_ON_WEBGL = 12

const cloudless = featureNames.filter(name => name !== 'clouds' && name !== 'starsOverlay')

/** Features that stars drawn last are paired with: clouds are in `clouds/stars`. */
const overlaid: readonly FeatureName[] = [
  'heightFog',
  'distanceFog',
  'moon',
  'ground',
  'milkyWay',
  'airglow'
]

/** Pairs and triples of features, the same in every run, and pairs with `starsOverlay`. */
function combinations(backend: Backend): Combination[] {
  const inOrder = (chosen: FeatureName): FeatureName[] =>
    featureNames.filter(name => name === chosen || name === 'starsOverlay')
  const all = [...randomSets(), ...overlaid.map(name => ({ names: inOrder(name), hour: hours[2] }))]
  if (backend === 'webgpu') return all
  const clear = all.filter(({ names }) => !names.includes('clouds'))
  return [...clear.slice(0, COUNT_ON_WEBGL), ...clear.slice(-overlaid.length)]
}

function randomSets(): Combination[] {
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
  // Fog that lies in shadow lacks what the shafts take of its own light.
  const isShadowed = parts.some(({ name }) => name === 'shafts')
  // In the dark a fog shows nothing of its own, and dims the others all the same.
  const isDimmed = dims.some(({ name }) => changing.every(each => each.name !== name))
  const least = isDimmed ? Math.min(none, base) : base
  return [isShadowed ? 0 : least, Math.max(isDimmed ? none : base, base) + added]
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
    // What is black in one channel of a colour may be less than that: sRGB has no such colour.
    const isCut = ({ data }: Picture, value: number): boolean =>
      value === 0 && data.subarray(first, first + 3).some(other => other > 0)
    if (singles.some((single, k) => isCut(single, parts[k].value))) continue
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

/** Largest difference of two pictures, over the brightness of its pixel. */
function difference(a: Picture, b: Picture): number {
  let most = 0
  for (let i = 0; i < a.data.length; i += 4) {
    const [one, other] = [a, b].map(({ data }) => data.subarray(i, i + 3))
    const bright = Math.max(...one, ...other, 1e-12)
    for (let k = 0; k < 3; k++) most = Math.max(most, Math.abs(one[k] - other[k]) / bright)
  }
  return most
}

const keyOf = (names: readonly FeatureName[], hour: Hour): string =>
  `${names.join(' + ')} ${hour.name}`

/** Frames before the first picture of an hour, and before the first with clouds: their shadows are drawn by strips. */
const WARM_UP = 4
const CLOUDS_WARM_UP = 14

/**
 * Draws sets of features, those of an hour after each other, with clouds last; shaders are compiled with and without
 * ground.
 */
async function drawAll(
  stage: FeatureStage,
  wanted: readonly Combination[]
): Promise<Map<string, Picture>> {
  const drawn = new Map<string, Picture>()
  for (const hasGround of [false, true]) {
    for (const hour of hours) {
      for (const hasClouds of [false, true]) {
        const own = wanted.filter(
          ({ names, hour: at }) =>
            at === hour &&
            names.includes('ground') === hasGround &&
            names.includes('clouds') === hasClouds
        )
        let warmUp = hasClouds ? CLOUDS_WARM_UP : WARM_UP
        for (const { names } of own) {
          const key = keyOf(names, hour)
          if (drawn.has(key)) continue
          stage.show(names)
          drawn.set(key, await stage.draw(hour, warmUp))
          warmUp = 0
        }
      }
    }
  }
  return drawn
}

gpuTest(
  'pairs and triples of features draw what each of them draws alone',
  async t => {
    const renderer = await t.createRenderer(featureSize)
    const shaders = watchFragmentShaders(renderer)
    const stage = new FeatureStage(renderer)
    const sets = combinations(t.backend)
    const parts = sets.flatMap(({ names, hour }) => [
      { names: [], hour },
      ...names.map(name => ({ names: [name], hour }))
    ])
    const drawn = await drawAll(stage, [...parts, ...sets])
    const pictureOf = (names: FeatureName[], hour: Hour): Picture => drawn.get(keyOf(names, hour))!
    let known = 0
    const wrong: string[] = []
    for (const set of sets) {
      const { names, hour } = set
      const singles = names.map(name => pictureOf([name], hour))
      const found = check(set, pictureOf(names, hour), pictureOf([], hour), singles)
      known += found.known / sets.length
      if (found.wrong !== undefined) wrong.push(found.wrong)
    }
    // A feature that is off is as one that is absent.
    const alone = sets.filter(({ names }) => !names.includes('clouds')).slice(0, ALONE)
    for (const { names, hour } of alone) {
      stage.show(names, 'absent')
      const apart = difference(await stage.draw(hour, 2), pictureOf(names, hour))
      if (apart > OFF_TOLERANCE) wrong.push(`${keyOf(names, hour)}: ${apart} without the others`)
    }
    const most = Math.max(...shaders.map(({ textures }) => textures))
    t.note(`seed ${SEED}, ${sets.length} sets, ${(100 * known).toFixed(0)} % of all numbers known`)
    t.note(`${shaders.length} shaders, at most ${most} textures`)
    expectTrue(wrong.length === 0, wrong.join('\n'))
    expectTrue(known > 0.4, `parts say something of ${(100 * known).toFixed(0)} % only`)
    expectTrue(most <= LIMIT, `a shader samples ${most} textures`)
    stage.dispose()
  },
  { timeoutSeconds: 300 }
)
