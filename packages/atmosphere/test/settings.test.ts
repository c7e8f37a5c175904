import { Ellipsoid } from '@welkin/geo'
import { describe, expect, it } from 'vitest'
import {
  airglow,
  airlessParameters,
  Atmosphere,
  AtmosphereParameters,
  AtmosphereShell,
  DayCycle,
  distanceFog,
  heightFog,
  marsParameters,
  milkyWay,
  moon,
  NightLightProbe,
  planetGround,
  skyEnvironment,
  standardEarthParameters,
  Stars,
  sunFlare,
  titanParameters,
  venusParameters
} from '@welkin/atmosphere'

/** Value of a type that the compiler would not let pass. */
const wrong = (value: unknown): never => value as never

const atmosphere = new Atmosphere()

it('settings are properties, and change together or not at all', () => {
  const world = new Atmosphere({ frame: 'ecef', metersPerUnit: 1000, date: new Date(0) })
  expect(world.worldToECEF.elements[0]).toBe(1000)
  expect(() => world.set({ frame: 'local', flat: wrong(1) })).toThrow('flat')
  expect([world.frame, world.flat, world.date]).toEqual(['ecef', false, new Date(0)])

  const flare = sunFlare({ innerPower: 5000 })
  flare.outerPower = 100
  expect(() => flare.set({ innerPower: 1, outerStrength: -1 })).toThrow('outerStrength')
  expect([flare.innerPower, flare.outerPower, flare.outerStrength]).toEqual([5000, 100, 0.004])
  const mist = heightFog({ base: 280 })
  mist.density = 0.02
  expect(() => mist.set({ density: 0.03, fade: [2, 1] })).toThrow('fade must rise')
  expect([mist.base, mist.density, mist.version]).toEqual([280, 0.02, 1])
  const murk = distanceFog({ fade: [1, 2] })
  expect(() => murk.set({ density: 0.5, fade: [3, 2] })).toThrow('fade must rise')
  expect([murk.density, murk.fade]).toEqual([1e-4, [1, 2]])
  const glow = airglow({ intensity: 2 })
  expect(() => glow.set({ luminance: 1, width: -1 })).toThrow('width')
  expect([glow.intensity, glow.luminance, glow.width, glow.altitude]).toEqual([
    2, 1e-4, 4000, 96_000
  ])
  expect(milkyWay({ intensity: 3 }).intensity).toBe(3)
  expect(new Stars({ catalogue: [], intensity: 4 }).set({ orientation: null }).intensity).toBe(4)
  expect(planetGround({ seed: 3 }).set({ windSpeed: 2 }).seed).toBe(3)
  expect(() => planetGround().set(wrong({ seed: 3 }))).toThrow("unknown option 'seed'")
  const environment = skyEnvironment(atmosphere, { climb: 0.5 })
  expect(() => environment.set({ angle: 1, climb: 0 })).toThrow('SkyEnvironmentNode: climb')
  expect([environment.angle, environment.climb]).toEqual([0.1, 0.5])
  const cycle = new DayCycle(world, { paused: true })
  expect(() => cycle.set({ paused: false, rate: 2, daylight: 1 })).toThrow('DayCycle: daylight')
  expect([cycle.paused, cycle.rate, cycle.daylight]).toEqual([true, 1440, 0.5])
  expect(cycle.set({ holdDay: true, adaptation: undefined }).holdDay).toBe(true)
  const shell = new AtmosphereShell(marsParameters(), 1, { sun: world })
  expect(() => shell.set({ sun: atmosphere, luminanceScale: 0 })).toThrow('luminanceScale')
  expect(shell.sun).toBe(world)
  const probe = new NightLightProbe(atmosphere)
  probe.illuminance = 1
  expect(() => (probe.illuminance = -1)).toThrow('NightLightProbe: illuminance')
  expect(probe.illuminance).toBe(1)
  const other = moon({ phase: 0.25, flare: { outerPower: 400 } })
  expect([other.phase, other.strength, other.flare.outerPower]).toEqual([0.25, 1, 400])
  expect(() => other.set({ phase: 0.75, strength: NaN })).toThrow('strength')
  expect(other.set({ distance: 4e8, phase: null }).distance).toBe(4e8)
  expect([other.phase, other.strength]).toEqual([null, 1])
})

describe('an atmosphere has the figure of its parameters', () => {
  const radii = (of: AtmosphereParameters) => new Atmosphere({ parameters: of }).ellipsoid.radii
  it.each<[string, AtmosphereParameters, number, number]>([
    ['Earth', standardEarthParameters(), 6_378_137, 6_356_752.314],
    [
      "Bruneton's Earth",
      new AtmosphereParameters({ bottomRadius: 6.36e6, topRadius: 6.42e6 }),
      6_378_137,
      6_356_752.314
    ],
    ['Mars', marsParameters(), 3_396_190, 3_376_200],
    ['Titan', titanParameters(), 2_574_730, 2_574_730],
    ['Venus', venusParameters(), 6_116_800, 6_116_800],
    ['a bare body of the size of the Earth', airlessParameters({ radius: 6.4e6 }), 6.4e6, 6.4e6],
    ['a small world', new AtmosphereParameters({ bottomRadius: 1e5, topRadius: 1.2e5 }), 1e5, 1e5]
  ])('%s', (_, of, equatorial, polar) => {
    expect(radii(of).x).toBe(equatorial)
    expect(radii(of).z).toBeCloseTo(polar, 2)
    expect(radii(of.clone())).toEqual(radii(of))
  })

  it('unless it is given another', () => {
    const ellipsoid = new Ellipsoid(3.4e6)
    const mars = new Atmosphere({ parameters: marsParameters(), ellipsoid })
    expect(mars.ellipsoid).toBe(ellipsoid)
    expect(
      () => new Atmosphere({ parameters: marsParameters(), ellipsoid: Ellipsoid.WGS84 })
    ).toThrow('Atmosphere: bottomRadius must be near that of the ellipsoid, got 3396190')
  })
})

it('a shell of a body without air is not drawn', () => {
  expect(new AtmosphereShell(airlessParameters(), 1).visible).toBe(false)
  expect(new AtmosphereShell(marsParameters(), 1).visible).toBe(true)
})
