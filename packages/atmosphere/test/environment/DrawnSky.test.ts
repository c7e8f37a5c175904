import { PerspectiveCamera, Vector3 } from 'three'
import { expect, it } from 'vitest'
import { Atmosphere, distanceFog, heightFog } from '@welkin/atmosphere'
import { DrawnSky } from '../../src/environment/DrawnSky'
import { AtmosphereView } from '../../src/view/AtmosphereView'

const degree = Math.PI / 180

/** An environment that was drawn at 2 m with a sun 45° high, and what it says of later views. */
function drawn() {
  const atmosphere = new Atmosphere()
  const fog = heightFog()
  atmosphere.add(fog)
  const camera = new PerspectiveCamera()
  const look = (height: number, elevation: number): AtmosphereView => {
    camera.position.set(0, height, 0)
    camera.updateMatrixWorld()
    atmosphere.sunDirection = new Vector3(
      0,
      Math.sin(elevation * degree),
      Math.cos(elevation * degree)
    )
    const view = new AtmosphereView(atmosphere, camera, atmosphere.sun)
    // No tables are baked: there is no volume, and no need of a renderer.
    view.update(null as never)
    return view
  }
  const sky = new DrawnSky(atmosphere)
  sky.set(look(2, 45))
  const isSame = (height = 2, elevation = 45): boolean =>
    sky.resembles(look(height, elevation), 0.1, 0.1)
  return { atmosphere, camera, fog, isSame }
}

it('resembles what was drawn until the sun has moved by the angle', () => {
  const { isSame } = drawn()
  expect(isSame()).toBe(true)
  expect(isSame(2, 45.09)).toBe(true)
  expect(isSame(2, 45.11)).toBe(false)
})

it('resembles it until the camera has climbed, by a part of at least 500 m, however it turns', () => {
  const { camera, isSame } = drawn()
  camera.rotation.set(1, 2, 3)
  expect(isSame(51)).toBe(true)
  expect(isSame(53)).toBe(false)
})

it('is another when layers come, go or change, and when the scale leaves half floats behind', () => {
  const { atmosphere, fog, isSame } = drawn()
  fog.density = 0.5
  expect(isSame()).toBe(false)
  const other = drawn()
  const murk = distanceFog()
  other.atmosphere.add(murk)
  expect(other.isSame()).toBe(false)
  other.atmosphere.remove(murk)
  expect(other.isSame()).toBe(true)
  other.atmosphere.luminanceScale = 0.05
  expect(other.isSame()).toBe(true)
  other.atmosphere.luminanceScale = 0.2
  expect(other.isSame()).toBe(false)
  expect(atmosphere.layers).toContain(fog)
})
