import { Matrix4, Mesh, PerspectiveCamera, Scene, Texture, Vector3 } from 'three'
import { texture, vec4 } from 'three/tsl'
import { describe, expect, it } from 'vitest'
import {
  aerialPerspective,
  aerialPerspectiveFog,
  airglow,
  airlessParameters,
  airStyle,
  Atmosphere,
  AtmosphereParameters,
  AtmosphereShell,
  autoExposure,
  type AutoExposureOptions,
  DayCycle,
  distanceFog,
  exposureFor,
  exposureOfIlluminance,
  heightFog,
  imageEnvironment,
  marsParameters,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  planetGround,
  proceduralStars,
  skyBackground,
  skyEnvironment,
  SkyLightProbe,
  moonIlluminanceAt,
  skyIlluminanceAt,
  skyLuminanceAt,
  solveDiffuseLight,
  sunIlluminanceAt,
  standardEarthParameters,
  Stars,
  starsOverlay,
  SunDirectionalLight,
  sunFlare,
  surfaceLighting,
  type SurfaceLightingOptions
} from '@welkin/atmosphere'

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const luna = moon().attach(atmosphere)
const picture = texture(new Texture())
const metered = autoExposure(picture, atmosphere)
const cycle = new DayCycle(atmosphere, { date: new Date('2026-06-21T12:00:00Z') })
const fog = distanceFog()
const ground = planetGround()
const night = {
  stars: new Stars({ catalogue: proceduralStars({ count: 2 }) }),
  way: milkyWay(),
  glow: airglow()
}
const flat = new Matrix4().set(
  ...(Array.from({ length: 16 }).fill(NaN) as Parameters<Matrix4['set']>)
)
const parameters = new AtmosphereParameters()
const zero = new Vector3()

/** Value of a type that the compiler would not let pass. */
const wrong = (value: unknown): never => value as never

const source = "must be a LightSource, such as a moon's source, got a Moon"
const noOptions = 'options must be an object such as {'

const cases: [message: string, call: () => unknown][] = [
  // A moon is not its light.
  [`HeightFog: sources[0] ${source}`, () => heightFog({ sources: [wrong(luna)] })],
  ['HeightFog: sources must be an array, got null', () => heightFog({ sources: wrong(null) })],
  [
    `DayCycle: sources[0] ${source}`,
    () => new DayCycle(atmosphere, { exposureOptions: { sources: [wrong(luna)] } })
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
    'MoonDirectionalLight: moon must be a Moon, got { source: 1 }',
    () => new MoonDirectionalLight(atmosphere, wrong({ source: 1 }))
  ],

  // Exposure.
  [
    'DayCycle: floor must be positive and finite, got NaN',
    () => new DayCycle(atmosphere, { exposureOptions: { floor: NaN } })
  ],
  [`DayCycle: ${noOptions}`, () => new DayCycle(atmosphere, { exposureOptions: wrong(null) })],
  [
    'exposureFor: camera must be a Camera, got undefined',
    () => exposureFor(atmosphere, wrong(undefined))
  ],
  [
    'exposureFor: clouds must be a CloudCover of @welkin/clouds, or null, got 0.5',
    () => exposureFor(atmosphere, camera, { clouds: wrong(0.5) })
  ],
  [
    'skyIlluminanceAt: clouds must be a CloudCover',
    () => skyIlluminanceAt(atmosphere, zero, zero, { clouds: wrong({}) })
  ],
  [
    'skyIlluminanceAt: source must be a LightSource',
    () => skyIlluminanceAt(atmosphere, zero, zero, { source: wrong(luna) })
  ],
  [
    'skyIlluminanceAt: options must be an object such as { source }, got a LightSource',
    () => skyIlluminanceAt(atmosphere, zero, zero, wrong(luna.source))
  ],
  ['exposureFor: atmosphere must be an Atmosphere', () => exposureFor(wrong(undefined), camera)],
  ['illuminance must be finite and ≥ 0, got NaN', () => exposureOfIlluminance(NaN)],
  ['illuminance must be finite and ≥ 0, got -1', () => exposureOfIlluminance(-1)],
  ['illuminance must be finite and ≥ 0, got Infinity', () => exposureOfIlluminance(Infinity)],

  [
    'DayCycle: autoExposure must be an autoExposure() of its atmosphere, got 1',
    () => new DayCycle(atmosphere, { autoExposure: wrong(1) })
  ],
  [
    'DayCycle: autoExposure must be an autoExposure() of its atmosphere',
    () => new DayCycle(new Atmosphere(), { autoExposure: metered })
  ],
  [
    'AutoExposureNode: colorNode must be a node, got undefined',
    () => autoExposure(wrong(undefined), atmosphere)
  ],
  [
    'AutoExposureNode: atmosphere must be an Atmosphere',
    () => autoExposure(picture, wrong(undefined))
  ],
  ...(
    [
      [{ compensation: NaN }, 'compensation must be a finite number, got NaN'],
      [{ limits: [0, 1] }, 'limits[0] must be in [1e-9, 1000000000000], got 0'],
      [{ limits: wrong(1) }, 'limits must be an array of 2 numbers, got 1'],
      [{ percentiles: [0.6, 0.4] }, 'percentiles must rise, got [0.6, 0.4]'],
      [{ percentiles: [0, 1.1] }, 'percentiles[1] must be in [0, 1], got 1.1'],
      [{ centerWeight: -1 }, 'centerWeight must be in [0, 1], got -1'],
      [{ lightSeconds: -1 }, 'lightSeconds must be finite and ≥ 0, got -1'],
      [{ darkSeconds: Infinity }, 'darkSeconds must be finite and ≥ 0, got Infinity'],
      [{ darkNights: wrong(1) }, 'darkNights must be true or false, got 1']
    ] satisfies [AutoExposureOptions, string][]
  ).map(
    ([options, message]) =>
      [`AutoExposureNode: ${message}`, () => autoExposure(picture, atmosphere, options)] as [
        string,
        () => unknown
      ]
  ),
  [
    'AutoExposureNode.adapt: deltaSeconds must be finite and ≥ 0, got NaN',
    () => metered.adapt(NaN)
  ],

  // Lights of unlit surfaces.
  [
    'SurfaceLightingNode: colorNode must be a node, got undefined',
    () => surfaceLighting(wrong(undefined), picture, camera, [])
  ],
  [
    "SurfaceLightingNode: depthNode must be a texture's node, got null",
    () => surfaceLighting(picture, wrong(null), camera, [])
  ],
  [
    'SurfaceLightingNode: camera must be a Camera',
    () => surfaceLighting(picture, picture, wrong(atmosphere), [])
  ],
  [
    'SurfaceLightingNode: lights must be an array of Lights',
    () => surfaceLighting(picture, picture, camera, wrong(atmosphere))
  ],
  [
    'SurfaceLightingNode: lights[0] must be a Light',
    () => surfaceLighting(picture, picture, camera, [wrong(camera)])
  ],
  ...(
    [
      [{ strength: 1.5 }, 'strength must be in [0, 1], got 1.5'],
      [{ albedo: -1 }, 'albedo must be finite and ≥ 0, got -1'],
      [{ normal: wrong(1) }, 'normal must be a node, got 1'],
      [{ mask: wrong('x') }, "mask must be a node, got 'x'"]
    ] satisfies [SurfaceLightingOptions, string][]
  ).map(
    ([options, message]) =>
      [
        `SurfaceLightingNode: ${message}`,
        () => surfaceLighting(picture, picture, camera, [], options)
      ] as [string, () => unknown]
  ),

  // Textures and rotations.
  [
    "PlanetGround: surface must be a Texture or null, got 'earth.jpg'",
    () => planetGround({ surface: wrong('earth.jpg') })
  ],
  ['PlanetGround: water must be a Texture', () => planetGround({ water: wrong({}) })],
  ['PlanetGround: nightLights must be a Texture', () => planetGround({ nightLights: wrong(1) })],
  [
    'Stars: orientation must be a Matrix4',
    () => new Stars({ catalogue: [], orientation: wrong('north') })
  ],
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
  ["DayCycle: daylight must be in (0, 1), got '0.5'", () => (cycle.daylight = wrong('0.5'))],
  ['DayCycle: paused must be true or false, got 1', () => (cycle.paused = wrong(1))],
  ["DayCycle: holdDay must be true or false, got 'no'", () => (cycle.holdDay = wrong('no'))],
  [
    'DayCycle: holdDay must be true or false, got null',
    () => new DayCycle(atmosphere, { holdDay: wrong(null) })
  ],
  ["DayCycle: unknown option 'hour', there are rate,", () => cycle.set(wrong({ hour: 3 }))],

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
  ['Moon: earthshine must be finite', () => (luna.earthshine = wrong(null))],
  ['AirStyle: haze must be finite', () => airStyle({ haze: -1 })],
  [
    'AirStyle: twilightSaturation must be finite',
    () => airStyle({ twilightSaturation: wrong(null) })
  ],
  ['Moon: phase must be in [0, 1], got []', () => moon({ phase: wrong([]) })],
  ['SunFlare: innerStrength must be', () => sunFlare({ innerStrength: wrong(null) })],
  ['Atmosphere.setSunAngles: elevation must be in', () => atmosphere.setSunAngles(wrong(null), 0)],
  [
    'standardEarthParameters: aerosolOpticalDepth must',
    () => standardEarthParameters({ aerosolOpticalDepth: wrong(null) })
  ],
  [
    'marsParameters: dust must be in [0, 10], got null',
    () => marsParameters({ dust: wrong(null) })
  ],
  ['airlessParameters: distance must be in', () => airlessParameters({ distance: wrong([]) })],
  ['proceduralStars: faintest must be in', () => proceduralStars({ faintest: wrong(null) })],
  [
    'Atmosphere: sunDirection must have finite components, got (null, 1, 0)',
    () => (atmosphere.sunDirection = new Vector3(wrong(null), 1, 0))
  ],

  // Of another kind.
  ['Moon: direction must be a Vector3', () => moon({ direction: wrong([0, 1, 0]) })],
  ['Moon: direction must be a Vector3', () => (luna.direction = wrong(undefined))],
  [
    "DayCycle: date must be a valid Date, got '2026'",
    () => new DayCycle(atmosphere, { date: wrong('2026') })
  ],
  ['Stars: catalogue must be an array of stars, got undefined', () => new Stars(wrong({}))],
  [
    'Stars: ascension of star 0 must be finite, got undefined',
    () => new Stars({ catalogue: [wrong({})] })
  ],
  [
    'Stars: ascension of star 0 must be finite, got undefined',
    () => new Stars({ catalogue: [wrong(null)] })
  ],
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

  // One thing for another.
  [
    'Atmosphere: options must be an object such as { parameters }, got an AtmosphereParameters',
    () => new Atmosphere(wrong(marsParameters()))
  ],
  [
    'AtmosphereParameters: turbidity must not be given together with mieExtinction',
    () => parameters.set({ turbidity: 2, mieExtinction: [0, 0, 0, 0] })
  ],
  [
    "Cannot assign to read only property 'groundAlbedo'",
    () => Object.assign(parameters, { groundAlbedo: [0, 0, 0, 0] })
  ],
  [
    'AtmosphereParameters: ellipsoid must be an Ellipsoid, got 6378137',
    () => new AtmosphereParameters({ ellipsoid: wrong(6_378_137) })
  ],
  ['airlessParameters: radius must be positive', () => airlessParameters({ radius: wrong('1') })],
  ['Moon: outerPower must be positive and finite, got 0', () => (luna.flare.outerPower = 0)],
  ['SunFlare: innerStrength must be finite and ≥ 0', () => (sunFlare().innerStrength = -1)],
  [
    'Atmosphere: parameters must be AtmosphereParameters, got { dust: 1 }',
    () => new Atmosphere({ parameters: wrong({ dust: 1 }) })
  ],
  [
    'Atmosphere: ellipsoid must be an Ellipsoid, got 6378137',
    () => new Atmosphere({ ellipsoid: wrong(6_378_137) })
  ],
  [
    "Atmosphere: flat must be true or false, got 'yes'",
    () => new Atmosphere({ flat: wrong('yes') })
  ],
  [
    "Atmosphere: frame must be 'local' or 'ecef', got 'ECEF'",
    () => new Atmosphere({ frame: wrong('ECEF') })
  ],
  [
    "Atmosphere.place: geodetic must be { longitude, latitude, height } [degrees, metres], got '35'",
    () => atmosphere.place(wrong('35'))
  ],
  [
    "Atmosphere.place: longitude must be a finite number, got '139'",
    () => atmosphere.place(wrong({ longitude: '139', latitude: 35 }))
  ],
  [
    "Atmosphere.place: unknown option 'lattitude', did you mean 'latitude'?",
    () => atmosphere.place(wrong({ longitude: 139, lattitude: 35 }))
  ],
  [
    'Atmosphere: sunDirection must be a Vector3, got [0, 1, 0]',
    () => (atmosphere.sunDirection = wrong([0, 1, 0]))
  ],
  [
    'Atmosphere.add: layer must be a SkyLayer, such as moon() or heightFog(), got a Mesh',
    () => atmosphere.add(wrong(new Mesh()))
  ],
  [
    'Atmosphere.add: layer must be a SkyLayer, such as moon() or heightFog(), got [undefined]',
    () => atmosphere.add(wrong([undefined]))
  ],
  [
    'Atmosphere.add: layer must not be in the sky already, got a MilkyWay',
    () => new Atmosphere().add(night.way, night.way)
  ],
  [
    'Atmosphere.add: layer must not be in the sky already, got an Airglow',
    () => new Atmosphere().add(night.glow).add(night.way, night.glow)
  ],
  [
    'SkyEnvironmentNode: atmosphere must be an Atmosphere, got a Texture',
    () => skyEnvironment(wrong(new Texture()))
  ],
  [
    'ImageEnvironmentNode: image must be a Texture, got an Atmosphere',
    () => imageEnvironment(wrong(atmosphere))
  ],
  [
    'SkyEnvironmentNode: overlay must be a SkyOverlay, such as cloudEnvironment(), or null, got a Mesh',
    () => skyEnvironment(atmosphere, { overlay: wrong(new Mesh()) })
  ],
  [
    'SkyEnvironmentNode: angle must be positive and finite, got 0',
    () => (skyEnvironment(atmosphere).angle = 0)
  ],
  [
    'skyBackground: set it as scene.backgroundNode, not as scene.background',
    () => skyBackground(atmosphere).isCubeTexture
  ],
  [
    'aerialPerspectiveFog: set it as scene.fogNode, not as scene.fog',
    () => aerialPerspectiveFog(atmosphere).isFogExp2
  ],
  [
    'AerialPerspectiveNode: colorNode must be a node, got a Scene',
    () => aerialPerspective(wrong(new Scene()), vec4(1), camera, atmosphere)
  ],
  [
    'StarsOverlayNode: depthNode must be a node, got a PerspectiveCamera',
    () => starsOverlay(vec4(1), wrong(camera), camera, atmosphere)
  ],
  [
    'AerialPerspectiveNode: camera must be a Camera, got an Atmosphere',
    () => aerialPerspective(vec4(1), vec4(1), wrong(atmosphere), wrong(camera))
  ],
  [
    'AerialPerspectiveNode: atmosphere must be an Atmosphere, got a Scene',
    () => aerialPerspective(vec4(1), vec4(1), camera, wrong(new Scene()))
  ],
  [
    'AerialPerspectiveNode: showSky must be true or false, got null',
    () => aerialPerspective(vec4(1), vec4(1), camera, atmosphere, { showSky: wrong(null) })
  ],
  [
    'AerialPerspectiveNode: shafts must be LightShafts, got a Scene',
    () => aerialPerspective(vec4(1), vec4(1), camera, atmosphere, { shafts: wrong(new Scene()) })
  ],
  [
    "SkyBackgroundNode: showSun must be true or false, got 'no'",
    () => skyBackground(atmosphere, { showSun: wrong('no') })
  ],
  [
    "AerialPerspectiveNode: camera must be a Camera, got 'camera'",
    () => aerialPerspective(vec4(1), vec4(1), wrong('camera'), atmosphere)
  ],
  [
    'Moon.seenFrom: position must be a Vector3, got a PerspectiveCamera',
    () => luna.seenFrom(wrong(camera))
  ],
  [
    'solveDiffuseLight: parameters must be AtmosphereParameters, got an Atmosphere',
    () => solveDiffuseLight(wrong(atmosphere))
  ],
  [
    'SkyBackgroundNode: atmosphere must be an Atmosphere, got a Scene',
    () => skyBackground(wrong(new Scene()))
  ],
  [
    'AtmosphereShell: parameters must be AtmosphereParameters, got an Atmosphere',
    () => new AtmosphereShell(wrong(atmosphere), 1)
  ],
  [
    "AtmosphereShell: model must be 'tables' or 'single-scattering', got 'single'",
    () => new AtmosphereShell(parameters, 1, { model: wrong('single') })
  ],
  [
    'AtmosphereShell: bodyRadius must be positive and finite, got { radius: 1 }',
    () => new AtmosphereShell(parameters, wrong({ radius: 1 }))
  ],
  [
    'AtmosphereShell: parameters must be tables.parameters, the same object, got an AtmosphereParameters',
    () =>
      new AtmosphereShell(new AtmosphereParameters({ topRadius: 6_500_000 }), 1, {
        tables: atmosphere.tables
      })
  ],
  [
    'Atmosphere: parameters must be tables.parameters, the same object, got an AtmosphereParameters',
    () =>
      new Atmosphere({
        tables: atmosphere.tables,
        parameters: new AtmosphereParameters({ mieScaleHeight: 900 })
      })
  ],
  [
    "Atmosphere: tables must be an atmosphere's, got {}",
    () => new Atmosphere({ tables: wrong({}) })
  ],
  ['skyLuminanceAt: there are no tables yet', () => skyLuminanceAt(atmosphere, zero, zero)],
  [
    'skyLuminanceAt: source must be a LightSource',
    () => skyLuminanceAt(atmosphere, zero, zero, { source: wrong(null) })
  ],
  [
    'sunIlluminanceAt: atmosphere must be an Atmosphere, got undefined',
    () => sunIlluminanceAt(wrong(undefined), zero)
  ],
  [
    'skyIlluminanceAt: position must be a Vector3, got 1',
    () => skyIlluminanceAt(atmosphere, wrong(1), zero)
  ],
  ['moonIlluminanceAt: moon must be a Moon, got null', () => moonIlluminanceAt(wrong(null), zero)]
]

describe('wrong use throws with name and value', () => {
  it.each(cases)('%s', (message, call) => {
    expect(call).toThrow(message)
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
