import fc from 'fast-check'
import { Group, Matrix4, Object3D, PerspectiveCamera, Scene, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { ecefFromTilesGroup, Ellipsoid, FloatingOrigin } from '@welkin/geo'
import { latitude, longitude, number, runs } from './arbitraries'

const earth = Ellipsoid.WGS84

function globeScene(positionECEF: Vector3) {
  const scene = new Scene()
  const world = new Group()
  const marker = new Object3D()
  const frame = earth.localYUpFrame(positionECEF)
  frame.decompose(world.position, world.quaternion, world.scale)
  world.position.set(0, 0, 0)
  marker.position.copy(positionECEF).applyQuaternion(world.quaternion.clone().invert())
  const camera = new PerspectiveCamera(50, 1.6, 1, 1e6)
  camera.position.copy(positionECEF).addScaledVector(earth.surfaceNormal(positionECEF), 2)
  camera.up.copy(earth.surfaceNormal(positionECEF))
  camera.lookAt(positionECEF.clone().add(new Vector3(10, 20, 30)))
  world.add(marker)
  scene.add(world)
  scene.updateMatrixWorld(true)
  camera.updateMatrixWorld(true)
  return { scene, world, marker, camera }
}

function viewOf(object: Object3D, camera: PerspectiveCamera): Matrix4 {
  return new Matrix4().multiplyMatrices(camera.matrixWorldInverse, object.matrixWorld)
}

function expectSame(a: Matrix4, b: Matrix4, tolerance: number): void {
  a.elements.forEach((value, i) => expect(Math.abs(value - b.elements[i])).toBeLessThan(tolerance))
}

describe('FloatingOrigin', () => {
  it('moves nothing in the picture, and keeps the place on Earth', () => {
    fc.assert(
      fc.property(longitude, latitude, number(-500, 1e7), (lon, lat, height) => {
        const position = earth.geodeticToECEF({ longitude: lon, latitude: lat, height })
        const { world, marker, camera } = globeScene(position)
        const before = viewOf(marker, camera)
        const cameraECEF = camera.position.clone()
        const origin = new FloatingOrigin(world, camera)
        expect(origin.update()).toBe(true)
        expect(camera.position.length()).toBeLessThan(1)
        expectSame(viewOf(marker, camera), before, 1e-7)
        const again = camera.position.clone().applyMatrix4(origin.worldToECEF)
        expect(again.distanceTo(cameraECEF)).toBeLessThan(1e-8)
        expect(origin.update()).toBe(false)
      }),
      runs
    )
  })

  it('adds no error in a thousand rebases', () => {
    const position = earth.geodeticToECEF({ longitude: 7.1, latitude: 46.3, height: 1234.5 })
    const { world, camera } = globeScene(position)
    const start = camera.position.clone()
    const rootStart = world.position.clone()
    const origin = new FloatingOrigin([world], camera)
    for (let i = 1; i <= 1000; ++i) {
      origin.rebase(new Vector3(Math.sin(i) * 2e5, Math.cos(3 * i) * 2e5, Math.sin(7 * i) * 2e5))
    }
    const total = new Vector3().setFromMatrixPosition(origin.worldToECEF)
    origin.rebase(total.clone().negate())
    expect(camera.position.distanceTo(start)).toBeLessThan(1e-8)
    expect(world.position).toEqual(rootStart)
    expect(new Vector3().setFromMatrixPosition(origin.worldToECEF).length()).toBe(0)
  })

  it('starts from any frame and unit', () => {
    const position = earth.geodeticToECEF({ longitude: -70, latitude: -33, height: 0 })
    const worldToECEF = earth
      .localYUpFrame(position)
      .multiply(new Matrix4().makeScale(1000, 1000, 1000))
    const camera = new PerspectiveCamera()
    camera.position.set(120.25, 3.5, -48)
    const before = camera.position.clone().applyMatrix4(worldToECEF)
    const origin = new FloatingOrigin(new Group(), camera, { worldToECEF, threshold: 100 })
    expect(origin.update()).toBe(true)
    const after = camera.position.clone().applyMatrix4(origin.worldToECEF)
    expect(after.distanceTo(before)).toBeLessThan(1e-6)
    expect(origin.worldToECEF).not.toBe(worldToECEF)
  })

  it('shifts once a camera that is inside a root, and what has turned or scaled parents', () => {
    const scene = new Scene()
    scene.rotation.set(0.3, 0.5, 0.7)
    scene.scale.setScalar(2)
    const world = new Group()
    const camera = new PerspectiveCamera()
    const marker = new Object3D()
    marker.position.set(1e6, 3, 4)
    camera.position.set(1e6, 0, 0)
    world.add(camera, marker)
    scene.add(world)
    scene.updateMatrixWorld(true)
    const before = viewOf(marker, camera)
    const origin = new FloatingOrigin(world, camera)
    origin.update()
    expect(new Vector3().setFromMatrixPosition(camera.matrixWorld).length()).toBeLessThan(1)
    expectSame(viewOf(marker, camera), before, 1e-8)
  })

  it('shifts roots that keep their matrix by hand', () => {
    const root = new Group()
    root.matrixAutoUpdate = false
    root.matrix.makeTranslation(5, 6, 7)
    const origin = new FloatingOrigin(root, new PerspectiveCamera())
    origin.rebase(new Vector3(1, 2, 3))
    expect(new Vector3().setFromMatrixPosition(root.matrixWorld)).toEqual(new Vector3(4, 4, 4))
  })

  it('tells by how much', () => {
    const camera = new PerspectiveCamera()
    camera.position.set(20000.25, 0, 0)
    const origin = new FloatingOrigin(new Group(), camera)
    const offsets: Vector3[] = []
    origin.addEventListener('rebase', ({ offset }) => offsets.push(offset))
    origin.update()
    expect(offsets).toEqual([new Vector3(20000, 0, 0)])
    expect(camera.position.x).toBe(0.25)
  })
})

describe('3D Tiles groups', () => {
  it('has ECEF inside the group, wherever the group is', () => {
    const place = { longitude: 139.77, latitude: 35.68, height: 30 }
    const positionECEF = earth.geodeticToECEF(place)
    const group = new Group()
    // As 3d-tiles-renderer's ReorientationPlugin: the place at the origin, Y up, any unit.
    const toLocal = earth.localYUpFrame(positionECEF).invert()
    toLocal.premultiply(new Matrix4().makeScale(0.01, 0.01, 0.01))
    toLocal.decompose(group.position, group.quaternion, group.scale)
    const parent = new Group()
    parent.position.set(5, 0, 0)
    parent.add(group)
    const worldToECEF = ecefFromTilesGroup(group)
    const origin = new Vector3(5, 0, 0).applyMatrix4(worldToECEF)
    expect(origin.distanceTo(positionECEF)).toBeLessThan(1e-5)
    const up = new Vector3(0, 1, 0).transformDirection(worldToECEF)
    expect(up.distanceTo(earth.surfaceNormal(positionECEF))).toBeLessThan(1e-9)
    expect(worldToECEF.getMaxScaleOnAxis()).toBeCloseTo(100, 9)
  })

  it('agrees with the floating origin', () => {
    const group = new Group()
    const camera = new PerspectiveCamera()
    camera.position.set(6378137, 1234.5, -9e5)
    const origin = new FloatingOrigin(group, camera)
    origin.update()
    expect(ecefFromTilesGroup(group).elements).toEqual(origin.worldToECEF.elements)
  })
})
