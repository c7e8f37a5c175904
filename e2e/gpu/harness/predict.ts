/**
 * Place of a feature on the way of light to the camera. Light: of the sky, on surfaces, in a flash. Things: a disc before the sky, ground that
 * hides all behind it, tiles with light of their own. Media and drops dim what is behind them and have light of their own;
 * corners dim the light on surfaces; shade takes light from the air.
 */
type Kind =
  | 'sky'
  | 'disc'
  | 'light'
  | 'corners'
  | 'tiles'
  | 'ground'
  | 'shade'
  | 'medium'
  | 'flash'
  | 'drops'

/** Features that may be on together: far before near, and what lies over the picture last. */
export const features = {
  stars: 'sky',
  starsOverlay: 'sky',
  milkyWay: 'sky',
  airglow: 'sky',
  sunFlare: 'sky',
  moon: 'disc',
  nightLight: 'light',
  moonlight: 'light',
  occlusion: 'corners',
  surfaceLighting: 'tiles',
  ground: 'ground',
  terrain: 'ground',
  shafts: 'shade',
  haze: 'medium',
  heightFog: 'medium',
  distanceFog: 'medium',
  clouds: 'medium',
  lightning: 'flash',
  drops: 'drops'
} as const satisfies Record<string, Kind>

export type FeatureName = keyof typeof features
export const featureNames = Object.keys(features) as FeatureName[]

/** Hours that features are drawn at, by the elevations of sun and moon [°]. */
export const hours = [
  { name: 'by day', sun: 25, moon: 30, scale: 1e-4 },
  { name: 'at dusk', sun: -4, moon: 20, scale: 1e-1 },
  { name: 'at night', sun: -30, moon: 30, scale: 1e2 }
] as const

export type Hour = (typeof hours)[number]

const [day, dusk, night] = hours
const always: readonly Hour[] = hours
const bright: readonly Hour[] = [day, dusk]

/**
 * When a feature by itself is seen, and the least share of pixels that it changes then: media fill the sky, which is half of the picture less
 * what stands before it; the Milky Way a band of it, airglow all; things are where they are.
 */
export const seen: Readonly<Record<FeatureName, { at: readonly Hour[]; share: number }>> = {
  stars: { at: [night], share: 0.05 },
  starsOverlay: { at: [night], share: 0.05 },
  milkyWay: { at: [night], share: 0.1 },
  airglow: { at: [night], share: 0.4 },
  sunFlare: { at: [day], share: 0.02 },
  // Less than a pixel wide.
  moon: { at: [night], share: 0.0015 },
  nightLight: { at: [night], share: 0.2 },
  moonlight: { at: [night], share: 0.2 },
  occlusion: { at: bright, share: 0.01 },
  surfaceLighting: { at: always, share: 0.01 },
  ground: { at: bright, share: 0.01 },
  terrain: { at: bright, share: 0.02 },
  shafts: { at: [day], share: 0.02 },
  haze: { at: bright, share: 0.4 },
  heightFog: { at: bright, share: 0.4 },
  distanceFog: { at: bright, share: 0.4 },
  clouds: { at: bright, share: 0.3 },
  lightning: { at: [night], share: 0.05 },
  drops: { at: bright, share: 0.1 }
}

/** Least and greatest that a number may be. */
export type Range = readonly [least: number, most: number]

/** A feature, and a number of the picture in which it is alone. */
export interface Part {
  readonly name: FeatureName
  readonly value: number
  /** Least and greatest part of the light behind it that passes, as measured apart; by default any, from none to all. */
  readonly passes?: Range
  /** Most light of it that media may scatter into a pixel; by default any. */
  readonly scattered?: number
}

/** Features that dim what is behind them, in every pixel that they fill. */
export const covers = ['haze', 'heightFog', 'distanceFog', 'clouds', 'drops'] as const

const kindOf = ({ name }: Part): Kind => features[name]
const ANY: Range = [0, 1]

/** Range of a number beyond which it says little: that part of its middle, and an error. */
const NARROW = 0.3

/** True if a range is a value, give or take a little. */
export function isKnown(range: Range | null, error: number): range is Range {
  if (range === null || !Number.isFinite(range[1])) return false
  return range[1] - range[0] <= (NARROW * (range[0] + range[1])) / 2 + error
}

/** Range under what passes a part of the light and has light of its own: with nothing else it makes `value` of `none`. */
function under(
  [least, most]: Range,
  none: number,
  { value, passes = ANY }: Omit<Part, 'name'>
): Range {
  const change = (part: number, behind: number): number => (part === 0 ? 0 : part * (behind - none))
  return [
    value + Math.min(...passes.map(part => change(part, least))),
    value + Math.max(...passes.map(part => change(part, most)))
  ]
}

const shift = ([least, most]: Range, by: number): Range => [least + by, most + by]

/**
 * Media in front of each other, in any order or mixed: they all dim what is behind, and the light of each is dimmed by the others or not.
 * If all are as bright as what is there without them, or brighter, so are they together; and so if they are darker.
 */
function underMedia([least, most]: Range, none: number, media: readonly Part[]): Range {
  const product = (factors: readonly number[]): number =>
    factors.reduce((all, each) => all * each, 1)
  const passes = media.map(part => part.passes ?? ANY)
  let dimmest = least * product(passes.map(([low]) => low))
  let brightest = most * product(passes.map(([, high]) => high))
  for (const [i, { value }] of media.entries()) {
    const others = passes.filter((_, k) => k !== i).map(([low]) => low)
    dimmest += Math.max(value - passes[i][1] * none, 0) * product(others)
    brightest += Math.max(value - passes[i][0] * none, 0)
  }
  const values = media.map(({ value }) => value)
  if (Math.min(least, ...values) >= none) dimmest = Math.max(dimmest, Math.min(...values))
  if (Math.max(most, ...values) <= none) brightest = Math.min(brightest, Math.max(...values))
  return [dimmest, brightest]
}

/** A pixel that ground fills. It is lit as surfaces are, and media and shade end at it, so that they are others than without it. */
function onGround(changing: readonly Part[], parts: readonly Part[]): Range | null {
  const kinds = new Set<Kind>(parts.map(kindOf))
  if (kinds.has('medium') || kinds.has('shade')) return null
  if (changing.some(({ name }) => name === 'sunFlare' || name === 'lightning')) return null
  const filling = changing.filter(part => kindOf(part) === 'ground')
  // The terrain is a thing of the scene, the planet's ground lies behind all of it.
  const { value } = filling.find(({ name }) => name === 'terrain') ?? filling[0]
  return [kinds.has('corners') ? 0 : value, kinds.has('light') ? Infinity : value]
}

/**
 * Least and greatest that a number may be, by those of the parts alone; null where they say nothing of it.
 *
 * @param none - The number without any.
 * @param error - Difference that counts as none.
 */
export function predict(none: number, parts: readonly Part[], error: number): Range | null {
  const changing = parts.filter(({ value }) => Math.abs(value - none) > error)
  const of = (kind: Kind, from = changing): Part[] => from.filter(part => kindOf(part) === kind)
  let range: Range | null = [none, none]
  if (of('ground').length > 0) {
    range = onGround(changing, parts)
  } else {
    for (const { value } of of('sky')) range = shift(range, value - none)
    for (const part of of('disc', [...parts])) range = under(range, none, part)
    for (const { value } of of('light')) range = shift(range, value - none)
    for (const part of of('corners', [...parts])) range = under(range, none, part)
    const isAsBefore = range[0] === none && range[1] === none
    for (const { value } of of('tiles')) {
      if (!isAsBefore) return null
      range = [value, value]
    }
    // Shade takes light of the air alone; fog may hide that.
    const isFoggy = of('medium', [...parts]).length > 0
    for (const { value } of of('shade'))
      range = [range[0] + value - none, isFoggy ? range[1] : range[1] + value - none]
    range = throughMedia(range, none, parts, changing)
  }
  if (range === null) return null
  const has = (kind: Kind): boolean => of(kind, [...parts]).length > 0
  const flash = parts.find(({ name }) => name === 'lightning')
  if (flash !== undefined) {
    const light = Math.max(flash.value - none, 0)
    if (parts.some(({ name }) => name === 'clouds')) range = [range[0], Infinity]
    else range = [range[0] + (has('medium') ? 0 : light), range[1] + light]
  }
  // Ground that is as dark as what it hides hides light all the same, and haze is before it, which is not before the sky.
  if (has('ground') && of('ground').length === 0) {
    const hazes = (some: readonly Part[]): boolean => some.some(({ name }) => name === 'haze')
    const isHazy = hazes(parts) && !hazes(changing)
    range = [Math.min(range[0], none), isHazy ? Infinity : Math.max(range[1], none)]
  }
  for (const part of of('drops', [...parts])) range = under(range, none, part)
  return [Math.max(range[0], 0), range[1]]
}

/** Part of the light that passes where there is nothing in the way, but for rounding. */
const CLEAR = 0.999

/** True where haze or distance fog leave the sky as it is: they dim what stands before it all the same. */
const leavesSky = ({ name, passes }: Part): boolean =>
  (name === 'haze' || name === 'distanceFog') && passes !== undefined && passes[0] > CLEAR

function throughMedia(
  behind: Range,
  none: number,
  parts: readonly Part[],
  changing: readonly Part[]
): Range {
  const media = parts.filter(part => kindOf(part) === 'medium')
  const leaving = media.filter(part => leavesSky(part) && !changing.includes(part))
  const filling = media.filter(part => !leaving.includes(part))
  let range = behind
  if (filling.length === 1) range = under(range, none, filling[0])
  else if (filling.length > 1) range = underMedia(range, none, filling)
  if (filling.some(({ passes = ANY }) => passes[0] < CLEAR))
    for (const { value } of leaving) range = under(range, none, { value })
  if (media.length === 0) return range
  // Media scatter the moon's light.
  for (const part of parts)
    if (kindOf(part) === 'disc') range = [range[0], range[1] + (part.scattered ?? Infinity)]
  // Fog that lies in shadow lacks what the shafts take of its own light.
  return parts.some(part => kindOf(part) === 'shade') ? [0, range[1]] : range
}
