import { Atmosphere } from '@welkin/atmosphere'
import type { AtmosphereView } from '@welkin/atmosphere'
import type { RenderTarget } from 'three'
import { PerspectiveCamera, Vector3, Vector4 } from 'three'
import type { Renderer } from 'three/webgpu'
import { expect, test } from 'vitest'
import { CloudField } from '../../src/density/CloudField'
import { cloudPreset, type CloudPresetName } from '../../src/layers/presets'
import { CloudShadowMap } from '../../src/shadow/CloudShadowMap'

/** Frames that drawing a cascade anew takes. */
const STRIPS = 4
const radius = 6_371_000

/** A renderer that draws nothing, but tells of every draw into a target. */
function fakeRenderer(drawn: (target: RenderTarget) => void): Renderer {
  let current: RenderTarget | undefined
  const parts: Record<string, unknown> = {
    setRenderTarget: (target?: RenderTarget) => void (current = target),
    render: () => drawn(current!)
  }
  const renderer = new Proxy(parts, {
    get: (target, name) => target[name as string] ?? (() => undefined)
  })
  return renderer as unknown as Renderer
}

/** A sky of which frames are drawn; nothing reaches a GPU. */
class Sky {
  readonly layers
  readonly field
  readonly shadows
  /** Distance of the camera, east of where it was [m]. */
  east = 0
  height = 2
  sun = new Vector3(0.5, 0.6, 0.7).normalize()
  /** Texels drawn, by the map's square. */
  drawn: number[] = []
  readonly renderer = fakeRenderer(target => {
    // Noise is drawn, too.
    if (target !== this.shadows.target) return
    const { x, w, z } = target.scissor
    this.drawn[x / 256] = (this.drawn[x / 256] ?? 0) + w * z
  })
  #seconds = 0

  constructor(preset: CloudPresetName) {
    const atmosphere = new Atmosphere()
    atmosphere.parameters.set({ bottomRadius: radius, topRadius: radius + 1e5 })
    this.layers = cloudPreset(preset)
    this.field = new CloudField(atmosphere, this.layers)
    this.shadows = new CloudShadowMap(this.field)
  }

  get up(): Vector3 {
    const angle = this.east / radius
    return new Vector3(Math.cos(angle), Math.sin(angle), 0)
  }

  get #view(): AtmosphereView {
    const { atmosphere } = this.field
    const { up, height, sun: lightDirection } = this
    const camera = new PerspectiveCamera()
    const view: Partial<AtmosphereView> = { atmosphere, camera, up, height, lightDirection }
    return view as AtmosphereView
  }

  /** @returns Cascades' worth of texels that were drawn. */
  frames(count: number, seconds = 1 / 60, eastwards = 0): number {
    this.drawn = []
    for (let i = 0; i < count; i++) {
      this.east += eastwards
      this.#seconds += seconds
      this.field.update(this.#view, this.#seconds)
      this.shadows.update(this.renderer, this.#view)
    }
    return this.drawn.reduce((sum, texels) => sum + texels, 0) / 256 ** 2
  }

  /** Texel of a point given from the planet's centre, in the mapped space, in a cascade [texels, texels, m]. */
  texelOf(cascade: number, place: Vector3): Vector3 {
    const { u, v, w } = this.shadows.nodes.cascades[cascade]
    const offset = place.clone().sub(this.up.multiplyScalar(radius + this.height))
    const at = new Vector4(...offset.toArray(), 1)
    return new Vector3(at.dot(u.value) * 256, at.dot(v.value) * 256, at.dot(w.value))
  }
}

test('draws all cascades at first, and none as long as nothing changes', () => {
  const sky = new Sky('fairWeather')
  expect(sky.frames(1)).toBe(3)
  expect(sky.frames(200, 0)).toBe(0)
})

test('draws all anew, a strip a frame, when the layers change', () => {
  const sky = new Sky('fairWeather')
  sky.frames(1)
  sky.layers.at(0).set({ coverage: 0.6 })
  expect(sky.frames(1, 0)).toBe(1 / STRIPS)
  expect(sky.frames(3 * STRIPS - 1, 0)).toBe(3 - 1 / STRIPS)
  expect(sky.frames(50, 0)).toBe(0)
})

test('draws all cascades at once when there is noise', () => {
  const sky = new Sky('fairWeather')
  sky.frames(1)
  sky.field.bake(sky.renderer)
  expect(sky.field.noise.isReady).toBe(true)
  expect(sky.frames(1, 0)).toBe(3)
  expect(sky.frames(50, 0)).toBe(0)
})

test('has room below the cascades for as many as keep something there', () => {
  const sky = new Sky('fairWeather')
  const { shadows } = sky
  const { target, nodes } = shadows
  sky.frames(1)
  const drawn = (): number[] => nodes.cascades.map(({ isDrawn }) => isDrawn.value)
  const [first, second, third] = [0, 1, 2].map(() => shadows.makeRoom())
  expect([first.first, second.first]).toEqual([256, 256 + first.count])
  expect(first.target).toBe(target)
  expect(target.height).toBe(256 + 3 * first.count)
  expect(nodes.scale.value.y * target.height).toBeCloseTo(256, 9)
  // What was there went with the smaller texture.
  expect(drawn()).toEqual([0, 0, 0])
  expect(sky.frames(1, 0)).toBe(3)
  expect(drawn()).toEqual([1, 1, 1])
  expect(sky.frames(50, 0)).toBe(0)
  shadows.dispose()
  expect([first, second, third].map(room => room.target)).toEqual([undefined, undefined, undefined])
})

test('serves all cascades in turn while everything changes', () => {
  const sky = new Sky('fairWeather')
  sky.frames(1)
  for (let i = 0; i < 60 * STRIPS; i++) {
    sky.layers.at(0).set({ coverage: 0.3 + i * 1e-3 })
    expect(sky.frames(1)).toBe(1 / STRIPS)
  }
  const orders = sky.shadows.nodes.cascades.map(({ atlasTile }) => atlasTile.value)
  expect(new Set(orders).size).toBe(3)
})

test('drifts with the clouds instead of being drawn anew', () => {
  const sky = new Sky('fairWeather')
  sky.frames(1)
  const place = sky.up.multiplyScalar(radius + 1500)
  const [turn] = sky.field.rotations
  // Of the noise, which the clouds take along.
  const noise = place.clone().applyQuaternion(turn)
  const before = sky.texelOf(0, place)
  expect(sky.frames(600)).toBe(0)
  const moved = noise.applyQuaternion(turn.clone().invert())
  expect(moved.distanceTo(place)).toBeCloseTo(10 * Math.hypot(7, 2), 0)
  const after = sky.texelOf(0, moved)
  expect(Math.hypot(after.x - before.x, after.y - before.y)).toBeLessThan(0.01)
})

test('is drawn anew when layers have drifted apart, the narrowest cascade the most often', () => {
  const sky = new Sky('mixed')
  sky.frames(1)
  const minute = sky.frames(3600)
  // 21 m/s against each other are a quarter of a texel of 39 m in 0.4 s.
  expect(minute).toBeGreaterThan(60)
  expect(minute).toBeLessThan(220)
})

test('follows a camera in flight, and the sun', () => {
  const sky = new Sky('fairWeather')
  sky.frames(1)
  // 250 m/s: eight texels of 39 m in 1.25 s, of 156 m in 5 s.
  const flight = sky.frames(600, 1 / 60, 250 / 60)
  expect(flight).toBeGreaterThan(6)
  expect(flight).toBeLessThan(14)
  for (const cascade of [0, 1, 2]) {
    const { x, y } = sky.texelOf(cascade, sky.up.multiplyScalar(radius + 1400))
    expect(Math.max(Math.abs(x - 128), Math.abs(y - 128))).toBeLessThan(12)
  }
  const turnSun = (by: number): void => {
    sky.sun.x += by
    sky.sun.normalize()
  }
  turnSun(0.001)
  expect(sky.frames(50, 0)).toBe(0)
  turnSun(0.1)
  expect(sky.frames(1, 0)).toBe(3)
})

test('follows the sun, a cascade the later the wider its texels are', () => {
  const sky = new Sky('fairWeather')
  sky.frames(1)
  const turnSun = (by: number): void => {
    const { x, z } = sky.sun
    sky.sun.x = x * Math.cos(by) - z * Math.sin(by)
    sky.sun.z = x * Math.sin(by) + z * Math.cos(by)
  }
  const level = Math.hypot(sky.sun.x, sky.sun.z)
  // A third of a texel of 39 m at 3 km, and once more; the third is beyond that of the texels of 156 and 625 m, too.
  turnSun(0.006 / level)
  expect(sky.frames(50, 0)).toBe(1)
  turnSun(0.006 / level)
  expect(sky.frames(50, 0)).toBe(1)
  turnSun(0.009 / level)
  expect(sky.frames(50, 0)).toBe(3)
})

test('a layer without clouds may drift as it likes', () => {
  const sky = new Sky('mixed')
  const [first, ...others] = sky.layers
  expect(first.parameters.coverage).toBeGreaterThan(0)
  for (const layer of others) layer.set({ coverage: 0 })
  sky.frames(1)
  expect(sky.frames(600)).toBe(0)
})
