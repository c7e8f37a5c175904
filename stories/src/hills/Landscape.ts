import {
  type BufferAttribute,
  Color,
  DoubleSide,
  Float32BufferAttribute,
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  PlaneGeometry,
  Quaternion,
  Vector3
} from 'three'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import { setFoliage } from '../valley/leaves'
import { branchedSpruce, leafyTree } from '../valley/treeShapes'
import { hedgeDistance, soilMaterial, type Soil } from './soil'

/** Half width of the hills [m]. */
const EXTENT = 60_000
/** Quads along a side. */
const QUADS = 500
/** Trees of either kind, and distances within which they stand [m]. */
const TREES = 420
const NEAREST_TREE = 55
const FARTHEST_TREE = 2600
/** Groves, of spruces every other one. */
const GROVES = 16

/** Pseudo-random number of a lattice point, in [0, 1). */
function random(x: number, y: number): number {
  const value = Math.sin(x * 127.1 + y * 311.7) * 43_758.5453
  return value - Math.floor(value)
}

const fade = (t: number): number => t * t * (3 - 2 * t)
const mix = (a: number, b: number, t: number): number => a + (b - a) * t

/** Value noise with unit cells, in [0, 1]. */
function valueNoise(x: number, y: number): number {
  const column = Math.floor(x)
  const row = Math.floor(y)
  const across = fade(x - column)
  const near = mix(random(column, row), random(column + 1, row), across)
  const far = mix(random(column, row + 1), random(column + 1, row + 1), across)
  return mix(near, far, fade(y - row))
}

/** Low swells of the level middle, by which one sees its fields; none at the camera [m]. */
function swell(x: number, z: number): number {
  const distance = Math.hypot(x, z)
  const part = Math.min(Math.max((distance - 40) / 400, 0), 1)
  const noise = valueNoise(x / 330 + 40, z / 330) + 0.4 * valueNoise(x / 120, z / 120 + 7)
  return 13 * fade(part) * (noise - 0.55)
}

/** Quads that a period of the noise needs at least. Fewer: crests are teeth, which comb light shafts of a low sun. */
const PERIOD_QUADS = 3.5

/** Distance of grid lines from the middle, for lines of even numbers in [−1, 1] [m]. */
const stretch = (t: number): number => EXTENT * (0.08 * t + 0.92 * t ** 3)

/** Width of quads at a distance from the middle [m]. */
function spacingAt(distance: number): number {
  let t = Math.cbrt(distance / EXTENT)
  for (let i = 0; i < 3; i++) t -= (stretch(t) - distance) / (EXTENT * (0.08 + 2.76 * t * t))
  return ((EXTENT * 2) / QUADS) * (0.08 + 2.76 * t * t)
}

/** Quads over which crests are round. Less: where they cross the grid askew they are teeth, too. */
const ROUND = 1.2

/** Height of the hills: ridged noise of seven octaves that the grid can hold, nearly level within 1.5 km of the middle [m]. */
export function hillHeight(x: number, z: number): number {
  const spacing = spacingAt(Math.max(Math.abs(x), Math.abs(z)))
  let sum = 0
  for (let octave = 0; octave < 7; octave++) {
    const scale = 2.1 ** octave / 9000
    const part = Math.min(Math.max(2 / (scale * PERIOD_QUADS * spacing) - 1, 0), 1)
    if (part === 0) break
    const noise = valueNoise(x * scale + 17 * octave, z * scale - 9 * octave)
    sum +=
      part *
      0.45 ** octave *
      Math.max(1 - Math.hypot(2 * noise - 1, 3 * ROUND * scale * spacing), 0) ** 2
  }
  const rise = Math.min(Math.max((Math.hypot(x, z) - 1500) / 6000, 0), 1)
  return 900 * rise * sum - 2 + swell(x, z) * (1 - rise)
}

/** Hills that bend with a planet, finer about the middle. */
function hills(radius: number, soil: Soil): Mesh {
  const geometry = new PlaneGeometry(2, 2, QUADS, QUADS).rotateX(-Math.PI / 2)
  const positions = geometry.attributes.position as BufferAttribute
  const heights = new Float32Array(positions.count)
  for (let i = 0; i < positions.count; i++) {
    const x = stretch(positions.getX(i))
    const z = stretch(positions.getZ(i))
    heights[i] = hillHeight(x, z)
    positions.setXYZ(i, x, heights[i] - (x * x + z * z) / (2 * radius), z)
  }
  geometry.setAttribute('height', new Float32BufferAttribute(heights, 1))
  geometry.computeVertexNormals()
  const mesh = new Mesh(geometry, soilMaterial(soil))
  mesh.castShadow = mesh.receiveShadow = true
  mesh.frustumCulled = false
  return mesh
}

/** A random place about a middle, at a distance up to `reach` [m]. */
function placeAbout(x: number, z: number, seed: number, nearest: number, reach: number): Vector3 {
  const angle = 2 * Math.PI * random(seed, 1)
  const distance = nearest + (reach - nearest) * random(seed, 2) ** 1.5
  return new Vector3(x + distance * Math.cos(angle), 0, z + distance * Math.sin(angle))
}

/** Place of a tree: in a hedge between fields, or in one of the groves, most of which are of its kind. */
function treePlace(seed: number, kind: number): Vector3 | null {
  if (random(seed, 3) > (kind === 0 ? 0.15 : 0.85)) {
    const place = placeAbout(0, 0, seed, NEAREST_TREE, FARTHEST_TREE)
    return hedgeDistance(place.x, place.z) < 4 ? place : null
  }
  const grove =
    2 * Math.floor((GROVES / 2) * random(seed, 4)) + Number(random(seed, 5) < 0.2) + kind
  const middle = placeAbout(0, 0, 1000 + grove, 500, FARTHEST_TREE)
  return placeAbout(middle.x, middle.z, seed + 0.5, 0, 30 + 50 * random(grove, 6))
}

/** Broad-leaved trees and spruces, 4 to 10 m high. */
function trees(): Group {
  const kinds = [leafyTree('lime', 8), branchedSpruce(8, 5)]
  const material = new MeshStandardNodeMaterial({
    roughness: 1,
    vertexColors: true,
    side: DoubleSide
  })
  setFoliage(material)
  const group = new Group()
  for (const [kind, geometry] of kinds.entries()) {
    const mesh = new InstancedMesh(geometry, material, TREES)
    let count = 0
    for (let seed = kind * 50_000; count < TREES && seed < kind * 50_000 + 40_000; seed++) {
      const place = treePlace(seed, kind)
      if (place === null) continue
      place.y = hillHeight(place.x, place.z) - 0.2
      const size = 0.45 + 0.55 * random(seed, 7)
      const width = size * (0.85 + 0.35 * random(seed, 8))
      const turn = new Quaternion().setFromAxisAngle(new Vector3(0, 1, 0), 6.3 * random(seed, 9))
      mesh.setMatrixAt(count, new Matrix4().compose(place, turn, new Vector3(width, size, width)))
      const tint = random(seed, 10)
      mesh.setColorAt(count, new Color(1.3 + tint, 1.3 + 0.6 * tint, 1.3))
      count++
    }
    mesh.count = count
    mesh.castShadow = mesh.receiveShadow = true
    group.add(mesh)
  }
  return group
}

/** Landscape about the camera of a still, in a Y-up frame on the ground. */
export class Landscape extends Group {
  /** @param radius - Radius of the planet [m]. */
  constructor(radius: number, soil: Soil, hasTrees: boolean) {
    super()
    this.add(hills(radius, soil))
    if (hasTrees) this.add(trees())
  }

  override dispose(): void {
    this.traverse(object => {
      if (!(object instanceof Mesh)) return
      object.geometry.dispose()
      object.material.dispose()
      if (object instanceof InstancedMesh) object.dispose()
    })
  }
}
