import { Atmosphere } from '@welkin/atmosphere'
import fc from 'fast-check'
import { Raycaster, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { GridHeights } from '../src/data/GridHeights'
import type { HeightSource } from '../src/heights/HeightSource'
import { Terrain } from '../src/Terrain'
import { distanceTo, noTiles, TileTree } from '../src/tiles/TileTree'
import { FlatFigure } from '../src/tiles/cpu/figure'
import { Walker } from '../src/walk/Walker'

/** A plane that rises to the east by 0.2 and falls to the south by 0.1. */
const slope: HeightSource = {
  lowest: -3e5,
  highest: 3e5,
  variation: distance => 0.23 * distance,
  sampleAt({ x, z }, target) {
    target.height = 10 + 0.2 * x - 0.1 * z
    target.gradient.set(0.2, 0, -0.1)
    return target
  },
  sample: () => {
    throw new Error('not drawn here')
  }
}

const atmosphere = new Atmosphere({ flat: true, metersPerUnit: 2 })
const terrain = new Terrain(atmosphere, slope, { resolution: 4, seaLevel: -Infinity })
const far = fc.double({ min: -1e5, max: 1e5, noNaN: true })

describe('in a flat world', () => {
  it('heights are those of the source below a place, in metres', () => {
    fc.assert(
      fc.property(far, far, (x, z) => {
        const position = new Vector3(x / 2, 77, z / 2)
        expect(terrain.heightBelow(position)).toBeCloseTo(10 + 0.2 * x - 0.1 * z, 6)
      })
    )
  })

  it('rays end on the ground, and know its normal', () => {
    fc.assert(
      fc.property(far, far, far, far, (x, z, toX, toZ) => {
        const from = new Vector3(x, 6e4, z).divideScalar(2)
        const to = new Vector3(toX, 10 + 0.2 * toX - 0.1 * toZ, toZ).divideScalar(2)
        const direction = to.clone().sub(from).normalize()
        const raycaster = new Raycaster(from, direction)
        // From above only: a ray of the plane's own slope may graze it.
        if (direction.y > -0.3) return
        const [hit] = raycaster.intersectObject(terrain)
        expect(hit.point.distanceTo(to)).toBeLessThan(1e-3)
        expect(hit.normal!.angleTo(new Vector3(-0.2, 1, 0.1))).toBeLessThan(1e-9)
      })
    )
    const up = new Raycaster(new Vector3(0, 100, 0), new Vector3(0, 1, 0))
    expect(up.intersectObject(terrain)).toEqual([])
  })

  it('a walker goes up the slope at its speed, and stands on it', () => {
    const walker = new Walker(terrain, { speed: 3 }).moveTo(new Vector3(0, 20, 0))
    for (let i = 0; i < 60 * 20; i++) walker.update(new Vector3(1, 0, 0), false, 1 / 60)
    const eye = walker.eyePosition(new Vector3()).multiplyScalar(2)
    expect(walker.state).toBe('standing')
    expect(eye.y - 1.7).toBeCloseTo(10 + 0.2 * eye.x - 0.1 * eye.z, 3)
    expect(eye.z).toBeCloseTo(0, 1)
    expect(eye.x).toBeGreaterThan(45)
    expect(eye.x).toBeLessThan(61)
  })
})

describe('tiles of a plane', () => {
  const tree = new TileTree(new FlatFigure(), slope, 12, 1.5)

  it('have the distance of their squares', () => {
    const [tile] = tree.roots[0].split(tree.figure, slope)
    const half = tile.radius / Math.SQRT2
    fc.assert(
      fc.property(far, far, far, (x, y, z) => {
        const point = new Vector3(20 * x, y, 20 * z)
        const nearest = point
          .clone()
          .clamp(
            new Vector3(tile.center.x - half, 0, tile.center.z - half),
            new Vector3(tile.center.x + half, 0, tile.center.z + half)
          )
        expect(distanceTo(tile, point)).toBeCloseTo(point.distanceTo(nearest), 5)
      })
    )
  })

  it('cover the view, each place once', () => {
    const viewer = {
      position: new Vector3(300, 40, -700),
      datumPoint: new Vector3(300, 20, -700),
      planes: [],
      seaLevel: -Infinity,
      isOverGround: false,
      clearance: 1,
      shadowDistance: 0,
      direction: new Vector3(0, 1, 0),
      occluder: 1,
      horizon: Infinity,
      cosHorizon: -1
    }
    const { tiles } = tree.select(viewer, 1e5, noTiles(), false)
    const area = tiles.reduce((sum, { radius }) => sum + 2 * radius ** 2, 0)
    expect(area / (2 ** 21) ** 2).toBeCloseTo(1, 9)
    expect(new Set(tiles.map(({ level }) => level)).size).toBeGreaterThan(8)
  })
})

it('a grid in metres lies to the east along X and to the south along Z', () => {
  const [width, height] = [40, 20]
  const values = Array.from({ length: width * height }, (_, i) => {
    const x = -200 + 10 * ((i % width) + 0.5)
    const z = -100 + 10 * (Math.floor(i / width) + 0.5)
    return 0.3 * x - 0.5 * z
  })
  const area = { width, height, west: -200, east: 200, south: -100, north: 100 }
  const grid = new GridHeights(values, { ...area, units: 'meters', outside: 7, fade: 50 })
  const at = (x: number, z: number) =>
    grid.sampleAt(new Vector3(x, 0, z), { height: 0, gradient: new Vector3() })
  fc.assert(
    fc.property(
      fc.double({ min: -170, max: 170, noNaN: true }),
      fc.double({ min: -70, max: 70, noNaN: true }),
      (x, z) => {
        const { height, gradient } = at(x, z)
        expect(height).toBeCloseTo(0.3 * x - 0.5 * z, 3)
        expect(gradient.distanceTo(new Vector3(0.3, 0, -0.5))).toBeLessThan(1e-4)
      }
    )
  )
  expect(at(900, 0).height).toBe(7)
  expect(at(0, 900).height).toBe(7)
  expect(() => new GridHeights(values, { ...area, units: 'miles' as never })).toThrow(
    'units must be degrees or meters'
  )
  expect(() => new GridHeights(values, area)).toThrow('GridHeights: ')
})
