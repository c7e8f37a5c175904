import { Mesh, PerspectiveCamera, Scene, Texture, Vector3 } from 'three'
import { vec4 } from 'three/tsl'
import {
  aerialPerspective,
  aerialPerspectiveFog,
  airglow,
  airlessParameters,
  airStyle,
  Atmosphere,
  AtmosphereParameters,
  AtmosphereShell,
  imageEnvironment,
  marsParameters,
  milkyWay,
  moon,
  proceduralStars,
  skyBackground,
  skyEnvironment,
  moonIlluminanceAt,
  skyIlluminanceAt,
  solveDiffuseLight,
  sunIlluminanceAt,
  standardEarthParameters,
  Stars
} from '@welkin/atmosphere'
import { throwsEach, wrong } from './harness/wrong'

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const luna = moon().attach(atmosphere)
const night = {
  stars: new Stars({ catalogue: proceduralStars({ count: 2 }) }),
  way: milkyWay(),
  glow: airglow()
}
const parameters = new AtmosphereParameters()
const zero = new Vector3()

throwsEach('atmospheres, their parameters and nodes', [
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
  ['AirStyle: haze must be finite', () => airStyle({ haze: -1 })],
  [
    'AirStyle: twilightSaturation must be finite',
    () => airStyle({ twilightSaturation: wrong(null) })
  ],
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
  [
    'Atmosphere: sunDirection must have finite components, got (null, 1, 0)',
    () => (atmosphere.sunDirection = new Vector3(wrong(null), 1, 0))
  ],
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
    'aerialPerspectiveFog: use forwardShafts()',
    () => aerialPerspectiveFog(atmosphere, wrong({ shafts: null }))
  ],
  [
    'Atmosphere.add: layer must be a SkyLayer or forwardShafts(), got a Mesh',
    () => atmosphere.add(wrong(new Mesh()))
  ],
  [
    'Atmosphere.add: layer must be a SkyLayer or forwardShafts(), got [undefined]',
    () => atmosphere.add(wrong([undefined]))
  ],
  [
    'Atmosphere.add: layer is in the sky already, got a MilkyWay',
    () => new Atmosphere().add(night.way, night.way)
  ],
  [
    'Atmosphere.add: layer is in the sky already, got an Airglow',
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
  ['skyBackground: set it as scene.backgroundNode', () => skyBackground(atmosphere).isCubeTexture],
  [
    'aerialPerspectiveFog: set it as scene.fogNode',
    () => aerialPerspectiveFog(atmosphere).isFogExp2
  ],
  [
    'AerialPerspectiveNode: colorNode must be a node, got a Scene',
    () => aerialPerspective(wrong(new Scene()), vec4(1), camera, atmosphere)
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
    'AtmosphereShell: shafts must be forwardShafts of the sun, of these parameters, for tables, got 3',
    () => new AtmosphereShell(new AtmosphereParameters(), 1, { shafts: wrong(3) })
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
  [
    'sunIlluminanceAt: atmosphere must be an Atmosphere, got undefined',
    () => sunIlluminanceAt(wrong(undefined), zero)
  ],
  [
    'skyIlluminanceAt: position must be a Vector3, got 1',
    () => skyIlluminanceAt(atmosphere, wrong(1), zero)
  ],
  ['moonIlluminanceAt: moon must be a Moon, got null', () => moonIlluminanceAt(wrong(null), zero)]
])
