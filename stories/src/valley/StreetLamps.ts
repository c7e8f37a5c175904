import {
  CylinderGeometry,
  type DataTexture,
  Group,
  InstancedMesh,
  Matrix4,
  RedFormat,
  SphereGeometry
} from 'three'
import { diffuseColor, float, Fn, If, positionWorld, texture, uniform, vec2, vec3 } from 'three/tsl'
import { MeshBasicNodeMaterial } from 'three/webgpu'
import type { Node } from 'three/webgpu'
import { mipmapped } from '../mipmapped'
import { disposeMeshes } from '../scene'
import { groundHeight, roadMiddle } from './ground'
import { VILLAGE } from './places'
import { VertexLitMaterial } from './VertexLitMaterial'

/** A light by its place on the map [m], and its luminous intensity [cd] and height above the ground [m]. */
type Lamp = readonly [x: number, z: number, intensity: number, height: number]

/** Luminous intensity and height of a street lamp, and luminance of its globe [cd, m, cd/m²]. */
const STREET = { intensity: 140, height: 5, luminance: 25 } as const
/** Luminous intensity and height of the lamp over a door [cd, m]. */
const DOOR = { intensity: 12, height: 2.4 } as const
/** Colour of sodium lamps and bulbs, linear sRGB of luminance 1. */
const COLOR = [1.9, 0.8, 0.19] as const

/** Edge of the square map about the village [m], and its texels along it. */
const WIDTH = 480
const SIZE = 256
/** Distance beyond which a lamp lights nothing that one sees, over its height. */
const REACH = 12
/** Greatest illuminance of the map, under a street lamp [lx]. */
const MOST = (STREET.intensity + DOOR.intensity) / STREET.height ** 2

/** Distance between two lamps of the road, and that of these from its middle [m]. */
const APART = 31
const ASIDE = 3.4

/** Lamps along the road through the village, on both sides by turns. */
function streetLamps(): Lamp[] {
  return Array.from({ length: 12 }, (_, i) => {
    const z = VILLAGE.z + APART * (i - 5.5)
    const x = roadMiddle(z) + (i % 2 === 0 ? ASIDE : -ASIDE)
    return [x, z, STREET.intensity, STREET.height]
  })
}

/** The horizontal illuminance by lamps about the village, as the square root of its part of the greatest. */
function illuminanceMap(lamps: readonly Lamp[]): DataTexture {
  const sums = new Float32Array(SIZE * SIZE)
  const texel = WIDTH / SIZE
  for (const [x, z, intensity, height] of lamps) {
    const [column, row] = [
      (x - VILLAGE.x + WIDTH / 2) / texel - 0.5,
      (z - VILLAGE.z + WIDTH / 2) / texel - 0.5
    ]
    const reach = (REACH * height) / texel
    for (let j = Math.max(Math.ceil(row - reach), 0); j < Math.min(row + reach, SIZE); j++) {
      for (
        let i = Math.max(Math.ceil(column - reach), 0);
        i < Math.min(column + reach, SIZE);
        i++
      ) {
        const distance = texel * Math.hypot(i - column, j - row)
        const fade = Math.max(1 - distance / (REACH * height), 0)
        const square = distance ** 2 + height ** 2
        sums[j * SIZE + i] += (fade * intensity * height) / square ** 1.5
      }
    }
  }
  const bytes = Uint8Array.from(sums, sum => 255 * Math.sqrt(Math.min(sum / MOST, 1)))
  return mipmapped(bytes, SIZE, SIZE, RedFormat)
}

/** Lamps of the village: posts along its road, and one over each door. They light ground and walls from a map. */
export class StreetLamps extends Group {
  readonly #map: DataTexture
  /** Part that is lit times the luminance scale. */
  readonly #scale = uniform(0)
  readonly #posts: InstancedMesh
  readonly #globes: InstancedMesh

  /** @param doors - Places of doors on the map [m]. */
  constructor(doors: readonly { x: number; z: number }[]) {
    super()
    const street = streetLamps()
    const overDoors = doors.map(({ x, z }): Lamp => [x, z, DOOR.intensity, DOOR.height])
    this.#map = illuminanceMap([...street, ...overDoors])
    const iron = new VertexLitMaterial({ color: '#2a2b2d' })
    const shining = new MeshBasicNodeMaterial({ name: 'StreetLamp' })
    const glass = vec3(0.1).mul(this.#scale.equal(0).select(1e-4, 0))
    shining.colorNode = vec3(...COLOR)
      .mul(this.#scale.mul(STREET.luminance))
      .add(glass)
    const { height } = STREET
    const post = new CylinderGeometry(0.06, 0.09, height, 5, 1, true).translate(0, height / 2, 0)
    this.#posts = new InstancedMesh(post, iron, street.length)
    const globe = new SphereGeometry(0.24, 8, 6).translate(0, height, 0)
    this.#globes = new InstancedMesh(globe, shining, street.length)
    street.forEach(([x, z], i) => {
      const matrix = new Matrix4().makeTranslation(x, groundHeight(x, z) - 0.1, z)
      this.#posts.setMatrixAt(i, matrix)
      this.#globes.setMatrixAt(i, matrix)
    })
    this.#posts.castShadow = true
    this.add(this.#posts, this.#globes)
  }

  /** Light that a matte material about the village gives back of the lamps', by its colour; it costs nothing while they are off. */
  reflected(): Node<'vec3'> {
    return Fn(() => {
      const light = vec3(0).toVar()
      If(this.#scale.greaterThan(0), () => {
        const { x, z } = positionWorld
        const place = vec2(x.sub(VILLAGE.x), z.sub(VILLAGE.z)).div(WIDTH).add(0.5)
        const part = texture(this.#map, place).level(float(0)).r
        const illuminance = part.mul(part).mul(this.#scale.mul(MOST / Math.PI))
        light.assign(diffuseColor.rgb.mul(vec3(...COLOR)).mul(illuminance))
      })
      return light
    })()
  }

  /**
   * Lights them.
   *
   * @param share - Part of their light, in [0, 1].
   * @param luminanceScale - The atmosphere's.
   */
  light(share: number, luminanceScale: number): void {
    this.#scale.value = share * luminanceScale
  }

  override dispose(): void {
    disposeMeshes([this.#posts, this.#globes])
    this.#map.dispose()
  }
}
