import {
  Fn,
  If,
  attribute,
  cameraProjectionMatrix,
  cross,
  hash,
  int,
  log,
  screenSize,
  smoothstep,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import type { Float, Int, Mat3, Mat4, Vec3, Vec4 } from '../../tsl-types'
import { CELLS, CHUNK, LAYER, STRATA } from '../FallingChunks'
import { LOOP_TIME } from '../FallingLattice'
import type { LampUniforms } from '../LampUniforms'
import type { MeasuredLight } from '../MeasuredLight'
import type { ParticleKind } from '../ParticleKind'
import type { PrecipitationShelter } from '../PrecipitationShelter'
import type { PrecipitationUniforms } from '../PrecipitationUniforms'
import { litParticle } from './litParticle'
import { keptWeight } from './keptWeight'
import { streakShape } from './particleShape'
import type { ParticleVaryings } from './particleFragment'

/** Distances over which particles in front of the lens fade [m]. */
export const LENS = [0.12, 0.35] as const
/** Half width of the filter of edges [pixels]: lines are as smooth as they need, and cover few pixels. */
const FOOTPRINT = 0.75
/** Share of its box's half side, and of a class's reach, from which particles fade. */
export const EDGE_FADE = 0.9
export const REACH_FADE = 0.7

/** Numbers of a particle, the same at all times: even in [0, 1). */
const randomOf = (particle: Int, sizeClass: Float): ((n: number) => Float) => {
  const seed = particle.mul(32).add(int(sizeClass).mul(8)).toConst()
  return n => hash(seed.add(n))
}

/** Lights of particles, and roofs over them. */
export interface ParticleSurroundings {
  readonly measured: MeasuredLight
  readonly lamps: readonly LampUniforms[]
  readonly shelter: PrecipitationShelter | null
}

/**
 * Corner of a particle's streak in clip space; its varyings are set on the way. Particles that are not there or not seen have no area.
 *
 * The mesh has corners in [−1, 1]² and the particle's number in its chunk; instances are chunks.
 */
export function particleVertex(
  kind: ParticleKind,
  uniforms: PrecipitationUniforms,
  varyings: ParticleVaryings,
  { measured, lamps, shelter }: ParticleSurroundings
): Vec4 {
  return Fn((): Vec4 => {
    const corner = attribute('position', 'vec3') as unknown as Vec3
    const chunk = attribute('chunk', 'vec4') as unknown as Vec4
    const { x: number, y: group, z: fall, w: speed } = chunk
    const sizeClass = group.div(STRATA).floor().toConst() as Float
    const stratum = group.sub(sizeClass.mul(STRATA))
    const at = uniforms.classOf(sizeClass)
    const particle = int(number).mul(CHUNK).add(int(corner.z)).toConst() as Int
    const random = randomOf(particle, at.index)
    const drawnSlope = kind.sizes(kind.drawnRate).slope
    const share = random(0).add(stratum).div(STRATA)
    const diameter = log(share.mul(at.range).oneMinus())
      .div(-drawnSlope)
      .add(at.edge)
      .toConst() as Float
    const there = uniforms.slope.mul(diameter).exp().mul(uniforms.share).mul(at.proposed)
    const clip = vec4(2, 2, 2, 1).toVar() as Vec4

    // Layers have all sizes, in random order: those of a rate are among the first.
    const layer = number.div(LAYER / CHUNK).floor()
    const order = layer.add(hash(particle.add(0x5bd1e995))).mul(LAYER)

    If(order.lessThan(there), () => {
      const column = number.div(CELLS).floor().toConst() as Float
      const row = column.div(CELLS).floor().toConst() as Float
      const place = vec3(
        random(1).add(column.sub(row.mul(CELLS))),
        random(2).add(number.sub(column.mul(CELLS))),
        random(3).add(row.sub(row.div(CELLS).floor().mul(CELLS)))
      )
        .div(CELLS)
        .add(at.drift)
        .sub(vec3(0, fall, 0))
        .fract()
        .toConst()
      const box = place.sub(0.5).toConst() as Vec3
      const offset = box.mul(at.side).add(at.middle).toVar() as Vec3
      const velocity = uniforms.velocity.sub(vec3(0, speed, 0)).toVar() as Vec3
      const [amplitude, frequency] = kind.flutter
      if (amplitude > 0) {
        // Whole turns per loop, between half and one and a half times the mean frequency.
        const turn = random(4)
          .add(0.5)
          .mul(frequency * LOOP_TIME)
          .round()
        const angles = vec2(turn.mul(uniforms.phase), turn.mul(0.7).round().mul(uniforms.phase))
          .fract()
          .add(vec2(random(5), random(6)))
          .mul(2 * Math.PI)
          .toConst()
        const swing = angles.sin().mul(amplitude)
        const swerve = angles
          .cos()
          .mul(turn)
          .mul((amplitude * 2 * Math.PI) / LOOP_TIME)
        offset.addAssign(vec3(swing.x, 0, swing.y))
        velocity.addAssign(vec3(swerve.x, 0, swerve.y))
      }
      const distance = offset.length().toConst() as Float
      const kept = keptWeight(at.fullReach, order.div(there), distance.div(at.reach)).toConst()
      const side = box.abs().mul(2).toConst() as Vec3
      const fade = smoothstep(EDGE_FADE, 1, side.x.max(side.y).max(side.z))
        .oneMinus()
        .mul(smoothstep(REACH_FADE, 1, distance.div(at.reach)).oneMinus())
        .mul(smoothstep(...LENS, distance))
      const toView = uniforms.toView as unknown as Mat3
      const head = toView.mul(offset).toConst() as Vec3
      const way = toView.mul(velocity.mul(uniforms.shutter)).toConst() as Vec3
      const tail = head.sub(way).toConst() as Vec3
      const projection = cameraProjectionMatrix as unknown as Mat4
      const middle = projection.mul(vec4(head.sub(way.mul(0.5)), 1)).toConst() as Vec4
      const reachOfView = middle.w.mul(1.3).add(way.length())
      const outside = middle.xy.abs().sub(reachOfView).toConst()
      const isInView = outside.x
        .max(outside.y)
        .lessThan(0)
        .and(fade.mul(kept).greaterThan(0))
        .and(head.z.max(tail.z).lessThan(0))
      const isDrawn = shelter === null ? isInView : isInView.and(shelter.isOpen(head))

      If(isDrawn, () => {
        const unit = uniforms.unit
        const pixel = middle.w
          .mul(2 * FOOTPRINT)
          .div(projection.element(1).element(1).mul(screenSize.y))
        const focused = distance.div(uniforms.focus).oneMinus().abs().mul(uniforms.aperture)
        const blur = pixel
          .mul(pixel)
          .add(focused.mul(focused).mul(unit.mul(unit)))
          .sqrt()
        const width = kind.width(diameter).mul(unit).toConst() as Float
        const length = way.length().toConst() as Float
        // Of motion towards the camera only the part across the line of sight counts.
        const toCamera = head.add(tail).normalize().toConst() as Vec3
        const across = way.sub(toCamera.mul(way.dot(toCamera))).toConst() as Vec3
        const seenLength = across.length().toConst() as Float
        const { inner, outer, opacity } = streakShape(width, seenLength, blur, kind.isSoft)
        const sharpness = kind.isSoft ? width.div(width.add(blur)) : inner.div(outer)
        const axis = seenLength.greaterThan(length.mul(1e-3)).select(across, vec3(0, 1e-6, 0))
        const along = axis
          .add(vec3(0, 1e-9, 0))
          .normalize()
          .toConst() as Vec3
        const aside = cross(along, toCamera).normalize().toConst() as Vec3
        const reach = outer.mul(corner.y).add(seenLength.mul(0.5).mul(corner.y)).toConst()
        const position = head
          .sub(way.mul(0.5))
          .add(along.mul(reach))
          .add(aside.mul(outer.mul(corner.x)))
        clip.assign(projection.mul(vec4(position, 1)))
        varyings.across.assign(vec2(corner.x, reach.div(outer)))
        varyings.shape.assign(
          vec4(seenLength.div(outer).mul(0.5), sharpness, random(7), position.z)
        )
        const light = litParticle(kind, measured, lamps, at.index, offset.div(distance), head)
        const alpha = opacity.mul(at.weight.mul(kept)).mul(uniforms.opacity).min(1).mul(fade)
        varyings.light.assign(vec4(light, alpha))
      })
    })
    return clip
  })()
}
