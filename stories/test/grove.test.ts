import { Matrix4, PerspectiveCamera, Vector3 } from 'three'
import { beforeAll, describe, expect, it } from 'vitest'
import { createGrove } from '../src/valley/forest'
import { fieldBorder, groundHeight, isOnRoad } from '../src/valley/ground'
import { VILLAGE } from '../src/valley/places'

const COUNT = 400

describe('trees about the village', () => {
  let places: Vector3[] = []

  beforeAll(() => {
    const grove = createGrove(COUNT)
    const camera = new PerspectiveCamera()
    camera.position.set(VILLAGE.x, 1000, VILLAGE.z)
    camera.lookAt(VILLAGE.x, 0, VILLAGE.z)
    grove.update(camera)
    const matrix = new Matrix4()
    places = grove.levels.flatMap(level =>
      Array.from({ length: level.count }, (_, i) => {
        level.getMatrixAt(i, matrix)
        return new Vector3().setFromMatrixPosition(matrix)
      })
    )
    grove.dispose()
  })

  it('are as many as were asked for, none of them on the road, and their trunks of many lengths', () => {
    expect(places).toHaveLength(COUNT)
    const depths: number[] = []
    for (const { x, y, z } of places) {
      expect(isOnRoad(x, z)).toBe(false)
      depths.push(groundHeight(x, z) - y)
    }
    // Crowns begin 2.3 m above the foot of a tree 9 m high; the largest are some 19 m.
    expect(Math.min(...depths)).toBeGreaterThan(0.2)
    expect(Math.max(...depths)).toBeLessThan(4.8)
    expect(depths.filter(depth => depth > 1).length).toBeGreaterThan(0.3 * COUNT)
  })

  it('stand in the village and in rows between fields', () => {
    const isNear = ({ x, z }: Vector3): boolean => Math.hypot(x - VILLAGE.x, z - VILLAGE.z) < 210
    const isInRow = ({ x, z }: Vector3): boolean => {
      const width = fieldBorder(1, z) - fieldBorder(0, z)
      const across = (x - fieldBorder(0, z)) / width
      return (across - Math.floor(across)) * width < 1.5
    }
    expect(places.filter(isNear).length).toBeGreaterThan(0.2 * COUNT)
    // By chance, one of 47 is in a row.
    expect(places.filter(isInRow).length).toBeGreaterThan(0.25 * COUNT)
  })
})
