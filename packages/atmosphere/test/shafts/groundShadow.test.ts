import { DataUtils, Matrix4, PerspectiveCamera, Vector3 } from 'three'
import { expect, it } from 'vitest'
import { Atmosphere, groundShadow, type GroundShadow } from '@welkin/atmosphere'

const atmosphere = new Atmosphere({ frame: 'ecef' })
const { ellipsoid } = atmosphere
const WIDTH = 100_000
const TEXELS = 32

/** Ground that rises to the north-east, as seen from 47° N, 1° E [m]. */
const heightAt = (longitude: number, latitude: number): number =>
  1000 + 900 * Math.sin(8 * longitude) + 2000 * (latitude - 47)

let asked = 0
const ground = {
  heightBelow(position: Vector3): number {
    asked++
    const { longitude, latitude } = ellipsoid.ecefToGeodetic(position)
    return heightAt(longitude, latitude)
  }
}

const above = (longitude: number, latitude: number): Vector3 =>
  ellipsoid.geodeticToECEF({ longitude, latitude, height: 5000 })

/** Heights in use, and how far they are from the ground, at most [m]. */
function worstError(
  shadow: GroundShadow,
  heights: Uint16Array,
  worldToECEF = new Matrix4(),
  texels = TEXELS
): number {
  let worst = 0
  const point = new Vector3()
  for (const [n, height] of heights.entries()) {
    const [x, y] = [n % texels, Math.floor(n / texels)].map(texel => (texel + 0.5) / texels)
    point.set(x, y, DataUtils.fromHalfFloat(height))
    point.applyMatrix4(shadow.matrix).applyMatrix4(worldToECEF)
    const place = ellipsoid.ecefToGeodetic(point)
    worst = Math.max(worst, Math.abs(place.height - heightAt(place.longitude, place.latitude)))
  }
  return worst
}

it('has the ground where it is, on the round planet, and follows the viewer', () => {
  const shadow = groundShadow(atmosphere, ground, { width: WIDTH, texels: TEXELS })
  const { heights: held } = shadow
  shadow.follow(above(1, 47))
  expect(shadow.version).toBe(1)
  expect(asked).toBe(TEXELS ** 2)
  // The plane's own up differs from the ground's by half a degree at its corners.
  expect(worstError(shadow, held.image.data as Uint16Array)).toBeLessThan(3)

  // Near the middle it stays; farther off, the next square is made row by row.
  shadow.follow(above(1.1, 47))
  expect(asked).toBe(TEXELS ** 2)
  const before = shadow.matrix.clone()
  for (let frame = 0; frame < TEXELS / 2 - 1; frame++) shadow.follow(above(1.4, 47))
  expect(shadow.version).toBe(1)
  expect(shadow.matrix).toEqual(before)
  shadow.follow(above(1.4, 47))
  expect(shadow.version).toBe(2)
  expect(asked).toBe(2 * TEXELS ** 2)
  expect(worstError(shadow, held.image.data as Uint16Array)).toBeLessThan(3)
  const { longitude, latitude } = ellipsoid.ecefToGeodetic(
    new Vector3(0.5, 0.5, 0).applyMatrix4(shadow.matrix)
  )
  expect([longitude, latitude]).toEqual([expect.closeTo(1.4, 6), expect.closeTo(47, 6)])

  shadow.refresh()
  shadow.follow(above(1.4, 47))
  expect([shadow.version, asked]).toEqual([3, 3 * TEXELS ** 2])
  shadow.dispose()
})

it('has the ground of a flat world, in its units', () => {
  const flat = new Atmosphere({ flat: true, metersPerUnit: 10 })
  // Rises to the east and the north, by metres.
  const slope = { heightBelow: ({ x, z }: Vector3) => 500 + 0.01 * 10 * x - 0.02 * 10 * z }
  const shadow = groundShadow(flat, slope, { width: WIDTH, texels: TEXELS })
  shadow.follow(new Vector3(300, 70, -200))
  const point = new Vector3()
  const units = flat.metersPerUnit
  for (const [n, height] of (shadow.heights.image.data as Uint16Array).entries()) {
    const [x, y] = [n % TEXELS, Math.floor(n / TEXELS)].map(texel => (texel + 0.5) / TEXELS)
    point.set(x, y, DataUtils.fromHalfFloat(height)).applyMatrix4(shadow.matrix)
    expect(Math.abs(units * point.y - slope.heightBelow(point))).toBeLessThan(2)
  }
  const middle = new Vector3(0.5, 0.5, 0).applyMatrix4(shadow.matrix)
  expect(middle.distanceTo(new Vector3(300, 0, -200))).toBeLessThan(1e-6)
  shadow.dispose()
})

it('stays over the ground when the origin, the axes and the units of the world change', () => {
  const moving = new Atmosphere().place({ longitude: 1, latitude: 47 })
  const inWorld = {
    heightBelow: (position: Vector3) =>
      ground.heightBelow(position.clone().applyMatrix4(moving.worldToECEF))
  }
  const shadow = groundShadow(moving, inWorld, { width: WIDTH, texels: TEXELS })
  shadow.follow(new Vector3(0, 2, 0))
  const { heights, version } = shadow
  const error = (): number =>
    worstError(shadow, heights.image.data as Uint16Array, moving.worldToECEF)
  expect(error()).toBeLessThan(3)
  moving.place({ longitude: 1.05, latitude: 47.02, height: 300 })
  moving.metersPerUnit = 10
  shadow.follow(new Vector3(0, 0.2, 0))
  expect(shadow.version).toBe(version)
  expect(error()).toBeLessThan(3)
  shadow.dispose()
})

/** A camera above a place. */
function cameraAbove(longitude: number, latitude: number): PerspectiveCamera {
  const camera = new PerspectiveCamera()
  camera.position.copy(above(longitude, latitude))
  camera.updateMatrixWorld()
  return camera
}

/** Moves a camera above a place. */
function move(camera: PerspectiveCamera, longitude: number, latitude: number): void {
  camera.position.copy(above(longitude, latitude))
  camera.updateMatrixWorld()
}

it('has heights about each of two cameras far apart, which stay', () => {
  const shadow = groundShadow(atmosphere, ground, { width: WIDTH, texels: TEXELS })
  const cameras = [cameraAbove(1, 47), cameraAbove(4, 47)]
  const fields = cameras.map(camera => shadow.fieldOf(camera))
  expect(fields[0]).not.toBe(fields[1])
  asked = 0
  for (let frame = 0; frame < 3 * TEXELS; frame++) {
    cameras.forEach((camera, i) => expect(shadow.fieldOf(camera)).toBe(fields[i]))
  }
  expect(asked).toBe(0)
  fields.forEach((field, i) => {
    expect(field.version).toBe(1)
    expect(worstError(field, field.heights.image.data as Uint16Array)).toBeLessThan(3)
    const { longitude } = ellipsoid.ecefToGeodetic(
      new Vector3(0.5, 0.5, 0).applyMatrix4(field.matrix)
    )
    expect(longitude).toBeCloseTo([1, 4][i], 6)
  })
  shadow.refresh()
  cameras.forEach(camera => shadow.fieldOf(camera))
  expect(fields.map(({ version }) => version)).toEqual([2, 2])
  shadow.dispose()
})

it('has cameras nearby share a square, which goes on with one of them when the other is gone', () => {
  const shadow = groundShadow(atmosphere, ground, { width: WIDTH, texels: TEXELS })
  const [gone, camera] = [cameraAbove(1, 47), cameraAbove(1.02, 47)]
  expect(shadow.fieldOf(gone)).toBe(shadow)
  for (let frame = 0; frame < 70; frame++) expect(shadow.fieldOf(camera)).toBe(shadow)
  move(camera, 1.4, 47)
  asked = 0
  expect(shadow.fieldOf(camera)).toBe(shadow)
  expect(asked).toBe(2 * TEXELS)
  shadow.dispose()
})

it('has no more than four squares, of which the oldest takes up another camera', () => {
  const shadow = groundShadow(atmosphere, ground, { width: WIDTH, texels: TEXELS })
  const fields = [0, 3, 6, 9].map(longitude => shadow.fieldOf(cameraAbove(longitude, 47)))
  expect(new Set(fields).size).toBe(4)
  expect(shadow.fieldOf(cameraAbove(12, 47))).toBe(fields[0])
  expect(shadow.fieldOf(cameraAbove(15, 47))).toBe(fields[1])
  shadow.dispose()
})

it('has a coarse square four frames after a leap, then a fine one, of where the camera is by then', () => {
  const texels = 128
  const shadow = groundShadow(atmosphere, ground, { width: WIDTH, texels })
  const held = (): Uint16Array => shadow.heights.image.data as Uint16Array
  const error = (): number => worstError(shadow, held(), undefined, texels)
  shadow.follow(above(1, 47))
  // It leaps while another square is being made, too.
  shadow.follow(above(1.4, 47))
  asked = 0
  for (let frame = 0; frame < 4; frame++) shadow.follow(above(5, 47))
  expect([shadow.version, asked]).toEqual([2, 64 ** 2])
  expect(error()).toBeLessThan(15)
  for (let frame = 0; frame < 64; frame++) shadow.follow(above(5.02, 47))
  expect([shadow.version, asked]).toEqual([3, 64 ** 2 + texels ** 2])
  expect(error()).toBeLessThan(3)
  shadow.dispose()
})

it('has the heights anew whenever the version of the ground grows, about where the camera is', () => {
  let rise = 0
  const loaded = { heightBelow: (at: Vector3) => ground.heightBelow(at) + rise, version: 7 }
  const shadow = groundShadow(atmosphere, loaded, { width: WIDTH, texels: TEXELS })
  const middle = (): number => {
    const heights = shadow.heights.image.data as Uint16Array
    return DataUtils.fromHalfFloat(heights[(TEXELS / 2) * TEXELS + TEXELS / 2])
  }
  shadow.follow(above(1, 47))
  const before = middle()
  rise = 100
  loaded.version++
  for (let frame = 0; frame < TEXELS / 2; frame++) {
    // Heights that arrive meanwhile are sought after those that are.
    if (frame === 5) loaded.version++
    expect(shadow.version).toBe(1)
    shadow.follow(above(1, 47))
  }
  expect(shadow.version).toBe(2)
  expect(middle() - before).toBeCloseTo(100, 0)
  for (let frame = 0; frame < 2 * TEXELS; frame++) shadow.follow(above(1, 47))
  expect(shadow.version).toBe(3)
  shadow.dispose()
})

it('asks for heights once a frame, whoever sees its shadows', () => {
  const shadow = groundShadow(atmosphere, ground, { width: WIDTH, texels: TEXELS })
  const camera = cameraAbove(1, 47)
  shadow.fieldOf(camera, 1)
  move(camera, 1.4, 47)
  asked = 0
  for (const frame of [2, 2, 2, 3, 3]) shadow.fieldOf(camera, frame)
  expect(asked).toBe(2 * 2 * TEXELS)
  shadow.dispose()
})

it.each([
  ['ground must have heightBelow()', () => groundShadow(atmosphere, {} as never)],
  ['width must be', () => groundShadow(atmosphere, ground, { width: 0 })],
  ['texels must be in [16, 1024]', () => groundShadow(atmosphere, ground, { texels: 8 })],
  ['texels must be a whole number', () => groundShadow(atmosphere, ground, { texels: 20.5 })],
  ['unknown option', () => groundShadow(atmosphere, ground, { texel: 20 } as never)]
])('tells what is wrong: %s', (message, make) => {
  expect(make).toThrow(`GroundShadow: ${message}`)
})
