import {
  type BufferAttribute,
  ConeGeometry,
  Float32BufferAttribute,
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  PlaneGeometry,
  Quaternion,
  SphereGeometry,
  Vector3
} from 'three'

/** Half width of the hills [m]. */
const EXTENT = 60_000
/** Quads along a side. */
const QUADS = 500
const TREES = 700

/** Colours of low ground and of heights, and how much each varies, linear sRGB. */
export interface Soil {
  low: readonly [number, number, number]
  high: readonly [number, number, number]
  variation: number
}

export const meadow: Soil = { low: [0.1, 0.13, 0.045], high: [0.22, 0.18, 0.14], variation: 0.3 }
export const snow: Soil = { low: [0.85, 0.86, 0.87], high: [0.8, 0.81, 0.83], variation: 0.04 }
export const redDust: Soil = { low: [0.3, 0.13, 0.06], high: [0.22, 0.11, 0.06], variation: 0.2 }

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

/** Height of the hills: ridged noise of seven octaves, level within 1.5 km of the middle [m]. */
function hillHeight(x: number, z: number): number {
  let sum = 0
  for (let octave = 0; octave < 7; octave++) {
    const scale = 2.1 ** octave / 9000
    const noise = valueNoise(x * scale + 17 * octave, z * scale - 9 * octave)
    sum += 0.45 ** octave * (1 - Math.abs(2 * noise - 1)) ** 2
  }
  const rise = Math.min(Math.max((Math.hypot(x, z) - 1500) / 6000, 0), 1)
  return 900 * rise * sum - 2
}

/** Hills that bend with a planet, finer about the middle. */
function hills(radius: number, soil: Soil): Mesh {
  const geometry = new PlaneGeometry(2, 2, QUADS, QUADS).rotateX(-Math.PI / 2)
  const positions = geometry.attributes.position as BufferAttribute
  const colors: number[] = []
  const stretch = (t: number): number => EXTENT * (0.08 * t + 0.92 * t ** 3)
  for (let i = 0; i < positions.count; i++) {
    const x = stretch(positions.getX(i))
    const z = stretch(positions.getZ(i))
    const height = hillHeight(x, z)
    positions.setXYZ(i, x, height - (x * x + z * z) / (2 * radius), z)
    const patches = (valueNoise(x / 300, z / 300) + valueNoise(x / 40, z / 40)) / 2
    const rock = Math.min(Math.max((height - 500) / 500, 0), 1)
    const shade = 1 + soil.variation * (patches - 0.5)
    for (const channel of [0, 1, 2]) {
      colors.push(shade * mix(soil.low[channel], soil.high[channel], rock))
    }
  }
  geometry.setAttribute('color', new Float32BufferAttribute(colors, 3))
  geometry.computeVertexNormals()
  const mesh = new Mesh(geometry, new MeshStandardMaterial({ vertexColors: true, roughness: 1 }))
  mesh.castShadow = mesh.receiveShadow = true
  mesh.frustumCulled = false
  return mesh
}

/** Round and pointed trees in the level middle, 4 to 14 m high. */
function trees(): Group {
  const kinds = [
    new SphereGeometry(3, 12, 8).scale(1, 1.2, 1).translate(0, 4, 0),
    new ConeGeometry(2.2, 9, 10).translate(0, 5, 0)
  ]
  const group = new Group()
  for (const [kind, geometry] of kinds.entries()) {
    const material = new MeshStandardMaterial({ color: '#33421f', roughness: 1 })
    const mesh = new InstancedMesh(geometry, material, TREES)
    for (let i = 0; i < TREES; i++) {
      const angle = 2 * Math.PI * random(i, 10 * kind + 1)
      const distance = 40 + 3000 * random(i, 10 * kind + 2)
      const x = distance * Math.cos(angle)
      const z = distance * Math.sin(angle)
      const size = new Vector3().setScalar(0.6 + 0.8 * random(i, 10 * kind + 3))
      const place = new Vector3(x, hillHeight(x, z), z)
      mesh.setMatrixAt(i, new Matrix4().compose(place, new Quaternion(), size))
    }
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
