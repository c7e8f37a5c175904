import fc from 'fast-check'
import { DirectionalLight, Matrix4, PerspectiveCamera, PointLight, Texture } from 'three'
import { float, vec4 } from 'three/tsl'
import { describe, expect, it, vi } from 'vitest'
import {
  aerialPerspective,
  Atmosphere,
  AtmosphereShell,
  distanceFog,
  heightFieldShadow,
  heightFog,
  terrainShadow,
  forwardShafts,
  lightShafts,
  moon,
  MoonDirectionalLight,
  SunDirectionalLight
} from '@welkin/atmosphere'
import type { AirOccluder } from '@welkin/atmosphere'
import type { ScreenShafts } from '../../src/shafts/ScreenShafts'
import { claimShadow, shadowMapsOf } from '../../src/shafts/shadowMaps'
import { warpedDistance } from '../twins/shafts/warpedSteps'

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const light = new SunDirectionalLight(atmosphere)

/** Value of a type that the compiler would not let pass. */
const wrong = (value: unknown): never => value as never

/** Draws shafts of a picture as far as they can be without a renderer. */
function drawAgain(screen: ScreenShafts): void {
  const draw = screen.foreground === undefined ? 'prepare' : 'prepareShadows'
  try {
    screen[draw](wrong({}), wrong({}))
  } catch {
    // There is no renderer.
  }
}

/** An occluder that takes nothing. */
const occluder: AirOccluder = { castInto: () => ({ transmittance: () => () => float(1) }) }

describe('bad input to light shafts', () => {
  const cases: [string, () => unknown][] = [
    [
      "AerialPerspectiveNode: unknown option 'shaft', did you mean 'shafts'?",
      () => aerialPerspective(vec4(1), vec4(1), camera, atmosphere, wrong({ shaft: 1 }))
    ],
    [
      'AerialPerspectiveNode: shafts must be LightShafts, got a PerspectiveCamera',
      () => aerialPerspective(vec4(1), vec4(1), camera, atmosphere, { shafts: wrong(camera) })
    ],
    [
      'LightShafts: atmosphere must be an Atmosphere, got a PerspectiveCamera',
      () => lightShafts(wrong(camera), camera, light)
    ],
    [
      'LightShafts: camera must be a Camera, got an Atmosphere',
      () => lightShafts(atmosphere, wrong(atmosphere), light)
    ],
    [
      'LightShafts: light must be a DirectionalLight, got undefined',
      () => lightShafts(atmosphere, camera, wrong(undefined))
    ],
    [
      "LightShafts: unknown option 'steps', there are strength, quality, enabled",
      () => lightShafts(atmosphere, camera, light, wrong({ steps: 4 }))
    ],
    [
      "LightShafts: unknown option 'strenght', did you mean 'strength'?",
      () => lightShafts(atmosphere, camera, light, wrong({ strenght: 1 }))
    ],
    [
      'LightShafts: strength must be finite and ≥ 0, got -1',
      () => lightShafts(atmosphere, camera, light, { strength: -1 })
    ],
    [
      "LightShafts: quality must be 'low', 'medium', 'high' or 'reference', got 'best'",
      () => lightShafts(atmosphere, camera, light, { quality: wrong('best') })
    ],
    [
      'LightShafts: enabled must be true or false, got 1',
      () => lightShafts(atmosphere, camera, light, { enabled: wrong(1) })
    ],
    [
      'LightShafts: light must be of the same atmosphere, got a SunDirectionalLight',
      () => lightShafts(new Atmosphere(), camera, light)
    ],
    [
      'LightShafts: light must be a DirectionalLight, got a PointLight',
      () => lightShafts(atmosphere, camera, wrong(new PointLight()))
    ],
    [
      'LightShafts.add: occluder must be an AirOccluder, such as cloudAirShadow(), got a PerspectiveCamera',
      () => lightShafts(atmosphere, camera, light).add(wrong(camera))
    ],
    [
      'LightShafts.add: occluder must not have been added already',
      () => lightShafts(atmosphere, camera, light).add(occluder, occluder)
    ],
    [
      'HeightFieldShadow: heights must be a Texture or a function, got 3',
      () => heightFieldShadow(wrong(3), new Matrix4())
    ],
    [
      'HeightFieldShadow: matrix must be a Matrix4, got undefined',
      () => heightFieldShadow(new Texture(), wrong(undefined))
    ],
    [
      'HeightFieldShadow: size must be a power of two in [2, 4096], got 1000',
      () => heightFieldShadow(new Texture(), new Matrix4(), { size: 1000 })
    ],
    [
      "HeightFieldShadow: unknown option 'sizes', did you mean 'size'?",
      () => heightFieldShadow(new Texture(), new Matrix4(), wrong({ sizes: 64 }))
    ],
    [
      'TerrainShadowNode: hills must be a HeightFieldShadow, got 3',
      () => terrainShadow(wrong(3), light)
    ],
    [
      'TerrainShadowNode: light must be a DirectionalLight, got a PointLight',
      () => terrainShadow(heightFieldShadow(new Texture(), new Matrix4()), wrong(new PointLight()))
    ],
    [
      'HeightFieldShadow: matrix must have an inverse, got a Matrix4',
      () => heightFieldShadow(new Texture(), new Matrix4().makeScale(1e4, 1e4, 0))
    ],
    [
      'HeightFieldShadow: matrix must have an inverse, got a Matrix4',
      () =>
        heightFieldShadow(
          new Texture(),
          new Matrix4().set(1, 2, 0, 0, 3, 6, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1)
        )
    ],
    [
      'AerialPerspectiveNode: shafts must be of the same camera, got a PerspectiveCamera',
      () =>
        aerialPerspective(vec4(1), vec4(1), camera.clone(), atmosphere, {
          shafts: lightShafts(atmosphere, camera, light)
        })
    ],
    [
      'AerialPerspectiveNode: shafts must be of the same atmosphere, got an Atmosphere',
      () =>
        aerialPerspective(vec4(1), vec4(1), camera, new Atmosphere(), {
          shafts: lightShafts(atmosphere, camera, light)
        })
    ],
    [
      'AerialPerspectiveNode: shafts must be LightShafts, got undefined',
      () => aerialPerspective(vec4(1), vec4(1), camera, atmosphere, { shafts: [wrong(undefined)] })
    ],
    [
      'AtmosphereShell: shafts must be forwardShafts of the sun, of these parameters, for tables, got a ForwardShafts',
      () => {
        const moonlit = new Atmosphere()
        const luna = moon()
        moonlit.add(luna)
        const moonlight = new MoonDirectionalLight(moonlit, luna)
        return new AtmosphereShell(moonlit.parameters, 1, {
          shafts: forwardShafts(moonlit, camera, moonlight)
        })
      }
    ],
    [
      'AtmosphereShell: shafts must be forwardShafts of the sun, of these parameters, for tables, got a LightShafts',
      () => {
        const shafts = lightShafts(atmosphere, camera, light)
        return new AtmosphereShell(atmosphere.parameters, 1, { shafts })
      }
    ],
    [
      'ForwardShafts: atmosphere must be that of its layers, got an Atmosphere',
      () => new Atmosphere().add(forwardShafts(atmosphere, camera, light))
    ],
    [
      'Atmosphere.add: layer must be a SkyLayer or forwardShafts(), got a LightShafts',
      () => atmosphere.add(lightShafts(atmosphere, camera, light))
    ]
  ]
  it.each(cases)('%s', (message, run) => {
    expect(run).toThrow(message)
  })

  it('changes nothing if a setting is refused', () => {
    const shafts = lightShafts(atmosphere, camera, light, { strength: 0.5 })
    expect(() => shafts.set({ strength: 2, quality: wrong('best') })).toThrow('quality')
    expect(shafts.strength).toBe(0.5)
    expect(shafts.quality).toBe('medium')
  })
})

describe('what is added to light shafts', () => {
  it('is told when it is taken out, and can be added again', () => {
    const calls: string[] = []
    const added: AirOccluder = {
      castInto: ({ camera: seen }) => {
        calls.push(seen === camera ? 'cast' : 'other')
        return { transmittance: () => () => float(1), dispose: () => calls.push('dispose') }
      }
    }
    const shafts = lightShafts(atmosphere, camera, light)
    const { version } = shafts
    shafts.add(occluder, added).remove(added, added).add(added)
    expect(calls).toEqual(['cast', 'dispose', 'cast'])
    expect(shafts.version).toBeGreaterThan(version)
  })

  it('leaves nothing of a foreground that was taken out, and takes forward shafts up again after a post effect', () => {
    const shafts = lightShafts(atmosphere, camera, light)
    let [drawn, freed] = [0, 0]
    const foreground = {
      get isDrawn() {
        drawn++
        return true
      },
      octavesAt: () => float(1),
      transmittanceAt: () => float(1)
    }
    for (let i = 0; i < 3; i++) {
      const screen = shafts.upTo(float(1), foreground) as ScreenShafts
      screen.grid.target.addEventListener('dispose', () => freed++)
      screen.dispose()
    }
    expect(freed).toBe(3)
    shafts.dispose()
    expect(freed).toBe(3)
    expect(shafts.screens.hasForeground).toBe(false)
    expect(drawn).toBe(0)
    const kept = shafts.upTo(float(1), foreground) as ScreenShafts
    kept.grid.target.addEventListener('dispose', () => freed++)
    shafts.dispose()
    expect(freed).toBe(4)
    expect(shafts.screens.hasForeground).toBe(true)

    const layered = new Atmosphere()
    const post = forwardShafts(layered, camera, new SunDirectionalLight(layered))
    layered.add(post)
    const node = aerialPerspective(vec4(0), float(1), camera, layered, { shafts: post })
    expect(post.isForward).toBe(false)
    node.dispose()
    expect(post.isForward).toBe(true)
    // Drawn again after a dispose, it has them again, as a foreground has.
    for (const foreground of [undefined, { isDrawn: true } as never]) {
      const screen = post.upTo(float(1), foreground) as ScreenShafts
      screen.dispose()
      expect([...post.screens]).not.toContain(screen)
      drawAgain(screen)
      expect([...post.screens]).toContain(screen)
      screen.dispose()
    }
    post.onMesh()
    expect(post.isForward, 'with a mesh of air besides').toBe(true)
  })

  it('is not added where one of several is refused', () => {
    const shafts = lightShafts(atmosphere, camera, light)
    expect(() => shafts.add(occluder, wrong({}))).toThrow('occluder')
    expect(shafts.shadowedAir.shadows).toHaveLength(0)
    let held = 0
    const cast: AirOccluder = {
      castInto: () => {
        held++
        return { transmittance: () => () => float(1), dispose: () => held-- }
      }
    }
    const refuses: AirOccluder = {
      castInto() {
        throw new Error('another atmosphere')
      }
    }
    const { version } = shafts
    expect(() => shafts.add(cast, refuses, occluder)).toThrow('another atmosphere')
    expect([held, shafts.shadowedAir.shadows.length, shafts.version]).toEqual([0, 0, version])
    shafts.add(occluder, cast)
    expect(held).toBe(1)
  })

  it('asks what casts for room once materials read the shafts, and not where they march', () => {
    const home = new Atmosphere()
    const shafts = forwardShafts(home, camera, new SunDirectionalLight(home), {
      quality: 'reference'
    })
    let asked = 0
    const makeRoom = () => {
      asked++
      return { target: undefined, first: 0, count: 0 }
    }
    shafts.add({ castInto: () => ({ transmittance: () => () => float(1), makeRoom }) })
    home.add(shafts)
    expect(asked).toBe(0)
    shafts.quality = 'medium'
    expect(asked).toBe(1)
    home.remove(shafts)
    shafts.remove().add(occluder)
    expect(asked).toBe(1)
  })

  it('leaves the layers of the sky in their order', () => {
    const home = new Atmosphere()
    const shafts = forwardShafts(home, camera, new SunDirectionalLight(home))
    const layers = [heightFog(), shafts, distanceFog({ density: 1e-4 }), moon()]
    const { layersVersion } = home.add(...layers)
    shafts.set({ quality: 'low' }).add(occluder).set({ quality: 'high' }).remove(occluder)
    expect(home.layers).toEqual(layers)
    expect(home.layersVersion).toBeGreaterThan(layersVersion)
  })

  it('shares the map of a height field with the shadow on surfaces, of any light', () => {
    for (const sun of [light, new DirectionalLight()]) {
      const field = heightFieldShadow(new Texture(), new Matrix4())
      const acquire = vi.spyOn(field, 'acquire')
      lightShafts(atmosphere, camera, sun).add(field)
      terrainShadow(field, sun).setup()
      const [inAir, onGround] = acquire.mock.results.map(({ value }) => value as object)
      expect(inAir).toBe(onGround)
    }
  })

  it('lends the shafts no map of a height field while they are disposed of', () => {
    const field = heightFieldShadow(new Texture(), new Matrix4())
    const release = vi.spyOn(field, 'release')
    const shafts = lightShafts(atmosphere, camera, light).add(field)
    shafts.dispose()
    expect(release).toHaveBeenCalledOnce()
    shafts.remove(field)
    expect(release).toHaveBeenCalledOnce()
  })
})

/** The node in the slot of a light's shadow. */
const slotOf = ({ shadow }: DirectionalLight): object | undefined =>
  (shadow as { shadowNode?: object }).shadowNode

describe('shadow maps of a light', () => {
  it('are none before three has drawn one, or where the light casts no shadow', () => {
    const plain = new DirectionalLight()
    expect(shadowMapsOf(plain)).toEqual([])
    plain.castShadow = true
    expect(shadowMapsOf(plain)).toEqual([])
  })

  it('are drawn by a node in the slot of the shadow, unless it has one', () => {
    const [plain, own] = [new DirectionalLight(), new DirectionalLight()]
    const node = {}
    Object.assign(own.shadow, { shadowNode: node })
    claimShadow(plain, camera)
    claimShadow(own, camera)
    expect(slotOf(plain)).toBeDefined()
    expect(slotOf(own)).toBe(node)
  })

  it('have their slot as it was, once all shafts of the light are disposed of', () => {
    const plain = new DirectionalLight()
    const [first, second] = [0, 1].map(() =>
      lightShafts(atmosphere, new PerspectiveCamera(), plain)
    )
    const node = slotOf(plain)
    first.dispose()
    expect(slotOf(plain)).toBe(node)
    second.dispose()
    expect('shadowNode' in plain.shadow).toBe(false)

    // Used again, it has the node that three knows; another in its place is left alone.
    claimShadow(plain, first)
    expect(slotOf(plain)).toBe(node)
    const other = {}
    Object.assign(plain.shadow, { shadowNode: other })
    first.dispose()
    expect(slotOf(plain)).toBe(other)
  })

  it('are left to three where it has drawn them by itself', () => {
    const plain = new DirectionalLight()
    plain.shadow.map = {} as never
    claimShadow(plain, camera)
    expect(slotOf(plain)).toBeUndefined()
  })
})

describe('spacing of samples', () => {
  const rays = {
    radius: fc.double({ min: 6_360_000, max: 6_420_000, noNaN: true }),
    cosView: fc.double({ min: -1, max: 1, noNaN: true }),
    length: fc.double({ min: 1, max: 900_000, noNaN: true })
  }

  it('begins and ends with the ray, and grows all along it', () => {
    fc.assert(
      fc.property(rays.radius, rays.cosView, rays.length, (radius, cosView, length) => {
        const at = (part: number): number => warpedDistance(radius, cosView, 8000, length, part)
        const places = [0, 0.1, 0.3, 0.5, 0.7, 0.9, 1].map(at)
        expect(places[0] / length).toBeCloseTo(0, 9)
        expect(places[6] / length).toBeCloseTo(1, 9)
        places.slice(1).forEach((place, i) => expect(place).toBeGreaterThan(places[i]))
      })
    )
  })

  it('gives each sample of an upright ray about as much of thin air: none twice the mean', () => {
    const [height, count] = [8000, 16]
    const at = (part: number): number => warpedDistance(6_360_000, 1, height, 60_000, part)
    const air = (distance: number): number => -Math.expm1(-distance / height)
    for (let i = 0; i < count; i++) {
      const share = air(at((i + 1) / count)) - air(at(i / count))
      expect(share * count).toBeLessThan(2)
    }
  })
})
