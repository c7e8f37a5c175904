import { PerspectiveCamera, Texture, Vector3 } from 'three'
import { texture } from 'three/tsl'
import { describe, expect, it } from 'vitest'
import {
  aerialPerspective,
  airglow,
  airlessParameters,
  airStyle,
  Atmosphere,
  AtmosphereParameters,
  AtmosphereShell,
  autoExposure,
  DayCycle,
  distanceFog,
  exposureFor,
  heightFog,
  type HeightFog,
  imageEnvironment,
  marsParameters,
  milkyWay,
  moon,
  moonIlluminanceAt,
  planetGround,
  proceduralStars,
  skyBackground,
  skyEnvironment,
  skyIlluminanceAt,
  skyLuminanceAt,
  solveDiffuseLight,
  standardEarthParameters,
  Stars,
  stars,
  sunFlare,
  sunIlluminanceAt,
  surfaceLighting
} from '@welkin/atmosphere'

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const zero = new Vector3()
const picture = texture(new Texture())
const luna = moon().attach(atmosphere)
const parameters = new AtmosphereParameters()

/** Value of a type that the compiler would not let pass. */
const wrong = (value: unknown): never => value as never

const noOptions = 'options must be an object such as {'

const cases: [message: string, call: () => unknown][] = [
  // No such option.
  ["Moon: unknown option 'mapSize', there are", () => luna.set(wrong({ mapSize: 16 }))],
  [
    "SunFlare: unknown option 'typo', there are innerPower, innerStrength, outerPower, outerStrength",
    () => sunFlare(wrong({ typo: 1 }))
  ],
  [
    "Moon: unknown option 'inerPower', did you mean 'innerPower'?",
    () => moon({ flare: wrong({ inerPower: 3 }) })
  ],
  [
    "SurfaceLightingNode: unknown option 'strenght', did you mean 'strength'?",
    () => surfaceLighting(picture, picture, camera, [], wrong({ strenght: 1 }))
  ],
  [
    "AtmosphereParameters: unknown option 'tubidity', did you mean 'turbidity'?",
    () => new AtmosphereParameters(wrong({ tubidity: 3 }))
  ],
  [
    "standardEarthParameters: unknown option 'ozon', did you mean 'ozone'?",
    () => standardEarthParameters(wrong({ ozon: 300 }))
  ],
  [
    "marsParameters: unknown option 'dist', did you mean 'dust'?",
    () => marsParameters(wrong({ dist: 1 }))
  ],

  ...(
    [
      ['Atmosphere', 'paramaters', 'parameters', o => new Atmosphere(o)],
      ['AtmosphereParameters', 'mieScatering', 'mieScattering', o => new AtmosphereParameters(o)],
      ['AtmosphereParameters', 'groundAlbdo', 'groundAlbedo', o => parameters.set(o)],
      ['AtmosphereParameters', 'ozon', 'ozone', o => parameters.set(o)],
      ['airlessParameters', 'raduis', 'radius', o => airlessParameters(o)],
      ['AirStyle', 'hase', 'haze', o => airStyle(o)],
      ['DayCycle', 'rat', 'rate', o => new DayCycle(atmosphere, o)],
      ['DayCycle', 'flor', 'floor', o => new DayCycle(atmosphere, { exposureOptions: o })],
      ['exposureFor', 'source', 'sources', o => exposureFor(atmosphere, camera, o)],
      ['skyIlluminanceAt', 'cloud', 'clouds', o => skyIlluminanceAt(atmosphere, zero, zero, o)],
      ['sunIlluminanceAt', 'cloud', 'clouds', o => sunIlluminanceAt(atmosphere, zero, o)],
      ['moonIlluminanceAt', 'cloud', 'clouds', o => moonIlluminanceAt(luna, zero, o)],
      ['skyLuminanceAt', 'sorce', 'source', o => skyLuminanceAt(atmosphere, zero, zero, o)],
      ['AutoExposureNode', 'limit', 'limits', o => autoExposure(picture, atmosphere, o)],
      ['solveDiffuseLight', 'order', 'orders', o => solveDiffuseLight(parameters, o)],
      ['HeightFog', 'densty', 'density', o => heightFog(o)],
      ['HeightFog', 'densty', 'density', o => heightFog().set(o)],
      ['DistanceFog', 'Density', 'density', o => distanceFog(o)],
      ['PlanetGround', 'surfce', 'surface', o => planetGround(o)],
      ['Stars', 'overlays', 'overlay', o => new Stars(o)],
      ['Stars', 'orientatoin', 'orientation', o => stars(o)],
      ['proceduralStars', 'cuont', 'count', o => proceduralStars(o)],
      ['MilkyWay', 'orientaton', 'orientation', o => milkyWay(o)],
      ['Airglow', 'luminence', 'luminance', o => airglow(o)],
      ['Moon', 'fase', 'phase', o => moon(o)],
      ['SkyBackgroundNode', 'showsun', 'showSun', o => skyBackground(atmosphere, o)],
      [
        'AerialPerspectiveNode',
        'showSki',
        'showSky',
        o => aerialPerspective(picture, picture, camera, atmosphere, o)
      ],
      ['SkyEnvironmentNode', 'sise', 'size', o => skyEnvironment(atmosphere, o)],
      ['ImageEnvironmentNode', 'difuse', 'diffuse', o => imageEnvironment(new Texture(), o)],
      ['AtmosphereShell', 'modle', 'model', o => new AtmosphereShell(parameters, 1, o)]
    ] satisfies [string, string, string, (options: never) => unknown][]
  ).map(
    ([where, misspelt, right, call]) =>
      [
        `${where}: unknown option '${misspelt}', did you mean '${right}'?`,
        () => call(wrong({ [misspelt]: 1 }))
      ] as [string, () => unknown]
  ),
  [
    "Atmosphere: unknown option 'ocean', there are parameters, tables, ellipsoid, flat, frame",
    () => new Atmosphere(wrong({ ocean: 1 }))
  ],

  // Null is no options.
  [`Atmosphere: ${noOptions}`, () => new Atmosphere(wrong(null))],
  [`AtmosphereParameters: ${noOptions}`, () => new AtmosphereParameters(wrong(null))],
  [`AtmosphereParameters: ${noOptions}`, () => parameters.set(wrong(null))],
  [`AtmosphereParameters: ${noOptions}`, () => new AtmosphereParameters(wrong(null))],
  [`DayCycle: ${noOptions}`, () => new DayCycle(atmosphere, wrong(null))],
  [`exposureFor: ${noOptions}`, () => exposureFor(atmosphere, camera, wrong(null))],
  [`AutoExposureNode: ${noOptions}`, () => autoExposure(picture, atmosphere, wrong(null))],
  [`HeightFog: ${noOptions}`, () => heightFog(wrong(null))],
  [`HeightFog: ${noOptions}`, () => heightFog().set(wrong(null))],
  [`DistanceFog: ${noOptions}`, () => distanceFog(wrong(null))],
  [`PlanetGround: ${noOptions}`, () => planetGround(wrong(null))],
  [`Stars: ${noOptions}`, () => new Stars(wrong(null))],
  [`Stars: ${noOptions}`, () => stars(wrong(null))],
  [`MilkyWay: ${noOptions}`, () => milkyWay(wrong(null))],
  [`Airglow: ${noOptions}`, () => airglow(wrong(null))],
  [`Moon: ${noOptions}`, () => moon(wrong(null))],
  [`Moon: ${noOptions}`, () => moon({ flare: wrong(null) })],
  [`SunFlare: ${noOptions}`, () => sunFlare(wrong(null))],
  [`standardEarthParameters: ${noOptions}`, () => standardEarthParameters(wrong(null))],
  [`marsParameters: ${noOptions}`, () => marsParameters(wrong(null))],
  [`airlessParameters: ${noOptions}`, () => airlessParameters(wrong(null))],
  [`proceduralStars: ${noOptions}`, () => proceduralStars(wrong(null))]
]

describe('options are an object of known names', () => {
  it.each(cases)('%s', (message, call) => {
    expect(call).toThrow(message)
  })
})

/** All of these options, undefined. */
const none = (...names: string[]): object =>
  Object.fromEntries(names.map(name => [name, undefined]))

describe('undefined is the default', () => {
  it('of fog', () => {
    const names = ['density', 'falloff', 'base', 'albedo', 'asymmetry', 'fade'] as const
    const values = (fog: HeightFog) => names.map(name => fog[name])
    expect(values(heightFog(none(...names, 'sources')))).toEqual(values(heightFog()))
    expect(heightFog({ density: 2 }).set({ density: undefined }).density).toBe(2)
    const { density, fade } = distanceFog(none('density', 'fade'))
    expect([density, fade]).toEqual([1e-4, [5000, 15_000]])
  })

  it('of ground', () => {
    const names = ['surface', 'water', 'nightLights', 'nightLuminance', 'roughness', 'windSpeed']
    const { nightLuminance, roughness, windSpeed } = planetGround(none(...names, 'seed'))
    expect([nightLuminance, roughness, windSpeed]).toEqual([2, 0.35, 7])
  })

  it('of parameters', () => {
    const init = none(...Object.keys(parameters))
    expect(Object.keys(init)).toHaveLength(19)
    expect(new AtmosphereParameters(init)).toEqual(parameters)
    const hazy = new AtmosphereParameters({ turbidity: 5 })
    const { mieExtinction } = hazy
    expect(hazy.set({ mieExtinction: undefined }).mieExtinction).toEqual(mieExtinction)
    expect(new AtmosphereParameters(none('turbidity', 'ozone'))).toEqual(parameters)
    const options = none('aerosolOpticalDepth', 'ozone')
    expect(standardEarthParameters(options)).toEqual(standardEarthParameters())
  })

  it('of everything else', () => {
    expect(() => new Atmosphere(none('parameters', 'ellipsoid', 'flat'))).not.toThrow()
    const names = ['direction', 'phase', 'distance', 'radius', 'strength', 'earthshine']
    expect(() => moon(none('flare', 'lightsAir', 'mapSize', ...names))).not.toThrow()
    expect(airStyle(none('haze', 'twilightSaturation')).haze).toBe(1)
    expect(() => sunFlare(none('innerPower', 'outerStrength'))).not.toThrow()
    const rates = none('date', 'rate', 'daylight', 'holdDay', 'adaptation', 'exposureOptions')
    const { rate, holdDay, exposureOptions } = new DayCycle(atmosphere, rates)
    expect([rate, holdDay, exposureOptions]).toEqual([1440, false, {}])
    expect(
      new Stars({ catalogue: [], ...none('overlay', 'orientation', 'intensity') }).orientation
    ).toBe(null)
    expect(milkyWay(none('orientation')).orientation).toBe(null)
    expect(airglow(none('luminance', 'altitude', 'width', 'spectrum')).luminance).toBe(1e-4)
  })
})
