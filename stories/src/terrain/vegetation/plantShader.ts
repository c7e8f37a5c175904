import { InstancedBufferGeometry, type BufferGeometry } from 'three'
import { airAtVertices } from '@welkin/atmosphere'
import { attribute, cos, mix, sin, uniform, vec3 } from 'three/tsl'
import { MeshLambertNodeMaterial, type Node } from 'three/webgpu'
import { Vector3 } from 'three'
import type { Thinning } from './PlantCells'

export type Float = Node<'float'>
export type Vec3 = Node<'vec3'>

/** Place of the viewer in the frame of plants [m], direction to the sun there, and time that wind moves them by [s]. */
export const plantUniforms = () => ({
  viewer: uniform(new Vector3()),
  sun: uniform(new Vector3(0, 1, 0)),
  time: uniform(0)
})
export type PlantUniforms = ReturnType<typeof plantUniforms>

/** Place and look of a plant in a shader. */
export interface PlantNodes {
  /** Foot of it [m], and factor on its geometry. */
  readonly foot: Vec3
  readonly size: Float
  /** A random number and its rank in its cell, both in [0, 1), and its tint. */
  readonly random: Float
  readonly rank: Float
  readonly tint: Float
  /** Distance from the viewer [m]. */
  readonly distance: Float
  /** Turns a vector with it about the vertical. */
  readonly turned: (vector: Vec3) => Vec3
}

/** Nodes of the plant that a vertex belongs to. */
export function plantNodes({ viewer }: PlantUniforms): PlantNodes {
  const place = attribute<'vec4'>('plantPlace', 'vec4')
  const look = attribute<'vec4'>('plantLook', 'vec4')
  const [cosine, sine] = [cos(look.x).toConst(), sin(look.x).toConst()]
  return {
    foot: place.xyz,
    size: place.w,
    random: look.y,
    rank: look.z,
    tint: look.w,
    distance: place.xyz.sub(viewer).length().toConst(),
    turned: v => vec3(v.x.mul(cosine).add(v.z.mul(sine)), v.y, v.z.mul(cosine).sub(v.x.mul(sine)))
  }
}

/** Plants of one kind: those in cells about a viewer, or some that stand for good. */
export interface Planted {
  /** Gives a geometry their places and looks. */
  add(geometry: InstancedBufferGeometry): void
}

/** Geometry of one plant for all of a kind: one draw call. */
export function plantGeometry(geometry: BufferGeometry, plants: Planted): InstancedBufferGeometry {
  const all = new InstancedBufferGeometry()
  for (const [name, values] of Object.entries(geometry.attributes)) all.setAttribute(name, values)
  all.setIndex(geometry.index)
  plants.add(all)
  return all
}

/** Rank over which a plant goes where fewer are drawn. */
const GOING = 0.08

/** Share of a plant's size that is left where fewer of them are drawn. */
export function thinned({ from, to, least }: Thinning, { rank, distance }: PlantNodes): Float {
  const kept = mix(1, least, ramp(from, to, distance))
  return kept.add(GOING).sub(rank).div(GOING).clamp(0, 1)
}

const ramp = (from: number, to: number, value: Float): Float =>
  value
    .sub(from)
    .div(to - from)
    .clamp(0, 1)

/** A matte material whose haze is found at vertices, as that of the terrain is. */
export class PlantMaterial extends MeshLambertNodeMaterial {
  static override get type(): string {
    return 'PlantMaterial'
  }
  readonly airAtVertices = airAtVertices
}
