import {
  BoxGeometry,
  Color,
  Group,
  InstancedMesh,
  Matrix4,
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
  positionView,
  smoothstep,
  step,
  uniform,
  vec3
} from 'three/tsl'
import type { SurfaceWater } from '@welkin/atmosphere'
import type { Node } from 'three/webgpu'
import { randomSequence } from '../random'
import { Church } from './church'
import { groundHeight } from './ground'
import type { Outline } from './OpenSky'
import { VILLAGE } from './places'
import { roof, roofColor } from './roof'
import type { StreetLamps } from './StreetLamps'
import { setLit } from './litLights'
import { VertexLitMaterial } from './VertexLitMaterial'

const HOUSES = 46
/** Luminances of the darkest and the brightest lit window [cd/m²], and luminous intensity of the lamp by the church [cd]. */
const WINDOWS = [0.2, 2] as const
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

/** Colours of new plaster: lime, cream, ochre, rose and grey (hue, saturation, lightness, linear). Rain and dust take about half of it. */
const PLASTERS = [
  [0.11, 0.12, 0.62],
  [0.12, 0.3, 0.58],
  [0.1, 0.42, 0.5],
  [0.05, 0.17, 0.55],
  [0.58, 0.05, 0.52]
] as const

function plasterOf(random: () => number): [number, number, number] {
  const [hue, saturation, lightness] = PLASTERS[Math.floor(PLASTERS.length * random())]
  return [hue, saturation, lightness * (0.44 + 0.16 * random())]
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
      hsl: plasterOf(random),
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

/**
 * Outlines of the houses and the church on the map, and heights of their walls [m].
 *
 * @param middle - Place of the church, default the valley's [m].
 */
export const outlines = ({ x, z }: Readonly<Record<'x' | 'z', number>> = VILLAGE): (Outline & {
  readonly height: number
})[] => [
  ...housesAbout({ x, z }),
  { x, z, width: 7, depth: 7, turn: 0, height: 22 },
  { x, z: z + 14, width: 11, depth: 22, turn: 0, height: 9 }
]

/** Part of the houses whose upper floor is of timber. */
const TIMBERED = 0.45

/**
 * Colour of a wall over that of its plaster, on the unit cube: stone at its foot, timber above in some houses, shade below the
 * eaves, frames and shutters about the windows and a door under the ridge.
 */
function wallColor(
  isWindow: Node<'float'>,
  inCell: Node<'vec3'>,
  along: Node<'float'>
): Node<'vec3'> {
  const { x, y } = positionGeometry
  const house = float(instanceIndex)
  const isTimber = step(hash(house.add(5)), TIMBERED).mul(step(0.5, y))
  const isFar = smoothstep(60, 160, positionView.z.negate())
  const boards = mix(
    step(0.16, fract(y.mul(26)))
      .mul(0.3)
      .add(0.75),
    float(1),
    isFar
  )
  const timber = vec3(0.27, 0.2, 0.15).mul(boards)
  const stone = vec3(0.5, 0.48, 0.46)
  let color: Node<'vec3'> = mix(vec3(1), timber, isTimber)
  color = mix(stone, color, smoothstep(0.09, 0.1, y))
  const beside = along.sub(0.5).abs()
  const isShutter = step(0.24, beside)
    .mul(step(beside, 0.34))
    .mul(step(0.33, inCell.y))
    .mul(step(inCell.y, 0.82))
  const isFrame = step(beside, 0.235).mul(step(0.31, inCell.y)).mul(step(inCell.y, 0.83))
  const paint = mix(vec3(0.1, 0.16, 0.1), vec3(0.2, 0.09, 0.05), step(0.5, hash(house.add(9))))
  const isWall = step(normalGeometry.y.abs(), 0.5)
  color = mix(color, paint, isShutter.mul(isWall))
  color = mix(color, vec3(0.75, 0.73, 0.7), isFrame.mul(isWall))
  // Panes mirror the sky, more of it above; bars cross them.
  const isBar = step(beside, 0.014).max(step(inCell.y.sub(0.62).abs(), 0.014))
  const pane = mix(vec3(0.03, 0.035, 0.045), vec3(0.13, 0.16, 0.2), smoothstep(0.35, 0.8, inCell.y))
  const glass = mix(pane, vec3(0.6), isBar.mul(isFar.oneMinus()))
  color = mix(color, glass, isWindow)
  const isDoor = step(x.abs(), 0.055).mul(step(y, 0.4)).mul(step(0.5, normalGeometry.z))
  color = mix(color, vec3(0.16, 0.09, 0.05), isDoor)
  // Streaks of rain, and splashes at the foot; trees and other houses take part of the sky's light there.
  const streaks = hash(along.mul(23).floor().add(house.mul(31)).add(400))
  const aged = streaks
    .mul(y)
    .mul(0.16)
    .oneMinus()
    .mul(smoothstep(-0.1, 0.45, y).mul(0.3).add(0.7))
  return color.mul(aged).mul(smoothstep(1.03, 0.86, y).mul(0.62).add(0.38))
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
 * @param water - Rain and snow on walls and roofs; null for none.
 */
export function createVillage(
  heightAt = groundHeight,
  middle: Readonly<Record<'x' | 'z', number>> = VILLAGE,
  lamps: StreetLamps | null = null,
  water: SurfaceWater | null = null
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
  walls.colorNode = wallColor(isWindow, inCell, along)
  const windows = mix(vec3(1, 0.27, 0.02), vec3(1, 0.44, 0.09), hue).mul(
    isWindow.mul(isLit).mul(shown).mul(luminance)
  )
  // Walls below the lamps have about half of the light that the ground before them has, most of it beside the door.
  const facing = mix(float(0.12), float(0.5), step(0.5, normalGeometry.z))
  const lamplight = smoothstep(0.6, 0.12, positionGeometry.y).mul(0.9).add(0.1).mul(facing)
  walls.emissiveNode = lamps === null ? windows : windows.add(lamps.reflected().mul(lamplight))
  const tiles = new VertexLitMaterial()
  tiles.colorNode = roofColor()
  const plaster = new VertexLitMaterial({ color: '#6f655a' })
  for (const each of [tiles, plaster]) each.snowNode = water?.snowCoverNode ?? null
  for (const each of [walls, tiles, plaster]) each.wetNode = water?.wetnessNode ?? null
  const bodies = new InstancedMesh(new BoxGeometry().translate(0, 0.5, 0), walls, HOUSES)
  const roofs = new InstancedMesh(roof(), tiles, HOUSES)
  const chimneys = new InstancedMesh(new BoxGeometry().translate(0, 0.5, 0), plaster, HOUSES)
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
    const ridge = new Vector3(0.12 * width, base + height + 0.9, 0.3 * depth)
    chimneys.setMatrixAt(
      i,
      matrix.compose(
        ridge.applyAxisAngle(UP, house.turn).add(new Vector3(x, 0, z)),
        turn,
        new Vector3(0.8, 2.8, 0.8)
      )
    )
    bodies.setColorAt(i, color.setHSL(...house.hsl))
    roofs.setColorAt(i, color.setScalar(house.roof))
  }
  const { x, z } = middle
  const base = heightAt(x, z) - 0.5
  const church = new Church(tiles, water)
  church.position.set(x, base, z)
  const lights = lamps ?? churchLamp(x, base, z)
  const object = new Group().add(bodies, roofs, chimneys, church, lights)
  for (const each of [bodies, roofs, chimneys]) {
    each.castShadow = each.receiveShadow = true
  }
  bodies.frustumCulled = roofs.frustumCulled = chimneys.frustumCulled = false
  return {
    object,
    light(share, luminanceScale) {
      lit.value = share
      luminance.value = luminanceScale
      lights.light(share, luminanceScale)
    },
    dispose() {
      for (const { geometry } of [bodies, roofs, chimneys]) geometry.dispose()
      church.dispose()
      bodies.dispose()
      roofs.dispose()
      chimneys.dispose()
      lights.dispose()
      for (const material of [walls, tiles, plaster]) material.dispose()
    }
  }
}
