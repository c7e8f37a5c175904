import { expectLight, random } from './harness/atmosphere'
import { CHANGE, checkPicture, measurePassing } from './harness/check-parts'
import { expectTrue } from './harness/expect'
import { featureSize, FeatureStage } from './harness/features'
import { gpuTest } from './harness/gpu-test'
import type { Picture } from './harness/picture'
import { covers, featureNames, hours, seen, type FeatureName, type Hour } from './harness/predict'
import { watchShaders } from './harness/shaders'

const SEED = 20_260
const COUNT = 60
/** Least sets that a feature is in. */
const LEAST_SETS = 5
/** Sets besides, of stars that are painted last and what covers them, which the seed has by day alone. */
const COVERED: FeatureName[][] = [
  ['starsOverlay', 'clouds'],
  ['starsOverlay', 'heightFog']
]
/** Textures that a stage may sample. */
const LIMIT = 16
/** Least part of all numbers that their parts tell, give or take a little. */
const LEAST_KNOWN = 0.75
/** Sets besides one with ground that are drawn with shaders of their own, too, and how much they may differ. */
const ALONE = 2
const OFF_TOLERANCE = 2e-3

interface Combination {
  names: FeatureName[]
  hour: Hour
  /** Drawn over white. */
  isWhite?: boolean
}

/** True for what the march of clouds draws, which takes the longest to draw. */
const isCloudy = ({ names }: Combination): boolean =>
  names.includes('clouds') || names.includes('lightning')

/** True for what neither draws clouds nor compiles shaders for the ground. */
const isQuick = (set: Combination): boolean => !isCloudy(set) && !set.names.includes('ground')

/**
 * Pairs and triples of features, the same in every run: as cards that are dealt, so that each is in as many as any other, at an hour
 * at which most of them are seen.
 */
function combinations(): Combination[] {
  const next = random(SEED)
  const below = (count: number): number => Math.floor(next() * count)
  let deck: FeatureName[] = []
  const deal = (chosen: readonly FeatureName[]): FeatureName => {
    if (deck.every(name => chosen.includes(name))) deck = [...deck, ...featureNames]
    const left = deck.filter(name => !chosen.includes(name))
    const card = left[below(left.length)]
    deck.splice(deck.indexOf(card), 1)
    return card
  }
  return Array.from({ length: COUNT }, () => {
    const chosen: FeatureName[] = []
    const size = 2 + below(2)
    while (chosen.length < size) chosen.push(deal(chosen))
    const names = featureNames.filter(name => chosen.includes(name))
    const count = (hour: Hour): number => names.filter(name => seen[name].at.includes(hour)).length
    const best = hours.filter(hour => count(hour) === Math.max(...hours.map(count)))
    return { names, hour: best[below(best.length)] }
  })
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

const keyOf = (names: readonly FeatureName[], hour: Hour, isWhite = false): string =>
  `${names.join(' + ')} ${hour.name}${isWhite ? ' over white' : ''}`

/** Frames before the first picture of an hour, and before the first with clouds: their shadows are drawn by strips. */
const WARM_UP = 4
const CLOUDS_WARM_UP = 14
/** Frames before other pictures with clouds: by night clouds still settle. */
const CLOUDS_SETTLING = 8

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
            isCloudy({ names, hour: at }) === hasClouds
        )
        let warmUp = hasClouds ? CLOUDS_WARM_UP : WARM_UP
        for (const { names, isWhite = false } of own) {
          const key = keyOf(names, hour, isWhite)
          if (drawn.has(key)) continue
          stage.show(names)
          stage.isWhite = isWhite
          drawn.set(key, await stage.draw(hour, warmUp))
          warmUp = hasClouds ? CLOUDS_SETTLING : 0
        }
        stage.isWhite = false
      }
    }
  }
  return drawn
}

/** Mean of a picture's numbers but alpha. */
const mean = (numbers: Float32Array): number =>
  numbers.reduce((sum, value, i) => (i % 4 === 3 ? sum : sum + value), 0) / (0.75 * numbers.length)

/** Says which features do not show alone at an hour at which they are seen. */
function unseen(
  parts: readonly Combination[],
  pictureOf: (names: FeatureName[], hour: Hour) => Picture
): string[] {
  return parts.flatMap(({ names, hour }) => {
    const [name] = names
    if (name === undefined || !seen[name].at.includes(hour)) return []
    const [alone, none] = [pictureOf([name], hour), pictureOf([], hour)]
    let changed = 0
    for (let i = 0; i < alone.data.length; i += 4) {
      const [a, b] = [alone, none].map(({ data }) => data.subarray(i, i + 3))
      const bright = Math.max(...a, ...b)
      if (a.some((value, k) => Math.abs(value - b[k]) > 2 * CHANGE * bright)) changed++
    }
    const share = (4 * changed) / alone.data.length
    return share >= seen[name].share
      ? []
      : [`${name} ${hour.name} changes ${(100 * share).toFixed(1)} % of all pixels`]
  })
}

gpuTest(
  'pairs and triples of features draw what each of them draws alone',
  async t => {
    const renderer = await t.createRenderer(featureSize)
    const shaders = watchShaders(renderer)
    const stage = new FeatureStage(renderer)
    await stage.prepare()
    const night = hours[2]
    const dealt = combinations()
    const sets = [...dealt, ...COVERED.map(names => ({ names, hour: night }))]
    for (const name of featureNames) {
      const count = dealt.filter(({ names }) => names.includes(name)).length
      expectTrue(count >= LEAST_SETS, `${name} is in ${count} sets`)
    }
    const parts = sets.flatMap(({ names, hour }): Combination[] => [
      { names: [], hour },
      ...names.map(name => ({ names: [name], hour }))
    ])
    const layers: FeatureName[][] = [[], ...covers.map(name => [name])]
    const whole = layers.flatMap(names =>
      [false, true].map(isWhite => ({ names, hour: night, isWhite }))
    )
    const drawn = await drawAll(stage, [...parts, ...sets, ...whole])
    const pictureOf = (names: FeatureName[], hour: Hour): Picture => drawn.get(keyOf(names, hour))!
    const passing = measurePassing((names, isWhite) => drawn.get(keyOf(names, night, isWhite))!)
    let [known, least] = [0, 1]
    const mixed = { known: 0, all: 0 }
    const wrong = [...new Set(unseen(parts, pictureOf))]
    for (const set of sets) {
      const { names, hour } = set
      const singles = names.map(name => pictureOf([name], hour))
      const picture = pictureOf(names, hour)
      expectLight(picture, keyOf(names, hour))
      const found = checkPicture(names, picture, pictureOf([], hour), singles, passing)
      known += found.known / sets.length
      least = Math.min(least, found.known)
      mixed.known += found.mixed.known
      mixed.all += found.mixed.all
      if (found.wrong !== undefined) wrong.push(`${keyOf(names, hour)}: ${found.wrong}`)
    }
    // A feature that is off is as one that is absent.
    const grounded = sets.find(set => !isCloudy(set) && set.names.includes('ground'))!
    const alone = [grounded, ...sets.filter(isQuick).slice(0, ALONE)]
    for (const { names, hour } of alone) {
      stage.show(names, 'absent')
      const apart = difference(await stage.draw(hour, WARM_UP), pictureOf(names, hour))
      if (apart > OFF_TOLERANCE)
        wrong.push(`${keyOf(names, hour)}: ${apart} apart without the others`)
    }
    const most = Math.max(...shaders.map(({ textures }) => textures))
    const percent = (share: number): string => `${(100 * share).toFixed(0)} %`
    t.note(
      `seed ${SEED}, ${sets.length} sets, ${percent(known)} of all numbers known, ${percent(mixed.known / mixed.all)} of the ${percent(mixed.all / (0.75 * 4 * featureSize.width * featureSize.height * sets.length))} that two features change, ${percent(least)} in one set`
    )
    const means = [...passing].map(([name, through]) => `${name} ${percent(mean(through))}`)
    t.note(`part of the light that passes: ${means.join(', ')}`)
    t.note(`${drawn.size} pictures, ${shaders.length} shaders, at most ${most} textures`)
    expectTrue(known >= LEAST_KNOWN, `${percent(known)} of numbers are known`)
    expectTrue(wrong.length === 0, wrong.join('\n'))
    expectTrue(most <= LIMIT, `a shader samples ${most} textures`)
    stage.dispose()
  },
  // The material with six maps has most features at once on WebGL.
  { backends: ['webgpu'] }
)
