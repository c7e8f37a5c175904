import {
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  RGFormat,
  Vector3,
  type Matrix4
} from 'three'
import { float, Fn, If, mix, positionView, positionWorld, texture, uniform, vec2 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { VILLAGE } from './places'

/** Edge of the square that the map covers about the village [m], and its texels along it. */
const WIDTH = 1024
const SIZE = 1024

/** Distance from the camera beyond which shade at the foot of things is too small to see [m]. */
const SEEN = 1500

/** Part of the sky that a wall hides at its foot, and distance at which it hides a third of that [m]. */
const WALL = { hidden: 0.62, reach: 2.2 } as const

/** Part of the sky that a crown hides below it, and its radius at size 1 [m]. */
const CROWN = { hidden: 0.55, radius: 3 } as const

/** Outline of a house on the map: middle, width, depth [m], and turn about the vertical [rad]. */
export interface Outline {
  readonly x: number
  readonly z: number
  readonly width: number
  readonly depth: number
  readonly turn: number
}

const _place = new Vector3()

/** Distance of a place from an outline [m]; 0 inside. */
function distanceFrom(outline: Outline, x: number, z: number): number {
  const [cos, sin] = [Math.cos(outline.turn), Math.sin(outline.turn)]
  const [dx, dz] = [x - outline.x, z - outline.z]
  const across = Math.abs(dx * cos - dz * sin) - outline.width / 2
  const along = Math.abs(dx * sin + dz * cos) - outline.depth / 2
  return Math.hypot(Math.max(across, 0), Math.max(along, 0))
}

/** Part of the sky that a house leaves at a distance from its walls [m], in [0, 1]. */
export const besideWall = (distance: number): number =>
  1 - WALL.hidden * Math.exp(-distance / WALL.reach)

/** Part of the sky that a crown leaves at a distance from its trunk over its radius, in [0, 1]. */
export const belowCrown = (distance: number): number =>
  1 - CROWN.hidden * Math.max(1 - (distance / 1.5) ** 2, 0) ** 1.5

/** Part of the sky that is seen from the ground about the village: houses and trees stand in a soft shade of their own. */
export class OpenSky {
  /** Beside houses in red, below trees in green. */
  readonly #bytes = new Uint8Array(2 * SIZE * SIZE).fill(255)
  readonly #map = new DataTexture(this.#bytes, SIZE, SIZE, RGFormat)
  readonly #hasHouses = uniform(1)
  readonly #hasTrees = uniform(1)

  constructor() {
    this.#map.magFilter = LinearFilter
    this.#map.minFilter = LinearMipmapLinearFilter
    this.#map.generateMipmaps = true
    this.#map.anisotropy = 2
    this.#map.needsUpdate = true
  }

  /** Things that shade the ground; others do not. */
  show({ houses, trees }: { houses: boolean; trees: boolean }): void {
    this.#hasHouses.value = Number(houses)
    this.#hasTrees.value = Number(trees)
  }

  /** Puts houses on the map. */
  addHouses(houses: readonly Outline[]): void {
    for (const house of houses) {
      const reach = Math.hypot(house.width, house.depth) / 2 + 4 * WALL.reach
      this.#darken(0, house, reach, (x, z) => besideWall(distanceFrom(house, x, z)))
    }
  }

  /** Puts trees on the map, by their places and sizes. */
  addTrees(matrices: Iterable<Matrix4>): void {
    for (const matrix of matrices) {
      const { x, z } = _place.setFromMatrixPosition(matrix)
      const radius = CROWN.radius * matrix.getMaxScaleOnAxis()
      this.#darken(1, { x, z }, 1.5 * radius, (atX, atZ) =>
        belowCrown(Math.hypot(atX - x, atZ - z) / radius)
      )
    }
  }

  /** Part of the sky that is left at a place of the map, in [0, 1]. */
  at(x: number, z: number): number {
    const [column, row] = [x - VILLAGE.x, z - VILLAGE.z].map(t =>
      Math.floor(((t + WIDTH / 2) * SIZE) / WIDTH)
    )
    const texel = 2 * (row * SIZE + column)
    return (this.#bytes[texel] * this.#bytes[texel + 1]) / 255 ** 2
  }

  #darken(
    channel: number,
    { x, z }: { x: number; z: number },
    reach: number,
    left: (x: number, z: number) => number
  ): void {
    const texel = WIDTH / SIZE
    const [column, row] = [x - VILLAGE.x, z - VILLAGE.z].map(t => (t + WIDTH / 2) / texel)
    const [from, to] = [-reach / texel, reach / texel]
    for (let j = Math.max(Math.floor(row + from), 0); j <= Math.min(row + to, SIZE - 1); j++) {
      for (let i = Math.max(Math.floor(column + from), 0); i <= column + to && i < SIZE; i++) {
        const index = 2 * (j * SIZE + i) + channel
        const [atX, atZ] = [i, j].map(t => (t + 0.5) * texel - WIDTH / 2)
        this.#bytes[index] *= left(atX + VILLAGE.x, atZ + VILLAGE.z)
      }
    }
  }

  /**
   * Part of the sky that the ground sees, in [0, 1].
   *
   * @param right - Way on the ground from a pixel to the next [m].
   * @param down - Way to the pixel below [m].
   */
  sample(right: Node<'vec3'>, down: Node<'vec3'>): Node<'float'> {
    return Fn(() => {
      const open = float(1).toVar()
      const { x, z } = positionWorld
      const at = vec2(x.sub(VILLAGE.x), z.sub(VILLAGE.z)).div(WIDTH).toConst()
      const isInside = at.x.abs().max(at.y.abs()).lessThan(0.5)
      If(isInside.and(positionView.z.greaterThan(-SEEN)), () => {
        const [across, along] = [right, down].map(way => vec2(way.x, way.z).div(WIDTH))
        const left = texture(this.#map, at.add(0.5)).grad(across, along)
        open.assign(
          mix(float(1), left.r, this.#hasHouses).mul(mix(float(1), left.g, this.#hasTrees))
        )
      })
      return open
    })()
  }

  dispose(): void {
    this.#map.dispose()
  }
}
