import { DirectionalLight, PointLight, Triangle, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { Atmosphere, AtmosphereParameters } from '@welkin/atmosphere'
import { linearSRGBColumns } from '../../src/air/cpu/color'
import { circumscribedSphere } from '../../src/shell/circumscribedSphere'
import { SHELL_SCALE, sunlightAt, type ShellSun } from '../../src/shell/ShellSun'

const earth = new AtmosphereParameters()

/** Direction to a sun of a body that stands at (3, 0, 4), and tint. */
function lightOf(sun: ShellSun, luminanceScale = SHELL_SCALE) {
  const [direction, tint] = [new Vector3(), new Vector3()]
  sunlightAt(sun, earth, new Vector3(3, 0, 4), luminanceScale, direction, tint)
  return { direction: direction.normalize(), tint }
}

/** Linear sRGB of sunlight above the air in a picture of a shell with a tint. */
function sunlight(tint: Vector3): number[] {
  const columns = linearSRGBColumns(earth, SHELL_SCALE)
  return tint
    .toArray()
    .map((value, row) => value * columns.reduce((sum, column) => sum + column[row], 0))
}

describe('sun of a shell', () => {
  it('is that of an atmosphere, at its scale', () => {
    const atmosphere = new Atmosphere({ luminanceScale: 3e-4 })
    atmosphere.sunDirection = new Vector3(0, 3, 4)
    const { direction, tint } = lightOf(atmosphere)
    expect(direction.distanceTo(new Vector3(0, 0.6, 0.8))).toBeLessThan(1e-12)
    tint.toArray().forEach(value => expect(value).toBeCloseTo(3, 12))
  })

  it('gives the light of a lamp above the air, from where that stands', () => {
    const light = new DirectionalLight('#ff8040', 13)
    light.position.set(5, 5, 0)
    light.target.position.set(5, 0, 0)
    for (const each of [light, light.target]) each.updateMatrixWorld()
    const far = lightOf(light)
    expect(far.direction.toArray()).toEqual([0, 1, 0])
    const { r, g, b } = light.color
    sunlight(far.tint).forEach((value, i) => expect(value).toBeCloseTo(13 * [r, g, b][i], 10))

    const lamp = new PointLight(0xffffff, 100)
    lamp.position.set(3, 0, 9)
    lamp.updateMatrixWorld()
    const near = lightOf(lamp)
    expect(near.direction.toArray()).toEqual([0, 0, 1])
    sunlight(near.tint).forEach(value => expect(value).toBeCloseTo(100 / 5 ** 2, 10))
  })

  it('is a direction, in the scale that is given', () => {
    const { direction, tint } = lightOf(new Vector3(0, 0, -7), 5e-4)
    expect(direction.toArray()).toEqual([0, 0, -1])
    tint.toArray().forEach(value => expect(value).toBeCloseTo(5, 12))
  })
})

it('no triangle of the mesh cuts the sphere of air, and none is far outside', () => {
  const position = circumscribedSphere(2).getAttribute('position')
  const [triangle, nearest, center] = [new Triangle(), new Vector3(), new Vector3()]
  for (let i = 0; i < position.count; i += 3) {
    triangle.setFromAttributeAndIndices(position, i, i + 1, i + 2)
    expect(triangle.closestPointToPoint(center, nearest).length()).toBeGreaterThan(2 - 1e-5)
    for (const corner of [triangle.a, triangle.b, triangle.c]) {
      expect(corner.length()).toBeLessThan(2.1)
    }
  }
})
