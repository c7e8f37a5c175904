import { cloudPreset, cloudQualities } from '@welkin/clouds'
import { MathUtils } from 'three'
import type { CloudLayers, CloudQuality, CloudQualityName } from '@welkin/clouds'

const { clamp, lerp } = MathUtils

/** A weather of the valley: numbers that all blend. */
export interface Weather {
  /** Shares of the sky that cumulus, deck and cirrus cover. */
  readonly cumulus: number
  readonly deck: number
  readonly cirrus: number
  /** Altitude of the base of cumulus [m]: well below the deck. */
  readonly base: number
  /** Altitude of the base of the deck [m]. */
  readonly deckBase: number
  /** Aerosol of the air over that of clear air. */
  readonly turbidity: number
  /** Share of the mist, in [0, 1]: banks of fog over the lake. */
  readonly mist: number
  /** Rates of rain from cumulus, and of snow from the deck, as water [mm/h]. */
  readonly rain: number
  readonly snow: number
  /** Height of cumulus from its base [m], and flashes of lightning a minute. */
  readonly tall: number
  readonly flashes: number
  /** Extinction of the deck [1/m]; rain below it over that below cumulus, in [0, 1]. */
  readonly deckDensity: number
  readonly deckRain: number
  /** Brightness of pictures over what is metered, at most 0 [EV]: storms are dark, and so is land before a sun among clouds. */
  readonly exposure: number
}

const calm = {
  base: 1500,
  deckBase: 2700,
  tall: 1200,
  rain: 0,
  snow: 0,
  flashes: 0,
  deckDensity: 0.04,
  deckRain: 1,
  exposure: 0
}
/** Cumulus alone. */
const high = { ...calm, base: 1950 }
/** Cumulus and a deck over the summits: before them, clouds of the colour of those behind cut pieces out of the mountains. */
const highest = { ...calm, base: 2300, deckBase: 3500, tall: 1100 }

export const weathers = {
  fair: { cumulus: 0.38, deck: 0, cirrus: 0.35, turbidity: 2, mist: 0, ...high },
  clear: { cumulus: 0, deck: 0, cirrus: 0.08, turbidity: 1.5, mist: 0, ...high },
  broken: {
    cumulus: 0.4,
    deck: 0.55,
    cirrus: 0,
    turbidity: 2.5,
    mist: 0,
    ...highest,
    exposure: -0.3
  },
  mist: { cumulus: 0, deck: 0, cirrus: 0, turbidity: 3, mist: 1, ...calm, exposure: -0.15 },
  overcast: { cumulus: 0.15, deck: 1, cirrus: 0, turbidity: 4, mist: 0, ...calm },
  shower: {
    cumulus: 0,
    deck: 0.75,
    cirrus: 0,
    turbidity: 2.25,
    mist: 0,
    ...calm,
    rain: 6,
    exposure: -0.4
  },
  snow: {
    cumulus: 0,
    deck: 0.75,
    cirrus: 0,
    turbidity: 3,
    mist: 0,
    ...calm,
    snow: 1.5,
    exposure: -0.1
  },
  storm: {
    cumulus: 0.45,
    deck: 0.9,
    cirrus: 0,
    turbidity: 2.5,
    mist: 0,
    ...calm,
    rain: 5,
    tall: 6000,
    flashes: 4,
    deckDensity: 0.15,
    deckRain: 0.1,
    exposure: -1
  }
} satisfies Record<string, Weather>

export type WeatherName = keyof typeof weathers

/** Form of the deck. */
const deckForm = {
  baseAltitude: 2700,
  topAltitude: 3400,
  density: 0.04,
  weatherScale: 1,
  shapeScale: 1,
  detailAmount: 1,
  edgeSoftness: 0.3,
  wind: { east: 10, north: 4 }
}

/** Form of banks of fog that lie in the valley: height fog alone is a level sheet. */
const fogForm: typeof deckForm = {
  baseAltitude: 595,
  topAltitude: 690,
  density: 0.03,
  weatherScale: 0.3,
  shapeScale: 0.25,
  detailAmount: 0,
  edgeSoftness: 0.8,
  // What moves less than a fiftieth of a pixel in a frame is not filtered anew.
  wind: { east: 0.12, north: 0.03 }
}

/** Layers that `WeatherBlend` sets: cumulus, a deck over them or banks of fog, cirrus. */
export const valleyLayers = [
  {
    baseAltitude: 1500,
    topAltitude: 2700,
    coverage: 0,
    densityGrowth: 0.6, // bases are thin: dense ones are ruled before mountains
    wind: { east: 6, north: 2 }
  },
  {
    ...deckForm,
    coverage: 0,
    profileExponent: 1.2,
    weatherWeights: [0, 1, 0, 0] as [number, number, number, number]
  },
  { ...cloudPreset('cirrus').at(0).parameters, coverage: 0, wind: { east: 26, north: -8 } }
]

/** Most steps to the light, least depth of a step, and part of the steps through a layer. */
interface Steps {
  readonly light: number
  readonly depth: number
  readonly layer: number
}

/** Steps in banks of fog: they are soft, and have no bumps that shade each other. */
const FOG_STEPS: Steps = { light: 1, depth: 3, layer: 0.43 }

/** Steps in decks, and in what is below them. */
const DECK_STEPS: Steps = { light: 2, depth: 0.6, layer: 1 }

/** Height of cumulus from which it is a tower [m], and growth of steps in the tallest ones: much of what is in sight is cloud. */
const TOWERS = [1200, 6000] as const
const TOWER_GROWTH = 3.5

/** Share of a deck, or of banks of fog, from which all of these hold: with less, the march goes over to them. */
const WHOLE = 0.4

/** Rate of rain that counts as much as a rate of snow, over that [–]. */
const SNOW_AS_RAIN = 4

/** Rates below cumulus and below the deck over that around the camera, which stands between their cores [–]. */
const SHAFTS = [4, 2] as const
/** Altitude above which snow falls in summer [m]. */
const FREEZING = 2300

/** Time in which one weather becomes another [s]. */
const BLEND_SECONDS = 10

/** Blends from one weather to the next while the scene runs. */
export class WeatherBlend {
  #from: Weather
  #to: Weather
  #share = 1

  constructor(name: WeatherName) {
    this.#from = this.#to = weathers[name]
  }

  /** Goes to a weather over some seconds, or at once. */
  set(name: WeatherName, atOnce: boolean): void {
    if (weathers[name] === this.#to) return
    this.#from = this.current
    this.#to = weathers[name]
    this.#share = atOnce ? 1 : 0
  }

  get current(): Weather {
    const s = this.#share * this.#share * (3 - 2 * this.#share)
    const keys = Object.keys(this.#to) as (keyof Weather)[]
    const blend = keys.map(key => [key, this.#from[key] * (1 - s) + this.#to[key] * s])
    return Object.fromEntries(blend) as Weather
  }

  /** @returns True if the weather has changed. */
  update(seconds: number): boolean {
    if (this.#share === 1) return false
    this.#share = Math.min(this.#share + seconds / BLEND_SECONDS, 1)
    return true
  }

  /** Share of the banks of fog, in [0, 1]; 0 or less where there are none, or a deck in their place. */
  #fog(hasMist: boolean): number {
    const { mist, deck } = this.current
    return (hasMist ? mist : 0) - deck
  }

  /** Fineness of clouds in this weather, over that of others: it goes with decks and banks of fog as they come and go. */
  qualityOf(
    quality: CloudQualityName | CloudQuality,
    hasMist: boolean
  ): CloudQualityName | CloudQuality {
    const [fog, deck] = [this.#fog(hasMist), this.current.deck].map(t => clamp(t / WHOLE, 0, 1))
    const tower = clamp((this.current.tall - TOWERS[0]) / (TOWERS[1] - TOWERS[0]), 0, 1)
    if (fog === 0 && deck === 0 && tower === 0) return quality
    const fine = typeof quality === 'string' ? cloudQualities[quality] : quality
    const between = (own: number, inFog: number, underDeck: number): number =>
      lerp(lerp(own, inFog, fog), underDeck, deck)
    const least = ({ light }: Steps): number => Math.min(fine.lightSteps, light)
    const most = ({ depth }: Steps): number => Math.max(fine.depthStep, depth)
    const [ofFog, ofDeck] = [FOG_STEPS, DECK_STEPS]
    return {
      ...fine,
      lightSteps: Math.round(between(fine.lightSteps, least(ofFog), least(ofDeck))),
      depthStep: between(fine.depthStep, most(ofFog), most(ofDeck)),
      layerSteps: Math.round(fine.layerSteps * between(1, ofFog.layer, ofDeck.layer)),
      stepGrowth: fine.stepGrowth * lerp(1, TOWER_GROWTH, tower)
    }
  }

  /**
   * @param hasClouds - False for a sky without any.
   * @param hasMist - False for a valley without banks of fog.
   * @param shadow - False for clouds without shadows.
   * @param falls - False for clouds without rain and snow.
   */
  apply(
    layers: CloudLayers,
    hasClouds: boolean,
    hasMist: boolean,
    shadow: boolean,
    falls: boolean
  ): void {
    const { cumulus, cirrus, base, deckBase, deckDensity, deckRain, tall, rain, snow } =
      this.current
    const rates = [rain * SHAFTS[0], rain * deckRain * SHAFTS[1] + snow, 0]
    // The deck and banks of fog are one layer: one goes before the other comes.
    const foggy = this.#fog(hasMist)
    layers.at(0).set({ baseAltitude: base, topAltitude: base + tall })
    const rise = deckBase - deckForm.baseAltitude
    const [baseAltitude, topAltitude] = [deckBase, deckForm.topAltitude + rise]
    const deck = { ...deckForm, baseAltitude, topAltitude, density: deckDensity }
    layers.at(1).set(foggy > 0 ? fogForm : deck)
    const covers = [cumulus, Math.abs(foggy), cirrus]
    // Snow falls to the ground, rain melts high up; from one to the other the level goes with what falls.
    const freezingLevel = snow > 0 ? (FREEZING * rain) / (rain + SNOW_AS_RAIN * snow) : FREEZING
    for (const [i, coverage] of covers.entries()) {
      const rate = hasClouds && falls ? rates[i] : 0
      const precipitation = rate > 0 ? { rate, share: 0.8, freezingLevel } : null
      layers.at(i).set({ coverage: hasClouds ? coverage : 0, shadow, precipitation })
    }
  }
}
