import { BufferGeometry, DoubleSide, Float32BufferAttribute, Mesh } from 'three'
import {
  attribute,
  mix,
  positionGeometry,
  sin,
  smoothstep,
  transformNormalToView,
  varying,
  vec3
} from 'three/tsl'
import { randomSequence } from '../../random'
import type { PlantCells } from './PlantCells'
import {
  plantGeometry,
  PlantMaterial,
  plantNodes,
  thinned,
  type Float,
  type PlantUniforms,
  type Vec3
} from './plantShader'

/** Colours of blades, linear sRGB: near those of the ground's grass, and of its straw. */
const GREEN = [0.05, 0.098, 0.021] as const
const STRAW = [0.225, 0.19, 0.085] as const

/** Half of a blade's width at its root [m], and that of a pixel at a distance of 1 m: a blade is no narrower. */
const HALF_WIDTH = 0.004
const HALF_PIXEL = 0.0004

/** Geometry of a tuft. */
interface TuftOptions {
  readonly blades: number
  /** Distance of roots from its middle [m]. */
  readonly radius: number
  /** Lengths of blades [m]. */
  readonly length: readonly [least: number, most: number]
  /** Joints of a blade: 1 is a triangle. */
  readonly joints: number
}

/**
 * Tuft of blades that bend outwards: a vertex is a point of the blade's middle (`position`), with the way to its edge (`aside`) and the
 * part of its length (`tip`).
 */
function tuft({ blades, radius, length, joints }: TuftOptions): BufferGeometry {
  const random = randomSequence(5)
  const [positions, asides, tips, indices] = [[], [], [], []] as number[][]
  for (let blade = 0; blade < blades; blade++) {
    const away = 2 * Math.PI * random()
    const distance = radius * Math.sqrt(random())
    const [rootX, rootZ] = [distance * Math.cos(away), distance * Math.sin(away)]
    const turn = away + 1.6 * (random() - 0.5)
    const long = length[0] + (length[1] - length[0]) * random() ** 1.5
    const lean = 0.15 + 0.75 * random()
    const first = positions.length / 3
    for (let joint = 0; joint <= joints; joint++) {
      const t = joint / joints
      const out = long * lean * t * t
      const up = long * t * (1 - 0.35 * lean * t)
      const isTip = joint === joints
      for (const side of isTip ? [0] : [-1, 1]) {
        positions.push(rootX + out * Math.cos(turn), up, rootZ + out * Math.sin(turn))
        const width = side * (1 - 0.6 * t)
        asides.push(-Math.sin(turn) * width, Math.cos(turn) * width)
        tips.push(t)
      }
      if (isTip) indices.push(first + 2 * joint - 2, first + 2 * joint - 1, first + 2 * joint)
      else if (joint > 0) {
        const a = first + 2 * joint - 2
        indices.push(a, a + 1, a + 3, a, a + 3, a + 2)
      }
    }
  }
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new Float32BufferAttribute(positions, 3))
  geometry.setAttribute('aside', new Float32BufferAttribute(asides, 2))
  geometry.setAttribute('tip', new Float32BufferAttribute(tips, 1))
  geometry.setIndex(indices)
  return geometry
}

/**
 * Tufts near the viewer, and the coarser ones beyond: distances at which they come and go, those over which they thin out [m], and factor on
 * the least width of their blades.
 */
export const GRASSES = {
  near: {
    tuft: { blades: 15, radius: 0.17, length: [0.13, 0.42], joints: 2 },
    reach: [-2, -1, 13, 20],
    thinning: { from: 6, to: 20, least: 0.5 },
    wide: 1.3
  },
  far: {
    tuft: { blades: 13, radius: 0.45, length: [0.16, 0.4], joints: 1 },
    reach: [11, 18, 55, 84],
    thinning: { from: 16, to: 70, least: 0.3 },
    wide: 1.7
  }
} as const

/**
 * Grass: blades as wide as a pixel at least, so that they do not shimmer, with the ground's colours.
 *
 * @param kind - Near the viewer, or beyond.
 */
export function createGrass(
  kind: keyof typeof GRASSES,
  cells: PlantCells,
  uniforms: PlantUniforms
): Mesh {
  const { tuft: options, reach, thinning, wide: wider } = GRASSES[kind]
  const material = new PlantMaterial({ side: DoubleSide })
  // Within some metres there is no haze, but for thick mist.
  material.fog = kind === 'far'
  const nodes = plantNodes(uniforms)
  const { foot, size, random, tint, distance, turned } = nodes
  const tip = attribute<'float'>('tip', 'float') as unknown as Float
  const aside = attribute<'vec2'>('aside', 'vec2')
  const [comes, here, leaves, gone] = reach
  const shown = smoothstep(comes, here, distance)
    .mul(smoothstep(leaves, gone, distance).oneMinus())
    .mul(thinned(thinning, nodes))
    .toConst()
  const spine = positionGeometry as unknown as Vec3
  // Fewer of them are wider.
  const wide = distance.mul(HALF_PIXEL * wider).max(HALF_WIDTH)
  const edge = vec3(aside.x, 0, aside.y).mul(wide)
  const gust = sin(
    uniforms.time.mul(1.7).add(foot.x.mul(0.35)).add(foot.z.mul(0.22)).add(random.mul(2))
  )
  const sway = gust.mul(tip.mul(tip)).mul(0.035)
  const scaled = spine
    .mul(size.mul(shown))
    .add(edge.mul(shown.sqrt()).mul(size.greaterThan(0).select(1, 0)))
  const outwards = turned(vec3(spine.x, 0, spine.z))
  material.positionNode = foot.add(turned(scaled)).add(vec3(sway, 0, sway.mul(0.6)).mul(size))
  // As lit as the ground is, but for what leans.
  const normal = vec3(0, 1, 0)
    .add(outwards.mul(random.mul(1.2).add(0.5)))
    .normalize()
  material.normalNode = varying(transformNormalToView(normal as never) as unknown as Vec3)
  const [green, straw] = [GREEN, STRAW].map(([r, g, b]) => vec3(r, g, b))
  const dry = tint.add(random.sub(0.5).mul(0.3)).clamp(0, 1)
  // Fresh and bluish tufts beside yellowish ones.
  const fresh = mix(vec3(0.72, 0.86, 1.25), vec3(1.35, 1.08, 0.6), random)
  // Where they end they are as bright as the ground.
  const form = kind === 'far' ? smoothstep(leaves * 0.4, gone, distance).oneMinus() : 1
  const light = mix(1, mix(0.35, 1.75, tip).mul(random.mul(0.5).add(0.75)), form)
  // Long blades have seeds, which are straw.
  const seeds = smoothstep(1.45, 1.9, size)
    .mul(smoothstep(0.62, 0.8, tip))
    .mul(0.8)
  const blade = mix(mix(green.mul(fresh), straw, dry), straw, seeds)
  material.colorNode = varying(blade.mul(light)) as unknown as Vec3
  const mesh = new Mesh(plantGeometry(tuft(options), cells), material)
  mesh.receiveShadow = true
  mesh.frustumCulled = false
  return mesh
}
