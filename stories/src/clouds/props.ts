import { Ellipsoid } from '@welkin/geo'
import {
  BoxGeometry,
  Group,
  LatheGeometry,
  Mesh,
  MeshStandardMaterial,
  SphereGeometry,
  Vector2
} from 'three'
import type { Camera } from 'three'
import type { Place } from '../globe/places'

/** Things that are small against the clouds. */
export interface Props {
  readonly object: Group
  /** Follows the camera, where they go with it. */
  follow(camera: Camera): void
  dispose(): void
}

/** @param follow - Follows the camera. */
function propsOf(object: Group, follow: (camera: Camera) => void = () => {}): Props {
  return {
    object,
    follow,
    dispose() {
      object.removeFromParent()
      object.traverse(child => {
        if (!(child instanceof Mesh)) return
        child.geometry.dispose()
        ;(child.material as MeshStandardMaterial).dispose()
      })
    }
  }
}

/** The frame of a cockpit's windows, a metre ahead. */
export function createCockpit(): Props {
  const object = new Group()
  const frame = new MeshStandardMaterial({ color: '#1b1d20', roughness: 0.6 })
  const part = (x: number, y: number, z: number, size: [number, number], turn = 0): void => {
    const mesh = new Mesh(new BoxGeometry(...size, 0.01), frame)
    mesh.position.set(x, y, z)
    mesh.rotation.z = turn
    object.add(mesh)
  }
  part(0, -0.56, -0.9, [3.2, 0.4])
  part(0, -0.355, -0.88, [3.2, 0.02])
  part(0, 0.55, -0.9, [3.2, 0.16])
  for (const side of [-1, 1]) part(side * 0.62, 0.1, -0.91, [0.06, 1.3], side * 0.35)
  return propsOf(object, camera => {
    object.position.copy(camera.position)
    object.quaternion.copy(camera.quaternion)
  })
}

/** Colour, metres to the right, up and ahead of each balloon. */
const BALLOONS: readonly [string, number, number, number][] = [
  ['#c8321f', -22, -6, 60],
  ['#e0a526', 30, 10, 130],
  ['#2456a6', -70, 22, 240],
  ['#d9d4c6', 60, -46, 340],
  ['#8a2f7a', -20, -30, 500],
  ['#2f8f4f', 170, 50, 620]
]

/** Hot-air balloons of 16 m before a place, one farther away than the other. */
export function createBalloons(place: Place): Props {
  const object = new Group() // x to the right, y up, z back
  const profile: [number, number][] = [
    [1.2, -9.5],
    [2.6, -8],
    [5.6, -4],
    [7.5, 0],
    [7.9, 2.5],
    [7, 5.6],
    [4.6, 7.8],
    [0, 8.8]
  ]
  const envelope = new LatheGeometry(
    profile.map(([x, y]) => new Vector2(x, y)),
    32
  )
  const band = new SphereGeometry(8, 32, 4, 0, 2 * Math.PI, Math.PI / 2 - 0.22, 0.44)
  const basket = new BoxGeometry(1.6, 1.3, 1.6)
  const wicker = new MeshStandardMaterial({ color: '#5a4028', roughness: 0.9 })
  const white = new MeshStandardMaterial({ color: '#e6e2d8', roughness: 0.7 })
  for (const [color, right, above, ahead] of BALLOONS) {
    const balloon = new Group()
    const fabric = new MeshStandardMaterial({ color, roughness: 0.7 })
    balloon.add(new Mesh(envelope, fabric), new Mesh(band, white))
    balloon.children[1].position.y = 2
    const hanging = new Mesh(basket, wicker)
    hanging.position.y = -13
    balloon.add(hanging)
    balloon.position.set(right, above, -ahead)
    object.add(balloon)
  }
  Ellipsoid.WGS84.localYUpFrame(Ellipsoid.WGS84.geodeticToECEF(place), object.matrix).decompose(
    object.position,
    object.quaternion,
    object.scale
  )
  object.rotateY((-place.heading * Math.PI) / 180)
  return propsOf(object)
}
