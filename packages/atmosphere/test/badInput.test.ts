import { Matrix4, PerspectiveCamera, Texture, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import {
  airglow,
  airlessBody,
  Atmosphere,
  AtmosphereParameters,
  DayCycle,
  distanceFog,
  exposureFor,
  exposureOfIlluminance,
  heightFog,
  marsAtmosphere,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  planetGround,
  proceduralStars,
  SkyLightProbe,
  standardAtmosphere,
  Stars,
  SunDirectionalLight,
  sunFlare
} from '@welkin/atmosphere'

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const luna = moon(atmosphere)
const cycle = new DayCycle(atmosphere, { date: new Date('2026-06-21T12:00:00Z') })
const fog = distanceFog()
const ground = planetGround()
const night = { stars: new Stars(proceduralStars({ count: 2 })), way: milkyWay(), glow: airglow() }
const flat = new Matrix4().set(
  ...(Array.from({ length: 16 }).fill(NaN) as Parameters<Matrix4['set']>)
)
const parameters = new AtmosphereParameters()

/** What the compiler would not let pass. */
const wrong = (value: unknown): never => value as never

const source = "must be a LightSource, such as a moon's source, got Moon"
const noOptions = 'options must be an object, got null'

const cases: [message: string, call: () => unknown][] = [
  // A moon is not its light.
  [`HeightFog: sources[0] ${source}`, () => heightFog({ sources: [wrong(luna)] })],
  ['HeightFog: sources must be an array, got null', () => heightFog({ sources: wrong(null) })],
  [
    `DayCycle: sources[0] ${source}`,
    () => new DayCycle(atmosphere, { exposure: { sources: [wrong(luna)] } })
  ],
  [
    `exposureFor: sources[0] ${source}`,
    () => exposureFor(atmosphere, camera, { sources: [wrong(luna)] })
  ],
  [`SkyLightProbe: source ${source}`, () => new SkyLightProbe(atmosphere, wrong(luna))],
  [
    `SunDirectionalLight: source ${source}`,
    () => new SunDirectionalLight(atmosphere, 1, wrong(luna))
  ],
  [
    'SunDirectionalLight: source must be a LightSource',
    () => new MoonDirectionalLight(atmosphere, wrong({ source: 1 }))
  ],

  // Exposure.
  [
    'DayCycle: floor must be positive and finite, got NaN',
    () => new DayCycle(atmosphere, { exposure: { floor: NaN } })
  ],
  [`DayCycle: ${noOptions}`, () => new DayCycle(atmosphere, { exposure: wrong(null) })],
  [
    'exposureFor: camera must be a Camera, got undefined',
    () => exposureFor(atmosphere, wrong(undefined))
  ],
  ['exposureFor: atmosphere must be an Atmosphere', () => exposureFor(wrong(undefined), camera)],
  ['illuminance must be finite and ≥ 0, got NaN', () => exposureOfIlluminance(NaN)],
  ['illuminance must be finite and ≥ 0, got -1', () => exposureOfIlluminance(-1)],
  ['illuminance must be finite and ≥ 0, got Infinity', () => exposureOfIlluminance(Infinity)],

  // Textures and rotations.
  [
    'PlanetGround: surface must be a Texture or null, got earth.jpg',
    () => planetGround({ surface: wrong('earth.jpg') })
  ],
  ['PlanetGround: water must be a Texture', () => planetGround({ water: wrong({}) })],
  ['PlanetGround: nightLights must be a Texture', () => planetGround({ nightLights: wrong(1) })],
  ['Stars: orientation must be a Matrix4', () => new Stars([], { orientation: wrong('north') })],
  ['Stars: orientation must be a Matrix4', () => (night.stars.orientation = wrong(undefined))],
  ['MilkyWay: orientation must be a Matrix4', () => milkyWay({ orientation: flat })],

  // Setters.
  ['Stars: intensity must be finite and ≥ 0, got NaN', () => (night.stars.intensity = NaN)],
  ['MilkyWay: intensity must be finite and ≥ 0, got -1', () => (night.way.intensity = -1)],
  [
    'Airglow: intensity must be finite and ≥ 0, got null',
    () => (night.glow.intensity = wrong(null))
  ],
  ['DistanceFog: density must be in [0, 100], got NaN', () => (fog.density = NaN)],
  ['PlanetGround: windSpeed must be in [0, 40], got 41', () => (ground.windSpeed = 41)],
  ['PlanetGround: nightLuminance must be in', () => (ground.nightLuminance = NaN)],
  ['PlanetGround: roughness must be in [0, 1.5], got 2', () => (ground.roughness = 2)],
  ['DayCycle: time must be a date in milliseconds, got null', () => (cycle.time = wrong(null))],
  ['DayCycle: hour must be in [0, 24), got null', () => (cycle.hour = wrong(null))],
  ['DayCycle: latitude must be in [-90, 90], got NaN', () => (cycle.latitude = NaN)],
  ['DayCycle: daylight must be in (0, 1), got 0.5', () => (cycle.daylight = wrong('0.5'))],

  // Null and [] are no numbers.
  ['HeightFog: density must be in [0, 100], got null', () => heightFog({ density: wrong(null) })],
  ['HeightFog: density must be in [0, 100], got []', () => heightFog({ density: wrong([]) })],
  [
    'HeightFog: albedo[1] must be in [0, 1], got null',
    () => heightFog({ albedo: [1, wrong(null), 1, 1] })
  ],
  ['DistanceFog: density must be in [0, 100], got []', () => distanceFog({ density: wrong([]) })],
  ['Airglow: luminance must be in', () => airglow({ luminance: wrong(null) })],
  ['PlanetGround: roughness must be in', () => planetGround({ roughness: wrong(null) })],
  ['NightLightProbe: illuminance must', () => new NightLightProbe(atmosphere, wrong(null))],
  ['Moon: strength must be finite', () => (luna.strength = wrong(null))],
  ['Moon: phase must be in [0, 1], got []', () => moon(atmosphere, { phase: wrong([]) })],
  ['SunFlare: innerStrength must be', () => sunFlare(atmosphere, { innerStrength: wrong(null) })],
  ['Atmosphere: elevation must be in', () => atmosphere.setSunAngles(wrong(null), 0)],
  [
    'standardAtmosphere: aerosolOpticalDepth must',
    () => standardAtmosphere({ aerosolOpticalDepth: wrong(null) })
  ],
  [
    'marsAtmosphere: dust must be in [0, 10], got null',
    () => marsAtmosphere({ dust: wrong(null) })
  ],
  ['airlessBody: distance must be in', () => airlessBody({ distance: wrong([]) })],
  ['proceduralStars: faintest must be in', () => proceduralStars({ faintest: wrong(null) })],
  [
    'Atmosphere: sunDirection must have finite components',
    () => (atmosphere.sunDirection = new Vector3(wrong(null), 1, 0))
  ],

  // Of another kind.
  ['Moon: direction must be a Vector3', () => moon(atmosphere, { direction: wrong([0, 1, 0]) })],
  ['Moon: direction must be a Vector3', () => (luna.direction = wrong(undefined))],
  [
    'DayCycle: date must be a Date, got 2026',
    () => new DayCycle(atmosphere, { date: wrong('2026') })
  ],
  ['Stars: catalogue must be an array of stars, got undefined', () => new Stars(wrong(undefined))],
  ['Stars: ascension of star 0 must be finite, got undefined', () => new Stars([wrong({})])],
  ['Stars: ascension of star 0 must be finite, got undefined', () => new Stars([wrong(null)])],
  [
    'HeightFog: albedo must be an array of 4 values, got null',
    () => heightFog({ albedo: wrong(null) })
  ],
  [
    'HeightFog: fade must be an array of 2 altitudes, got null',
    () => heightFog({ fade: wrong(null) })
  ],
  [
    'DistanceFog: fade must be an array of 2 altitudes, got null',
    () => distanceFog({ fade: wrong(null) })
  ],
  ['DistanceFog: fade[1] must be in', () => distanceFog({ fade: [0, NaN] })],

  // No such option.
  [
    'SunFlare: options must be innerPower, innerStrength, outerPower, outerStrength, got typo',
    () => sunFlare(atmosphere, wrong({ typo: 1 }))
  ],
  [
    'Moon: options must be innerPower, innerStrength, outerPower, outerStrength, got inerPower',
    () => moon(atmosphere, { flare: wrong({ inerPower: 3 }) })
  ],
  [
    'AtmosphereParameters: options must be turbidity, ozone, got tubidity',
    () => AtmosphereParameters.earth(wrong({ tubidity: 3 }))
  ],
  [
    'standardAtmosphere: options must be aerosolOpticalDepth, ozone, got ozon',
    () => standardAtmosphere(wrong({ ozon: 300 }))
  ],
  ['marsAtmosphere: options must be dust, got dist', () => marsAtmosphere(wrong({ dist: 1 }))],

  // Null is no options.
  [`Atmosphere: ${noOptions}`, () => new Atmosphere(wrong(null))],
  [`AtmosphereParameters: ${noOptions}`, () => new AtmosphereParameters(wrong(null))],
  [`AtmosphereParameters: ${noOptions}`, () => parameters.set(wrong(null))],
  [`AtmosphereParameters: ${noOptions}`, () => AtmosphereParameters.earth(wrong(null))],
  [`DayCycle: ${noOptions}`, () => new DayCycle(atmosphere, wrong(null))],
  [`exposureFor: ${noOptions}`, () => exposureFor(atmosphere, camera, wrong(null))],
  [`HeightFog: ${noOptions}`, () => heightFog(wrong(null))],
  [`HeightFog: ${noOptions}`, () => heightFog().set(wrong(null))],
  [`DistanceFog: ${noOptions}`, () => distanceFog(wrong(null))],
  [`PlanetGround: ${noOptions}`, () => planetGround(wrong(null))],
  [`Stars: ${noOptions}`, () => new Stars([], wrong(null))],
  [`MilkyWay: ${noOptions}`, () => milkyWay(wrong(null))],
  [`Airglow: ${noOptions}`, () => airglow(wrong(null))],
  [`Moon: ${noOptions}`, () => moon(atmosphere, wrong(null))],
  [`Moon: ${noOptions}`, () => moon(atmosphere, { flare: wrong(null) })],
  [`SunFlare: ${noOptions}`, () => sunFlare(atmosphere, wrong(null))],
  [`standardAtmosphere: ${noOptions}`, () => standardAtmosphere(wrong(null))],
  [`marsAtmosphere: ${noOptions}`, () => marsAtmosphere(wrong(null))],
  [`airlessBody: ${noOptions}`, () => airlessBody(wrong(null))],
  [`proceduralStars: ${noOptions}`, () => proceduralStars(wrong(null))]
]

describe('wrong use throws with name and value', () => {
  it.each(cases)('%s', (message, call) => {
    expect(call).toThrow(message)
  })
})

/** All of these options, undefined. */
const none = (...names: string[]): object =>
  Object.fromEntries(names.map(name => [name, undefined]))

describe('undefined is the default', () => {
  it('of fog', () => {
    const names = Object.keys(heightFog().options)
    expect(heightFog(none(...names)).options).toEqual(heightFog().options)
    expect(heightFog({ density: 2 }).set({ density: undefined }).options.density).toBe(2)
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
    expect(Object.keys(init)).toHaveLength(18)
    expect(new AtmosphereParameters(init)).toEqual(parameters)
    const hazy = AtmosphereParameters.earth({ turbidity: 5 })
    const { mieExtinction } = hazy
    expect(hazy.set({ mieExtinction: undefined }).mieExtinction).toEqual(mieExtinction)
    expect(AtmosphereParameters.earth(none('turbidity', 'ozone'))).toEqual(parameters)
    const options = none('aerosolOpticalDepth', 'ozone')
    expect(standardAtmosphere(options)).toEqual(standardAtmosphere())
  })

  it('of everything else', () => {
    expect(() => new Atmosphere(none('parameters', 'ellipsoid', 'flat'))).not.toThrow()
    const names = ['direction', 'phase', 'distance', 'radius', 'strength', 'lightsAir', 'mapSize']
    expect(() => moon(atmosphere, none('flare', ...names))).not.toThrow()
    expect(() => sunFlare(atmosphere, none('innerPower', 'outerStrength'))).not.toThrow()
    const rates = none('date', 'rate', 'daylight', 'holdDay', 'adaptation', 'exposure')
    const { rate, holdDay, exposureOptions } = new DayCycle(atmosphere, rates)
    expect([rate, holdDay, exposureOptions]).toEqual([1440, false, {}])
    expect(new Stars([], none('overlay', 'orientation')).orientation).toBe(null)
    expect(milkyWay(none('orientation')).orientation).toBe(null)
    expect(airglow(none('luminance', 'altitude', 'width', 'spectrum')).luminance).toBe(1e-4)
  })
})

it('ground tells its numbers and takes textures', () => {
  const made = planetGround({ surface: new Texture(), water: null })
  made.windSpeed = 12
  made.nightLuminance = 3
  made.roughness = 0
  expect([made.windSpeed, made.nightLuminance, made.roughness]).toEqual([12, 3, 0])
  // Those of another one stay.
  expect([planetGround().windSpeed, planetGround().roughness]).toEqual([7, 0.35])
})
