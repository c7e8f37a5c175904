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
}

const kindOf = ({ name }: Part): Kind => features[name]

/**
 * Range under what passes an unknown part of the light, from none to all, and has light of its own: with nothing else it makes `value`
 * of `none`.
 */
const under = ([least, most]: Range, none: number, value: number): Range => [
  value + Math.min(0, least - none),
  value + Math.max(0, most - none)
]

const shift = ([least, most]: Range, by: number): Range => [least + by, most + by]

/** Several media that change a pixel: light of each is dimmed by the others, which have as much or more of their own, or as little. */
function underMedia(media: readonly Part[], none: number): Range | null {
  const values = media.map(({ value }) => value)
  if (values.every(value => value >= none)) return [Math.min(...values), Infinity]
  return values.every(value => value <= none) ? [0, Math.max(...values)] : null
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
    for (const { value } of of('disc'))
      range =
        range[0] === range[1] && range[0] === none ? [value, value] : under(range, none, value)
    for (const { value } of of('light')) range = shift(range, value - none)
    for (const { value } of of('corners', [...parts])) range = under(range, none, value)
    const isAsBefore = range[0] === none && range[1] === none
    for (const { value } of of('tiles')) {
      if (!isAsBefore) return null
      range = [value, value]
    }
    const shade = of('shade')
    // Shade takes light of the air alone.
    for (const { value } of shade) range = shift(range, value - none)
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
  for (const { value } of of('drops', [...parts])) range = under(range, none, value)
  return [Math.max(range[0], 0), range[1]]
}

function throughMedia(
  behind: Range,
  none: number,
  parts: readonly Part[],
  changing: readonly Part[]
): Range | null {
  const media = parts.filter(part => kindOf(part) === 'medium')
  const own = media.filter(part => changing.includes(part))
  let range: Range | null = behind
  if (own.length > 1) {
    if (behind[0] !== none || behind[1] !== none) return null
    range = underMedia(own, none)
  } else {
    for (const { value } of own) range = under(range, none, value)
    // In the dark a medium shows nothing of its own, and dims the others all the same.
    for (const each of media) if (!own.includes(each)) range = under(range, none, none)
  }
  if (range === null) return null
  // Media scatter the moon's light, and distance fog has the colour of the sky behind.
  const scatters = parts.some(
    part =>
      kindOf(part) === 'disc' ||
      (kindOf(part) === 'sky' && media.some(({ name }) => name === 'distanceFog'))
  )
  if (media.length > 0 && scatters) range = [range[0], Infinity]
  // Fog that lies in shadow lacks what the shafts take of its own light.
  const isShaded = media.length > 0 && parts.some(part => kindOf(part) === 'shade')
  return isShaded ? [0, range[1]] : range
}
