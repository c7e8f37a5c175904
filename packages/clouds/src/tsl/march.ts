import { horizontalIrradiance, transmittanceToSun } from '@welkin/atmosphere'
import { Break, If, float, int, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { CloudLight } from '../CloudLightTable'
import type { QualityUniforms } from '../quality'
import { loop, type Float, type Vec3, type Vec4 } from '../tsl-types'
import { cloudAmbient, cloudSource } from './cloudLight'
import { cloudBound, cloudExtinction, type CloudSample } from './density'
import { FAR_AWAY, groundDistance, nextShell, surroundings, type Surroundings } from './shells'

/** Steps that are skipped at once where there is no cloud. */
const SKIPPED = 3

/** Steps towards the sun and back: each is so many times as long as the one before. */
const PROBE_GROWTH = 2

/** Width of a step towards the sun per length: light comes from a cone, not from a line. */
const PROBE_WIDTH = 0.25

/** A sun lower than this does not make its rays any longer. */
const LOWEST_COSINE = 0.12

/** Least number of steps through a layer that is thinner than a few samples are wide. */
const LEAST_STEPS = 4

/** Part of a ray's light over which the light at one sample may stand for its successors. */
const SHARED_LIGHT = 0.02

/** Transmittance at which a march ends. */
const OPAQUE = 0.005

/** A ray from the camera, in the mapped space. */
export interface CloudRay {
  /** Unit length. */
  direction: Vec3
  /** Where it ends [m]. */
  end: Float
  /** Where in its steps a ray is sampled, in [0, 1). */
  jitter: Float
}

/** What a ray meets on its way. */
export interface MarchedClouds {
  /** Spectral radiance at the clouds for unit irradiance of the sun [1/sr]. */
  radiance: Vec4
  /** Of the light behind, in [0, 1]. */
  transmittance: Float
  /** Mean distance of what is seen, by what each place contributes; 0 if nothing is [m]. */
  distance: Float
  /** Steps that were taken. */
  steps: Float
}

/** Optical depths about a sample, not scaled. */
interface Depths {
  toSun: Float
  fromSun: Float
  above: Float
  below: Float
}

/** Marches from a sample towards the sun, away from it, up and down. */
function depthsAbout(
  field: CloudField,
  quality: QualityUniforms,
  sample: CloudSample,
  cosSun: Float,
  { base, top }: Surroundings
): Depths {
  const depths = vec4(0).toVar()
  const rise = top.sub(sample.altitude).max(1).toConst()
  const fall = sample.altitude.sub(base).max(1).toConst()
  const slant = cosSun.abs().max(LOWEST_COSINE).reciprocal().toConst()
  // One instance of the density for all four: shaders stay short.
  loop('probeAxis', 4, axis => {
    const isVertical = axis.greaterThanEqual(int(2)).toConst()
    const isBackward = axis
      .equal(int(1))
      .or(axis.equal(int(3)))
      .toConst()
    const forward = isVertical.select(sample.up, field.view.sunDirection)
    const direction = forward.mul(isBackward.select(-1, 1)).toConst() as Vec3
    const climbs = direction.dot(sample.up).greaterThanEqual(0)
    const reach = climbs.select(rise, fall).mul(isVertical.select(1, slant)).toConst() as Float
    const half = quality.sunSteps.add(int(1)).div(int(2)).toConst()
    const count = axis
      .equal(int(0))
      .select(quality.sunSteps, half.lessThan(int(3)).select(half, int(3)))
      .toConst()
    const length = reach
      .mul(PROBE_GROWTH - 1)
      .div(float(PROBE_GROWTH).pow(float(count)).sub(1))
      .toVar()
    const start = float(0).toVar()
    const sum = float(0).toVar()
    loop('probe', count, () => {
      const offset = sample.offset.add(direction.mul(start.add(length.mul(0.5)))).toConst() as Vec3
      const { altitude, up } = field.view.place(offset)
      const wide = length.mul(PROBE_WIDTH).div(field.pixelAngle)
      const distance = sample.distance.max(wide).toConst() as Float
      const extinction = cloudExtinction(field, { offset, altitude, up, distance }, false)
      sum.addAssign(extinction.mul(length))
      start.addAssign(length)
      length.mulAssign(PROBE_GROWTH)
    })
    const one = (index: number): Float => axis.equal(int(index)).select(1, 0)
    depths.addAssign(vec4(one(0), one(1), one(2), one(3)).mul(sum))
  })
  return { toSun: depths.x, fromSun: depths.y, above: depths.z, below: depths.w }
}

/** Spectral source function at a sample: radiance per scaled extinction. */
function sourceAt(
  field: CloudField,
  light: CloudLight,
  quality: QualityUniforms,
  sample: CloudSample,
  direction: Vec3,
  transmittance: Float
): Vec4 {
  const { view } = field
  const { uniforms, transmittance: air, diffuse } = view.air
  const about = surroundings(field, sample.altitude)
  const cosSun = sample.up.dot(view.sunDirection).clamp(-1, 1).toConst() as Float
  const cosView = sample.up.dot(direction).clamp(-1, 1).toConst() as Float
  const cosViewSun = direction.dot(view.sunDirection).clamp(-1, 1).toConst() as Float
  const depths = depthsAbout(field, quality, sample, cosSun, about)
  const scale = light.depthScale
  const layered = about.layered.toConst() as Float
  const depthToSun = depths.toSun.mul(scale).toConst() as Float
  const depthThrough = depthToSun.add(depths.fromSun.mul(scale)).toConst() as Float
  const sun = cloudSource(light, {
    depthToSun,
    depthThrough,
    depthAcross: depthThrough,
    depthToEye: transmittance.max(OPAQUE).log().negate().toConst(),
    layered,
    cosSun,
    cosView,
    cosViewSun
  })
  const source = transmittanceToSun(uniforms, air, sample.altitude, cosSun).mul(sun)
  if (diffuse === null) return source
  const irradiance = horizontalIrradiance(uniforms, diffuse, sample.altitude, cosSun)
  const ambient = cloudAmbient(
    light,
    {
      depthAbove: depths.above.mul(scale),
      depthBelow: depths.below.mul(scale),
      layered,
      cosView
    },
    irradiance.up.div(Math.PI),
    irradiance.down.div(Math.PI)
  )
  return source.add(ambient)
}

/**
 * Marches a ray through all layers, from shell to shell: jumps where no layer is, takes longer steps
 * where the weather is clear, and ends where nothing more is seen. Each step is integrated as if its
 * sample were all of it, L += T S (1 − e^{−τ′}), which conserves energy for steps of any length.
 *
 * To be called inside of a shader function.
 */
export function marchClouds(
  field: CloudField,
  light: CloudLight,
  quality: QualityUniforms,
  { direction, end, jitter }: CloudRay
): MarchedClouds {
  const { view } = field
  const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
  const last = end.min(groundDistance(field, cosView)).toConst() as Float
  const radiance = vec4(0).toVar()
  const transmittance = float(1).toVar()
  const source = vec4(0).toVar()
  /** Part of the ray's light since the source was last computed; at first, it never was. */
  const sinceLit = float(1).toVar()
  const weightedDistance = float(0).toVar()
  const steps = float(0).toVar()
  const position = float(0).toVar()
  /** End of the stretch between two shells. */
  const shell = float(0).toVar()
  const longest = float(FAR_AWAY).toVar()
  /** Steps to take before the weather is looked at again. */
  const pending = int(0).toVar()

  const sampleAt = (distance: Float): CloudSample => {
    const at = distance.toConst() as Float
    const offset = direction.mul(at).toConst() as Vec3
    const { altitude, up } = view.place(offset)
    return { offset, altitude, up, distance: at }
  }

  const step = (length: Float): void => {
    const sample = sampleAt(position.add(length.mul(jitter)))
    const extinction = cloudExtinction(field, sample, true).toConst() as Float
    If(extinction.greaterThan(1e-7), () => {
      const through = extinction.mul(light.depthScale).mul(length).negate().exp().toConst()
      const seen = transmittance.mul(through.oneMinus()).toConst() as Float
      sinceLit.addAssign(seen)
      If(sinceLit.greaterThan(SHARED_LIGHT), () => {
        source.assign(sourceAt(field, light, quality, sample, direction, transmittance))
        sinceLit.assign(0)
      })
      radiance.addAssign(source.mul(seen))
      weightedDistance.addAssign(sample.distance.mul(seen))
      transmittance.mulAssign(through)
    })
    position.addAssign(length)
    pending.subAssign(int(1))
  }

  loop('cloudStep', quality.steps, () => {
    If(position.greaterThanEqual(last).or(transmittance.lessThan(OPAQUE)), () => {
      Break()
    })
    steps.addAssign(1)
    If(position.greaterThanEqual(shell), () => {
      const next = nextShell(field, cosView, position.mul(1 + 1e-6).add(0.01))
        .min(last)
        .toConst()
      shell.assign(next)
      const { altitude } = view.place(direction.mul(position.add(next).mul(0.5)))
      const { base, top } = surroundings(field, altitude)
      const span = next.sub(position).toConst()
      const footprint = position.mul(field.pixelAngle)
      longest.assign(
        span
          .div(quality.layerSteps)
          .max(footprint.min(span.div(LEAST_STEPS)))
          .max(1)
      )
      pending.assign(int(0))
      If(base.greaterThan(top), () => {
        position.assign(next)
      })
    }).Else(() => {
      const growing = position.mul(quality.stepGrowth).max(quality.shortestStep)
      const left = shell.sub(position).toConst()
      const length = growing.min(longest).min(left).max(0.01).toConst() as Float
      const skip = length.mul(SKIPPED).min(left).max(0.01).toConst() as Float
      If(pending.lessThanEqual(int(0)), () => {
        const bound = cloudBound(field, sampleAt(position.add(skip.mul(jitter)))).toConst()
        If(bound.greaterThan(0), () => {
          pending.assign(int(SKIPPED))
        }).Else(() => {
          position.addAssign(skip)
        })
      })
      If(pending.greaterThan(int(0)), () => {
        step(length)
      })
    })
  })

  const opacity = transmittance.oneMinus().toConst()
  // What is as good as opaque is opaque: nothing bright may shine through.
  const whole = transmittance
    .sub(OPAQUE)
    .max(0)
    .div(1 - OPAQUE)
    .toConst() as Float
  return {
    radiance: radiance.mul(whole.oneMinus().div(opacity.max(1e-6))).toConst(),
    transmittance: whole,
    distance: weightedDistance.div(opacity.max(1e-6)).toConst(),
    steps
  }
}
