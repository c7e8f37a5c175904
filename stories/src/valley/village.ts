import {
  BoxGeometry,
  BufferGeometry,
  Color,
  ConeGeometry,
  Float32BufferAttribute,
  Group,
  InstancedMesh,
  Matrix4,
  Mesh,
  PointLight,
  Quaternion,
  Vector3
} from 'three'
import {
  float,
  fract,
  hash,
  instanceIndex,
  mix,
  normalGeometry,
  positionGeometry,
  step,
  uniform,
  vec3
} from 'three/tsl'
import { randomSequence } from '../random'
import { groundHeight, VILLAGE } from './ground'
import type { StreetLamps } from './StreetLamps'
import { setLit, VertexLitMaterial } from './VertexLitMaterial'

const HOUSES = 46
/** Luminances of the darkest and the brightest lit window [cd/m²], and luminous intensity of the lamp by the church [cd]. */
const WINDOWS = [0.12, 1.2] as const
const LAMP = 40
/** Part of the windows that are lit. */
const LIT = 0.42

const UP = new Vector3(0, 1, 0)

interface House {
  /** Place on the map, size and height of the walls [m]. */
  x: number
  z: number
  width: number
  depth: number
  height: number
  /** Turn about the vertical [rad]. */
  turn: number
  hsl: [number, number, number]
  roof: number
}

/** Houses in a spiral about a church. */
function housesAbout(middle: Readonly<Record<'x' | 'z', number>>): House[] {
  const random = randomSequence(5)
  return Array.from({ length: HOUSES }, (_, i) => {
    const angle = 2.4 * i
    const distance = 24 + 20 * Math.sqrt(i) + 12 * random()
    return {
      x: middle.x + distance * Math.cos(angle),
      z: middle.z + 1.2 * distance * Math.sin(angle),
      width: 8 + 4 * random(),
      depth: 9 + 5 * random(),
      height: 5 + 2 * random(),
      turn: 0.5 * Math.floor(4 * random()) + 0.2 * random(),
      hsl: [0.09, 0.16 * random(), 0.42 + 0.22 * random()],
      roof: 0.6 + 0.6 * random()
    }
  })
}

/** Places before the doors of the houses about the church, on the map [m]. */
export const doors = (): { x: number; z: number }[] =>
  housesAbout(VILLAGE).map(({ x, z, depth, turn }) => ({
    x: x + (depth / 2 + 1.2) * Math.sin(turn),
    z: z + (depth / 2 + 1.2) * Math.cos(turn)
  }))

/** A gabled roof over the unit square, of unit height. */
function roof(): BufferGeometry {
  const [a, b, c, d, e, f] = [
    [-0.56, 0, -0.56],
    [0.56, 0, -0.56],
    [0.56, 0, 0.56],
    [-0.56, 0, 0.56],
    [0, 1, -0.56],
    [0, 1, 0.56]
  ]
  const faces = [a, d, f, a, f, e, b, e, f, b, f, c, d, c, f, a, e, b]
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new Float32BufferAttribute(faces.flat(), 3))
  geometry.computeVertexNormals()
  return geometry
}

/** A village whose lamps and windows light up at night. */
export interface Village {
  readonly object: Group
  /**
   * Lights of the evening.
   *
   * @param share - Part of them that are lit, in [0, 1].
   * @param luminanceScale - The atmosphere's.
   */
  light(share: number, luminanceScale: number): void
  dispose(): void
}

/** A lamp by the church, which three lights everything with. */
function churchLamp(x: number, y: number, z: number): PointLight & Pick<Village, 'light'> {
  const lamp = new PointLight('#ffb46b', 0, 220)
  lamp.position.set(x + 12, y + 9, z - 10)
  return Object.assign(lamp, {
    light(share: number, luminanceScale: number) {
      lamp.intensity = share * LAMP * luminanceScale
      setLit(lamp, share > 0)
    }
  })
}

/**
 * Houses about a church.
 *
 * @param heightAt - Height of the ground at a place, default that of the valley [m].
 * @param middle - Place of the church, default by the valley's lake [m].
 * @param lamps - Lamps about it; by default one by the church.
 */
export function createVillage(
  heightAt = groundHeight,
  middle: Readonly<Record<'x' | 'z', number>> = VILLAGE,
  lamps: StreetLamps | null = null
): Village {
  const houses = housesAbout(middle)
  const lit = uniform(0)
  const luminance = uniform(0)
  const walls = new VertexLitMaterial()
  // Windows in two rows on each wall, lit one by one; on the unit cube, before it becomes a house.
  const cell = positionGeometry.add(vec3(0.5, 0, 0.5)).mul(vec3(4, 2, 4))
  const inCell = fract(cell)
  const along = normalGeometry.x.abs().greaterThan(0.5).select(inCell.z, inCell.x)
  const isWindow = step(0.3, along)
    .mul(step(along, 0.7))
    .mul(step(0.35, inCell.y))
    .mul(step(inCell.y, 0.8))
    .mul(step(normalGeometry.y.abs(), 0.5))
  const number = cell
    .floor()
    .dot(vec3(1, 7, 13))
    .add(float(instanceIndex).mul(101))
    .add(500)
  const isLit = step(hash(number), lit.mul(LIT))
  // Lamps of rooms are of many strengths and hues; light is strongest below the ceiling, and less behind the bars.
  const [strength, hue] = [hash(number.add(37)), hash(number.add(91))]
  const aside = along.sub(0.5).abs().mul(5)
  const below = inCell.y.sub(0.62).div(0.27).toConst()
  const inRoom = aside.mul(aside).add(below.mul(below)).mul(0.38).oneMinus().max(0.1)
  const isPane = step(0.09, aside).mul(step(0.06, below.add(0.25).abs()))
  const [faint, bright] = WINDOWS.map(Math.log2)
  const glow = strength
    .mul(bright - faint)
    .add(faint)
    .exp2()
  const shown = glow.mul(inRoom).mul(isPane.mul(0.8).add(0.2))
  walls.colorNode = mix(vec3(1), vec3(0.12, 0.13, 0.15), isWindow)
  const windows = mix(vec3(1, 0.27, 0.02), vec3(1, 0.44, 0.09), hue).mul(
    isWindow.mul(isLit).mul(shown).mul(luminance)
  )
  // Walls have about half of the light that the ground before them has.
  walls.emissiveNode = lamps === null ? windows : windows.add(lamps.reflected().mul(0.5))
  const tiles = new VertexLitMaterial({ color: '#5b3a2e' })
  const bodies = new InstancedMesh(new BoxGeometry().translate(0, 0.5, 0), walls, HOUSES)
  const roofs = new InstancedMesh(roof(), tiles, HOUSES)
  const matrix = new Matrix4()
  const turn = new Quaternion()
  const color = new Color()
  for (const [i, house] of houses.entries()) {
    const { x, z, width, depth, height } = house
    turn.setFromAxisAngle(UP, house.turn)
    const base = Math.min(heightAt(x, z), heightAt(x + 5, z), heightAt(x, z + 5)) - 0.5
    bodies.setMatrixAt(
      i,
      matrix.compose(new Vector3(x, base, z), turn, new Vector3(width, height, depth))
    )
    roofs.setMatrixAt(
      i,
      matrix.compose(new Vector3(x, base + height, z), turn, new Vector3(width, 3.2, depth))
    )
    bodies.setColorAt(i, color.setHSL(...house.hsl))
    roofs.setColorAt(i, color.setScalar(house.roof))
  }
  const { x, z } = middle
  const base = heightAt(x, z) - 0.5
  const plaster = new VertexLitMaterial({ color: '#b9b1a2' })
  const tower = new Mesh(new BoxGeometry(6, 22, 6).translate(0, 11, 0), plaster)
  const spire = new Mesh(
    new ConeGeometry(4.6, 15, 4).rotateY(Math.PI / 4).translate(0, 29.5, 0),
    tiles
  )
  const nave = new Mesh(new BoxGeometry(11, 9, 22).translate(0, 4.5, 14), plaster)
  const naveRoof = new Mesh(roof().scale(11, 6, 22).translate(0, 9, 14), tiles)
  const church = new Group().add(tower, spire, nave, naveRoof)
  church.position.set(x, base, z)
  const lights = lamps ?? churchLamp(x, base, z)
  const object = new Group().add(bodies, roofs, church, lights)
  for (const each of [bodies, roofs, ...church.children]) {
    each.castShadow = each.receiveShadow = true
  }
  bodies.frustumCulled = roofs.frustumCulled = false
  return {
    object,
    light(share, luminanceScale) {
      lit.value = share
      luminance.value = luminanceScale
      lights.light(share, luminanceScale)
    },
    dispose() {
      for (const mesh of [bodies, roofs, tower, spire, nave, naveRoof]) mesh.geometry.dispose()
      bodies.dispose()
      roofs.dispose()
      lights.dispose()
      for (const material of [walls, tiles, plaster]) material.dispose()
    }
  }
}
