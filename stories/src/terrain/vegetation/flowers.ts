import { BufferGeometry, DoubleSide, Float32BufferAttribute, Mesh } from 'three'
import {
  attribute,
  mix,
  positionGeometry,
  sin,
  smoothstep,
  step,
  transformNormalToView,
  varying,
  vec3
} from 'three/tsl'
import type { PlantCells } from './PlantCells'
import {
  plantGeometry,
  PlantMaterial,
  plantNodes,
  type Float,
  type PlantUniforms,
  type Vec3
} from './plantShader'

/** Colours of petals, linear sRGB: daisy, buttercup, gentian and clover; a flower's tint is their number. */
const PETALS = [
  [0.75, 0.74, 0.68],
  [0.72, 0.5, 0.02],
  [0.1, 0.07, 0.5],
  [0.5, 0.1, 0.28]
] as const

/** Kinds of flowers. */
export const FLOWERS = PETALS.length

const STEM = [0.06, 0.11, 0.025] as const
const HEART = [0.7, 0.42, 0.02] as const

/** Radius of a flower and height of its stem [m], and number of its petals. */
const RADIUS = 0.024
const HEIGHT = 0.36
const SIDES = 7

/** Radius of a flower that is half a pixel, at a distance of 1 m [m], and distances between which flowers go [m]. */
const HALF_PIXEL = 0.0008
export const GOES = [34, 44] as const

/** A flower on its stem: `petal` is 1 at the petals' ends, 0 in its heart, and −1 on the stem. */
function flower(): BufferGeometry {
  const positions = [0, HEIGHT, 0]
  const petals = [0]
  const indices: number[] = []
  for (let i = 0; i < SIDES; i++) {
    const angle = (2 * Math.PI * i) / SIDES
    positions.push(RADIUS * Math.cos(angle), HEIGHT + 0.15 * RADIUS, RADIUS * Math.sin(angle))
    petals.push(1)
    indices.push(0, 1 + ((i + 1) % SIDES), 1 + i)
  }
  const stem = positions.length / 3
  positions.push(-0.002, 0, 0, 0.002, 0, 0, 0, HEIGHT, 0)
  petals.push(-1, -1, -1)
  indices.push(stem, stem + 1, stem + 2)
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3))
  geometry.setAttribute('petal', new Float32BufferAttribute(petals, 1))
  geometry.setIndex(indices)
  return geometry
}

/** Flowers of a meadow. */
export function createFlowers(cells: PlantCells, uniforms: PlantUniforms): Mesh {
  const material = new PlantMaterial({ side: DoubleSide })
  material.fog = false
  const { foot, size, random, rank, tint, distance, turned } = plantNodes(uniforms)
  const petal = attribute<'float'>('petal', 'float') as unknown as Float
  const shown = smoothstep(GOES[0], GOES[1], distance).oneMinus().mul(size.min(1))
  const place = positionGeometry as unknown as Vec3
  const wide = distance.mul(HALF_PIXEL / RADIUS).max(1)
  const tilted = vec3(
    place.x.mul(wide),
    place.y.add(place.x.mul(0.6).mul(petal.max(0))),
    place.z.mul(wide)
  )
  const sway = sin(uniforms.time.mul(2.1).add(foot.x).add(random.mul(6))).mul(place.y.mul(0.05))
  const lean = vec3(place.y.mul(rank.sub(0.5)).mul(0.5).add(sway), 0, 0)
  material.positionNode = foot.add(turned(tilted.add(lean).mul(shown).mul(size)))
  material.normalNode = varying(
    transformNormalToView(turned(vec3(-0.4, 1, 0).normalize() as never) as never) as unknown as Vec3
  )
  const [stem, heart, ...petals] = [STEM, HEART, ...PETALS].map(([r, g, b]) => vec3(r, g, b))
  const colored = petals.reduce(
    (color, next, i) => mix(color, next, step(i - 0.5, tint)) as unknown as typeof color
  )
  const flowered = mix(heart, colored, smoothstep(0.15, 0.5, petal))
  material.colorNode = mix(stem, flowered, step(-0.5, petal)) as unknown as Vec3
  const mesh = new Mesh(plantGeometry(flower(), cells), material)
  mesh.receiveShadow = true
  mesh.frustumCulled = false
  return mesh
}
