import { Vector3 } from 'three'
import type { Texture } from 'three'
import { checkChoice, checkFinite, checkOptions, fail } from '@welkin/geo'
import { checkRange, vector3Uniform as vector } from '@welkin/atmosphere'
import { isFlat, type Figure } from '../../tiles/cpu/figure'
import type { Float, Vec3 } from '../../tsl-types'
import type { GroundLayers } from '../tsl/groundRules'
import { paintedLayers } from '../tsl/groundShares'
import { maskShares } from '../tsl/maskShares'
import { GROUND_KINDS, type GroundKind } from './groundKinds'

/** Area of a mask, and what its channels paint. */
export interface GroundMaskOptions {
  /** Materials of red, green, blue and alpha; null for a channel that is not used. */
  materials: readonly (GroundKind | null)[]
  /** Western edge [°]; in a flat world along X [m]. */
  west: number
  /** Eastern edge [°]; in a flat world along X [m]. */
  east: number
  /** Southern edge [°]; in a flat world along −Z [m]. */
  south: number
  /** Northern edge [°]; in a flat world along −Z [m]. */
  north: number
}

const RADIANS = Math.PI / 180
const east = new Vector3()
const meridian = new Vector3()
const north = new Vector3()

/**
 * Mask of the ground's materials: each channel of a texture is the share of one, and height, slope and latitude decide the rest.
 *
 * ```ts
 * const paths = new GroundMask(texture, { materials: ['sand'], west: 8, east: 8.1, south: 46, north: 46.1 })
 * const terrain = new Terrain(atmosphere, heights, { mask: paths })
 * ```
 *
 * Its first row of texels is the northernmost, as in three's textures that are loaded. Beyond its edges nothing is painted. On a globe it
 * is narrower than 180° and ends before the poles.
 */
export class GroundMask {
  /** Shared, not owned. */
  readonly texture: Texture
  readonly materials: readonly (GroundKind | null)[]
  readonly west: number
  readonly east: number
  readonly south: number
  readonly north: number
  /** Uniforms that shaders find places by; see `placeOnMask`. */
  readonly uniforms = {
    /** Unit vectors to the east, from the axis, and to the north at the middle; in a flat world those along the map. */
    east: vector(),
    meridian: vector(),
    north: vector(),
    /** Components of the reference along these [m]. */
    reference: vector(),
    /** Factors on the angles, or metres, that make them 1 across the mask (xy), and on z for a geodetic latitude (z). */
    scale: vector(),
    /** Sine and cosine of the latitude in the middle (xy), and z of the reference [m]. */
    middle: vector()
  }

  /** @throws If the texture is none, a material is unknown, or the area is empty or too large. */
  constructor(texture: Texture, options: GroundMaskOptions) {
    const where = 'GroundMask'
    if (!texture?.isTexture) fail(where, 'texture must be a Texture', texture)
    checkOptions(where, options, 'materials', 'west', 'east', 'south', 'north')
    const { materials, west, east, south, north } = options
    if (!Array.isArray(materials) || materials.length < 1 || materials.length > 4) {
      fail(where, 'materials must be one to four', materials)
    }
    for (const material of materials) {
      if (material !== null) checkChoice(where, 'materials', material, GROUND_KINDS)
    }
    for (const [name, value] of Object.entries({ west, east, south, north })) {
      checkFinite(where, name, value)
    }
    if (!(east > west) || !(north > south))
      fail(where, 'east must exceed west, north south', options)
    this.texture = texture
    this.materials = materials
    this.west = west
    this.east = east
    this.south = south
    this.north = north
  }

  /**
   * Sets the uniforms for the point that places count from; a terrain calls it by itself.
   *
   * @param referencePoint - Point that places in shaders count from [m].
   * @throws If the area does not fit a globe.
   */
  update(figure: Figure, referencePoint: Vector3): void {
    const { uniforms } = this
    const longitude = ((this.west + this.east) / 2) * RADIANS
    const latitude = ((this.south + this.north) / 2) * RADIANS
    if (isFlat(figure)) {
      east.set(1, 0, 0)
      meridian.set(0, 1, 0)
      north.set(0, 0, -1)
      const [x, y] = [(this.west + this.east) / 2, (this.south + this.north) / 2]
      uniforms.reference.value.set(referencePoint.x - x, 0, -referencePoint.z - y)
      uniforms.scale.value.set(1 / (this.east - this.west), 1 / (this.north - this.south), 1)
    } else {
      checkRange('GroundMask', 'east − west', this.east - this.west, 0, 180)
      checkRange('GroundMask', 'south', this.south, -89, 89)
      checkRange('GroundMask', 'north', this.north, -89, 89)
      const { radii } = figure
      const stretch = (radii.x / radii.z) ** 2
      const [sine, cosine] = [Math.sin(latitude), Math.cos(latitude)]
      east.set(-Math.sin(longitude), Math.cos(longitude), 0)
      meridian.set(Math.cos(longitude), Math.sin(longitude), 0)
      north.copy(meridian).multiplyScalar(-sine)
      north.z = cosine * stretch
      uniforms.reference.value.set(
        referencePoint.dot(east),
        referencePoint.dot(meridian),
        referencePoint.dot(north)
      )
      const width = (this.east - this.west) * RADIANS
      uniforms.scale.value.set(1 / width, 1 / ((this.north - this.south) * RADIANS), stretch)
      uniforms.middle.value.set(sine, cosine, referencePoint.z)
    }
    uniforms.east.value.copy(east)
    uniforms.meridian.value.copy(meridian)
    uniforms.north.value.copy(north)
  }

  /** Nodes of the ground's layers with what is painted, for a terrain's material; see `maskShares`. */
  layersAt(layers: GroundLayers, offset: Vec3, isFlat: boolean, relief: Float): GroundLayers {
    return paintedLayers(layers, maskShares(this, offset, isFlat, relief))
  }
}
