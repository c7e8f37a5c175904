import { DoubleSide, Mesh, PlaneGeometry, type DataTexture } from 'three'
import {
  attribute,
  mix,
  positionGeometry,
  smoothstep,
  texture,
  transformNormalToView,
  uv,
  varying,
  vec2,
  vec3
} from 'three/tsl'
import { mipmapped } from '../mipmapped'
import { randomSequence } from '../random'
import {
  plantGeometry,
  PlantMaterial,
  plantNodes,
  type Planted,
  type PlantUniforms,
  type Vec3
} from '../terrain/vegetation/plantShader'
import { GRASS, STRAW } from './fieldPlan'

/** Texels of a picture of blades, and their number. */
const WIDTH = 128
const HEIGHT = 64
const BLADES = 30

/** Width and height of a tuft [m]. */
const TUFT = [0.8, 0.24] as const

/** Distances between which tufts go: beyond, the ground alone is as fine as pixels [m]. */
const GOES = [45, 105] as const

/** Coverage from which blades are solid: from afar pictures are means, of which gaps take most. */
const SOLID = [0.5, 0.3] as const

/** Blades side by side, bent and pointed: brightness in red, coverage in green. */
function bladePicture(): DataTexture {
  const random = randomSequence(31)
  const bytes = new Uint8Array(4 * WIDTH * HEIGHT)
  for (let i = 0; i < bytes.length; i += 4) bytes[i] = 128
  for (let blade = 0; blade < BLADES; blade++) {
    const root = WIDTH * (0.1 + 0.8 * random())
    const length = HEIGHT * (0.35 + 0.6 * random())
    const bend = WIDTH * 0.22 * (random() - 0.5)
    const brightness = 80 + 150 * random()
    for (let row = 0; row < length; row++) {
      const part = row / length
      const middle = root + bend * part * part
      const half = 1.7 * (1 - 0.8 * part)
      for (let x = Math.ceil(middle - half); x <= middle + half; x++) {
        if (x < 0 || x >= WIDTH) continue
        bytes.set([brightness, 255], 4 * (row * WIDTH + x))
      }
    }
  }
  return mipmapped(bytes, WIDTH, HEIGHT)
}

/** Grass of a meadow seen from some metres up: upright pictures of blades. */
export function createMeadowGrass(tufts: Planted, uniforms: PlantUniforms): Mesh {
  const material = new PlantMaterial({ side: DoubleSide })
  const picture = bladePicture()
  material.addEventListener('dispose', () => picture.dispose())
  const { foot, size, random, tint, distance, turned } = plantNodes(uniforms)
  const shown = smoothstep(...GOES, distance).oneMinus()
  const { x, y } = positionGeometry
  const grown = size.mul(shown)
  material.positionNode = foot.add(
    turned(vec3(x.mul(TUFT[0]).mul(size), y.mul(TUFT[1]).mul(grown), 0))
  )
  material.normalNode = transformNormalToView(vec3(0, 1, 0))
  const side = attribute<'vec4'>('plantLook', 'vec4').y.greaterThan(0.5).select(1, -1)
  const at = vec2(uv().x.sub(0.5).mul(varying(side)).add(0.5), uv().y)
  const blades = texture(picture, at).toConst()
  const solid = mix(SOLID[0], SOLID[1], smoothstep(15, 60, varying(distance)))
  material.maskNode = blades.g.greaterThan(solid)
  // Roots are in the shade of other blades; where tufts end they are as bright as the ground.
  const light = mix(0.55, 1.2, uv().y.mul(1.4).min(1)).mul(blades.r.mul(0.8).add(0.6))
  const fresh = mix(vec3(0.88, 0.96, 0.95), vec3(1.08, 1.03, 0.9), random)
  const color = mix(vec3(...GRASS).mul(fresh), vec3(...STRAW), tint)
  material.colorNode = (varying(color) as unknown as Vec3).mul(mix(1, light, varying(shown)))
  const mesh = new Mesh(
    plantGeometry(new PlaneGeometry(1, 1).translate(0, 0.5, 0), tufts),
    material
  )
  mesh.receiveShadow = true
  mesh.frustumCulled = false
  return mesh
}
