import { BoxGeometry, ConeGeometry, Group, Mesh } from 'three'
import type { BufferGeometry } from 'three'
import {
  float,
  fract,
  mix,
  normalGeometry,
  positionGeometry,
  positionView,
  smoothstep,
  step,
  vec2,
  vec3
} from 'three/tsl'
import type { SurfaceWater } from '@welkin/atmosphere'
import type { Node } from 'three/webgpu'
import { roof } from './roof'
import { VertexLitMaterial } from './VertexLitMaterial'

type Float = Node<'float'>

/** Side and height of the tower; width, height and length of the nave, which begins inside it [m]. */
const TOWER = [6, 22] as const
const NAVE = [11, 9, 22] as const
const NAVE_FROM = 3

/** Distance between two windows of the nave [m]. */
const BAY = 4

/** 1 inside an upright opening with a round arch over it, of some half width; heights of its sill and of the arch's foot [m]. */
function arch(along: Float, y: Float, half: number, sill: number, top: number): Float {
  const above = vec2(along, y.sub(top).max(0)).length()
  return step(above, half).mul(step(sill, y))
}

/** Colour of its walls: plaster over stone, windows and a door with frames of stone, the openings of the bells, a clock. */
function wallColor(): Node<'vec3'> {
  const { x, y, z } = positionGeometry
  const isAside = step(0.5, normalGeometry.x.abs())
  const along = mix(x, z, isAside).toConst()
  const isWall = step(normalGeometry.y.abs(), 0.5)
  // The nave's corners are beside the tower's.
  const isNave = step(TOWER[0] / 2 + 0.1, x.abs().max(z)).toConst()
  const isTower = isNave.oneMinus()
  const inBay = fract(z.sub(NAVE_FROM).div(BAY)).sub(0.5).mul(BAY)
  const isBay = isNave.mul(isAside)
  const bell = along.abs().sub(0.85)
  const isFront = isTower.mul(step(normalGeometry.z, -0.5))
  /** Openings, wider by a margin [m]. */
  const openings = (wider: number): Float =>
    arch(inBay, y, 0.55 + wider, 3 - wider, 5.6)
      .mul(isBay)
      .add(arch(bell, y, 0.5 + wider, 18 - wider, 19.8).mul(isTower))
      .clamp()
  const door = (wider: number): Float => arch(x, y, 0.9 + wider, -1, 2.4).mul(isFront)
  const stone = vec3(0.36, 0.34, 0.31)
  // Plaster is greyer where rain runs down, below the eaves and over the stones.
  const weathered = smoothstep(3, 0.6, y).mul(0.16).oneMinus()
  let color: Node<'vec3'> = mix(stone, vec3(0.36, 0.34, 0.3).mul(weathered), step(1.2, y))
  color = mix(color, stone.mul(0.9), openings(0.18).max(door(0.22)))
  const bars = step(0.12, fract(y.mul(1.6)).sub(0.5).abs()).mul(step(0.05, inBay.abs()))
  const isFar = smoothstep(60, 160, positionView.z.negate())
  const glass = vec3(0.035, 0.042, 0.055).mul(mix(bars.mul(0.6).add(0.5), float(0.9), isFar))
  color = mix(color, mix(vec3(0.02), glass, isNave), openings(0))
  color = mix(color, vec3(0.1, 0.055, 0.03), door(0))
  const fromDial = vec2(along, y.sub(15.2)).length()
  const hand = step(along.sub(0.02).abs(), 0.06).mul(step(15.2, y)).mul(step(fromDial, 0.95))
  const isHour = step(y.sub(15.2).abs(), 0.08).mul(step(0, along)).mul(step(fromDial, 0.6))
  const isRim = step(1.08, fromDial)
  const dial = mix(vec3(0.52, 0.5, 0.44), vec3(0.06, 0.05, 0.04), hand.max(isHour).max(isRim))
  color = mix(color, dial, step(fromDial, 1.25).mul(isTower).mul(isWall))
  // Eaves shade what is below them.
  const eaves = mix(
    smoothstep(0.1, 1.2, float(TOWER[1]).sub(y)),
    smoothstep(0, 1, float(NAVE[1]).sub(y)),
    isNave
  )
  return color.mul(eaves.mul(0.4).add(0.6))
}

/** The church of the village, about its tower: a nave with windows, bells and a clock in the tower. */
export class Church extends Group {
  readonly #geometries: BufferGeometry[]
  readonly #materials: VertexLitMaterial[]

  /**
   * @param tiles - Material of a roof, whose tiles are counted on the unit roof.
   * @param water - Rain and snow on it; null for none.
   */
  constructor(tiles: VertexLitMaterial, water: SurfaceWater | null) {
    super()
    const walls = new VertexLitMaterial()
    walls.colorNode = wallColor()
    const slates = new VertexLitMaterial({ color: '#4b352d' })
    slates.snowNode = water?.snowCoverNode ?? null
    for (const each of [walls, slates]) each.wetNode = water?.wetnessNode ?? null
    const [side, height] = TOWER
    const [width, eaves, length] = NAVE
    const middle = NAVE_FROM + length / 2
    const tower = new Mesh(new BoxGeometry(side, height, side).translate(0, height / 2, 0), walls)
    const spire = new Mesh(
      new ConeGeometry(4.6, 15, 4).rotateY(Math.PI / 4).translate(0, height + 7.5, 0),
      slates
    )
    const nave = new Mesh(new BoxGeometry(...NAVE).translate(0, eaves / 2, middle), walls)
    const naveRoof = new Mesh(roof(), tiles)
    naveRoof.scale.set(width, 6, length)
    naveRoof.position.set(0, eaves, middle)
    for (const part of [tower, spire, nave, naveRoof]) {
      part.castShadow = part.receiveShadow = true
      this.add(part)
    }
    this.#geometries = [tower, spire, nave, naveRoof].map(({ geometry }) => geometry)
    this.#materials = [walls, slates]
  }

  override dispose(): void {
    for (const each of [...this.#geometries, ...this.#materials]) each.dispose()
  }
}
