import { Matrix4, Quaternion, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { OpenSky } from '../src/valley/OpenSky'
import { VILLAGE } from '../src/valley/places'
import { outlines } from '../src/valley/village'

const { x, z } = VILLAGE

describe('OpenSky', () => {
  it('is dark at the foot of a wall, and open a few houses away', () => {
    const sky = new OpenSky()
    sky.addHouses([{ x, z, width: 10, depth: 20, turn: 0 }])
    const beside = [6, 9, 30].map(east => sky.at(x + east, z))
    expect(beside[0]).toBeLessThan(0.7)
    expect(beside[1]).toBeGreaterThan(beside[0])
    expect(beside[2]).toBe(1)
    // It is longer than wide, and turns with the house.
    expect(sky.at(x, z + 9)).toBeLessThan(0.5)
    const turned = new OpenSky()
    turned.addHouses([{ x, z, width: 10, depth: 20, turn: Math.PI / 2 }])
    expect(turned.at(x + 9, z)).toBeLessThan(0.5)
    expect(turned.at(x, z + 9)).toBeGreaterThan(sky.at(x, z + 9))
    for (const each of [sky, turned]) each.dispose()
  })

  it('is half closed below a crown, as wide as the tree', () => {
    const sky = new OpenSky()
    const size = (scale: number): Matrix4 =>
      new Matrix4().compose(
        new Vector3(x + 100 * scale, 0, z),
        new Quaternion(),
        new Vector3(scale, scale, scale)
      )
    sky.addTrees([size(1), size(2)])
    for (const scale of [1, 2]) expect(sky.at(x + 100 * scale, z)).toBeLessThan(0.6)
    expect(sky.at(x + 105, z)).toBe(1)
    expect(sky.at(x + 205, z)).toBeLessThan(1)
    sky.dispose()
  })

  it('leaves out what is beyond the map', () => {
    const sky = new OpenSky()
    sky.addTrees([new Matrix4().makeTranslation(x + 5000, 0, z)])
    expect(sky.at(x + 500, z)).toBe(1)
    sky.dispose()
  })

  it('has all houses of the village on it', () => {
    const houses = outlines()
    for (const house of houses) {
      for (const way of [house.x - x, house.z - z]) expect(Math.abs(way)).toBeLessThan(400)
    }
    expect(houses.length).toBeGreaterThan(40)
  })
})
