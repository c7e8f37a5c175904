import {
  BoxGeometry,
  CircleGeometry,
  ConeGeometry,
  CylinderGeometry,
  Group,
  IcosahedronGeometry,
  Mesh,
  MeshStandardMaterial,
  PointLight,
  SphereGeometry
} from 'three'
import type { BufferGeometry } from 'three'
import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js'
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js'
import { randomSequence } from '../random'

/** Brightness of a street lamp [cd]. */
const LAMP_CANDELA = 400

type Place = readonly [x: number, y: number, z: number]

const at = (geometry: BufferGeometry, [x, y, z]: Place, turn = 0): BufferGeometry => {
  const placed = geometry.index === null ? geometry : geometry.toNonIndexed()
  return placed.rotateY(turn).translate(x, y, z)
}

const box = (width: number, height: number, depth: number): BufferGeometry =>
  new BoxGeometry(width, height, depth)

/** Parts of the square, by material. */
function partsOf(): Record<
  'stone' | 'wall' | 'roof' | 'iron' | 'leaf' | 'window' | 'lamp',
  BufferGeometry[]
> & {
  lamps: Place[]
} {
  const random = randomSequence(11)
  const parts = {
    stone: [],
    wall: [],
    roof: [],
    iron: [],
    leaf: [],
    window: [],
    lamp: []
  } as Record<'stone' | 'wall' | 'roof' | 'iron' | 'leaf' | 'window' | 'lamp', BufferGeometry[]>
  const house = (angle: number, distance: number, height: number): void => {
    const place = ([x, y, z]: Place): Place => [
      distance * Math.sin(angle) + x * Math.cos(angle) + z * Math.sin(angle),
      y,
      distance * Math.cos(angle) - x * Math.sin(angle) + z * Math.cos(angle)
    ]
    parts.wall.push(at(box(8, height, 7), place([0, height / 2, 0]), angle))
    const roof = new CylinderGeometry(0.1, 5.6, 3.4, 4).rotateY(Math.PI / 4).scale(1.1, 1, 0.95)
    parts.roof.push(at(roof, place([0, height + 1.7, 0]), angle))
    for (let floor = 0; floor < Math.floor(height / 3); floor++) {
      for (const x of [-2.6, 0, 2.6]) {
        if (random() < 0.35) continue
        parts.window.push(at(box(1, 1.4, 0.1), place([x, 1.9 + 3 * floor, -3.5]), angle))
      }
    }
  }
  for (const [i, angle] of [-2.3, -1.75, -1.2, -0.62, 0.62, 1.2, 1.75, 2.3].entries()) {
    house(angle + Math.PI, 19 + 2 * random(), i % 3 === 0 ? 9 : 6)
  }
  // A chapel with a tower, at the end of the square.
  parts.wall.push(at(box(7, 7, 13), [0, 3.5, -21]), at(box(4, 15, 4), [0, 7.5, -13.5]))
  parts.roof.push(
    at(new CylinderGeometry(0.1, 5.2, 4, 4).rotateY(Math.PI / 4).scale(1, 1, 1.8), [0, 9, -21]),
    at(new ConeGeometry(3.2, 6, 4).rotateY(Math.PI / 4), [0, 18, -13.5])
  )
  parts.window.push(at(box(1.2, 2.6, 0.1), [0, 9, -11.5]), at(box(1.4, 2.4, 0.1), [0, 1.2, -11.5]))
  parts.stone.push(
    at(new CircleGeometry(60, 64).rotateX(-Math.PI / 2), [0, 0, 0]),
    at(new CylinderGeometry(2.6, 2.8, 0.7, 24), [0, 0.35, 0]),
    at(new CylinderGeometry(0.3, 0.4, 2.2, 10), [0, 1.1, 0])
  )
  const lamps: Place[] = [-1, 1].flatMap(side => [7, -1, -9].map(z => [side * 7, 4.2, z] as const))
  for (const [x, y, z] of lamps) {
    parts.iron.push(at(new CylinderGeometry(0.06, 0.1, y, 8), [x, y / 2, z]))
    parts.iron.push(at(new ConeGeometry(0.4, 0.3, 8), [x, y + 0.42, z]))
    parts.lamp.push(at(new SphereGeometry(0.24, 12, 8), [x, y + 0.1, z]))
  }
  for (const [x, z] of [
    [-11, 3],
    [11, -5],
    [-11.5, -8],
    [11.5, 7]
  ]) {
    parts.iron.push(at(new CylinderGeometry(0.15, 0.22, 2.4, 7), [x, 1.2, z]))
    parts.leaf.push(at(new IcosahedronGeometry(1.9, 2), [x, 3.7, z]))
  }
  return { ...parts, lamps }
}

const materials = {
  stone: new MeshStandardMaterial({ name: 'stone', color: '#8d8678', roughness: 0.9 }),
  wall: new MeshStandardMaterial({ name: 'wall', color: '#d6c7ac', roughness: 0.95 }),
  roof: new MeshStandardMaterial({ name: 'roof', color: '#8a4a34', roughness: 0.9 }),
  iron: new MeshStandardMaterial({ name: 'iron', color: '#2c2a28', roughness: 0.6 }),
  leaf: new MeshStandardMaterial({ name: 'leaf', color: '#43602f', roughness: 1 }),
  window: new MeshStandardMaterial({ name: 'window', color: '#20262c', emissive: '#ffb566' }),
  lamp: new MeshStandardMaterial({ name: 'lamp', color: '#fff4e0', emissive: '#ffd9a0' })
}

/** A small square as a glTF file with lamps (`KHR_lights_punctual`), as any modelling program would write it. */
export async function squareURL(): Promise<string> {
  const { lamps, ...parts } = partsOf()
  const square = new Group()
  for (const name of Object.keys(parts) as (keyof typeof parts)[]) {
    const mesh = new Mesh(mergeGeometries(parts[name]), materials[name])
    mesh.name = name
    square.add(mesh)
  }
  for (const [x, y, z] of lamps) {
    const light = new PointLight('#ffc98a', LAMP_CANDELA)
    light.position.set(x, y - 0.3, z)
    square.add(light)
  }
  const file = (await new GLTFExporter().parseAsync(square, { binary: true })) as ArrayBuffer
  square.traverse(part => (part as Partial<Mesh>).geometry?.dispose())
  return URL.createObjectURL(new Blob([file], { type: 'model/gltf-binary' }))
}
