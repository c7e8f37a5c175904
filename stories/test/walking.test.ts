import { BoxGeometry, Color, Matrix4, Mesh, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { footingOn } from '../src/importedModel/footing'
import { topOf } from '../src/moving/obstacles'
import { groundHeight } from '../src/valley/ground'
import { valleyFooting } from '../src/valley/footing'
import { LAKE } from '../src/valley/places'
import { trunkTops } from '../src/valley/trunks'
import { outlines } from '../src/valley/village'
import { explore } from './explore'

/** Everyone walks towards −z, who is put at a place with the feet on the ground. */
function walk(options: Parameters<typeof explore>[0], x: number, z: number, heading = 0) {
  const scene = explore(options)
  const y = (options?.footingAt ?? options?.groundAt ?? (() => 0))(new Vector3(x, 0, z)) + 1.7
  scene.explorer.state = { x, y, z, heading, pitch: 0, walking: 1 }
  scene.press('KeyW')
  return scene
}

describe('walls', () => {
  const house = { x: 0, z: -20, width: 10, depth: 8, turn: 0.3, top: 6 }
  const roofAt = topOf([house])
  const footingAt = (place: Vector3): number => Math.max(roofAt(place), 0)

  it('stop those who walk into them, and not those who fly', () => {
    const { camera, explorer, press, run } = walk({ footingAt }, 0.4, 0)
    for (let i = 0; i < 60; i++) {
      run(0.2)
      expect(roofAt(camera.position)).toBe(-Infinity)
      expect(camera.position.y).toBeCloseTo(1.7)
    }
    press('KeyF')
    run(0.1)
    explorer.state = { x: 0, y: 1.7, z: -10, heading: 0, pitch: 0, walking: 0 }
    run(8)
    expect(camera.position.z).toBeLessThan(-26)
  })

  it('are slipped along', () => {
    const { camera, run } = walk({ footingAt }, 4, 0)
    run(25)
    // The wall is turned: one comes around its corner.
    expect(camera.position.z).toBeLessThan(-30)
    expect(roofAt(camera.position)).toBe(-Infinity)
  })

  it('of a model are where its meshes are', () => {
    const mesh = new Mesh(new BoxGeometry(4, 6, 4))
    mesh.position.set(0, 3, -10)
    mesh.updateMatrixWorld()
    const on = footingOn([mesh])
    expect(on(new Vector3(0, 0, -10))).toBeCloseTo(6)
    expect(on(new Vector3(0, 0, -7.7))).toBeCloseTo(6)
    expect(on(new Vector3(0, 0, -7.5))).toBe(0)
  })
})

describe('trees', () => {
  const places = [
    [0.4, -8],
    [5, 3],
    [-4.1, -3.9]
  ] as const
  const trees = places.map(([x, z], i) => ({
    matrix: new Matrix4().makeScale(1 + i, 2, 1 + i).setPosition(x, -1, z),
    color: new Color()
  }))
  const trunkAt = trunkTops(trees, () => 7)

  it('have trunks as wide as they are large, with room for a body', () => {
    for (const [i, [x, z]] of places.entries()) {
      const radius = 0.3 * (1 + i)
      for (const [dx, dz] of [
        [1, 0],
        [0, 1],
        [-1, 0],
        [0, -1]
      ] as const) {
        const at = (way: number): number => trunkAt({ x: x + way * dx, z: z + way * dz })
        expect(at(radius + 0.5)).toBe(11)
        expect(at(radius + 0.7)).toBe(-Infinity)
      }
    }
  })

  it('are walked around', () => {
    const footingAt = (place: Vector3): number => Math.max(trunkAt(place), 7)
    const { camera, run } = walk({ footingAt }, 0, 0)
    for (let i = 0; i < 60; i++) {
      run(0.1)
      expect(camera.position.y).toBeCloseTo(8.7)
      expect(trunkAt(camera.position)).toBe(-Infinity)
    }
    expect(camera.position.z).toBeLessThan(-11)
  })

  it('of the valley are in the way while they are shown', () => {
    const options = valleyFooting(() => ({ village: false, water: false }), trunkAt)
    const [x, z] = places[0]
    expect(options.footingAt(new Vector3(x, 0, z))).toBe(11)
    expect(options.footingAt(new Vector3(x + 3, 0, z))).toBe(groundHeight(x + 3, z))
  })
})

describe('the valley', () => {
  const shown = { village: true, water: true }
  const options = valleyFooting(() => shown)

  it('has houses that nobody walks through, from any side', () => {
    const [house] = outlines()
    const inside = topOf([{ ...house, top: 1 }], 0)
    for (let i = 0; i < 8; i++) {
      const angle = (i * Math.PI) / 4
      const [x, z] = [house.x + 11 * Math.sin(angle), house.z + 11 * Math.cos(angle)]
      if (options.footingAt(new Vector3(x, 0, z)) > groundHeight(x, z)) continue
      const heading = -(angle * 180) / Math.PI
      const { camera, run } = walk({ groundAt: options.footingAt, ...options }, x, z, heading)
      for (let j = 0; j < 40; j++) {
        run(0.2)
        expect(inside(camera.position)).toBe(-Infinity)
      }
    }
  })

  it('has a lake that one wades into, more slowly, and swims in', () => {
    const { camera, press, run } = walk({ ...options }, LAKE.x, -250)
    let [deepest, slowest] = [Infinity, Infinity]
    for (let i = 0; i < 400; i++) {
      const before = camera.position.z
      run(1)
      deepest = Math.min(deepest, camera.position.y)
      slowest = Math.min(slowest, before - camera.position.z)
      const { x, z } = camera.position
      const onFoot = Math.max(groundHeight(x, z), LAKE.height - 1) + 1.7
      expect(camera.position.y).toBeCloseTo(onFoot, 1)
    }
    // Eyes stay above the water, in the middle of the lake too.
    expect(deepest).toBeCloseTo(LAKE.height + 0.7)
    expect(slowest).toBeLessThan(0.5 * 3)
    expect(slowest).toBeGreaterThan(0.3 * 3)
    const { y } = camera.position
    press('Space')
    run(0.2)
    expect(camera.position.y).toBeCloseTo(y, 1)
  })

  it('is bare ground without its village and its lake', () => {
    const bare = valleyFooting(() => ({ village: false, water: false }))
    const [{ x, z }] = outlines()
    expect(bare.footingAt(new Vector3(x, 0, z))).toBe(groundHeight(x, z))
    expect(options.footingAt(new Vector3(x, 0, z))).toBeGreaterThan(groundHeight(x, z) + 4)
    expect(bare.waterAt(new Vector3(LAKE.x, 0, LAKE.z))).toBe(-Infinity)
    expect(options.waterAt(new Vector3(LAKE.x, 0, LAKE.z))).toBe(LAKE.height)
  })
})
