import { Break, If, float, int, vec2, vec3, vec4 } from 'three/tsl'
import { loop, type Float, type Int, type Vec2, type Vec3, type Vec4 } from '../../tsl-types'
import { pairMatter } from '../../density/tsl/density'
import type { CloudSample } from '../../density/tsl/sample'
import { lightUp, OPAQUE, sourceAt, type ShadingContext } from '../../light/tsl/lighting'
import { FAR_AWAY, nextShell, surroundings } from './shells'

/** Least number of steps through a layer that is thinner than a few samples are wide. */
const LEAST_STEPS = 4

/** Vertical optical depth of a layer below which it takes fewer steps, and the least part of them. */
const THIN = 4
const LEAST_EFFORT = 0.35

/** Part of a ray's light over which the light at one sample may stand for its successors. */
const SHARED_LIGHT = 0.05

/** A ray from the camera, in the mapped space. */
export interface CloudRay {
  /** Unit length. */
  direction: Vec3
  /** Where it ends, at the ground at the latest [m]. */
  end: Float
  /** How the steps of a ray are shifted, in [0, 1). */
  jitter: Float
  /** How far there is no cloud for sure; 0 if left out [m]. */
  start?: Float
}

/** What a ray meets on its way. */
export interface MarchedClouds {
  /** Spectral radiance at the clouds for unit irradiance of the bare sun [1/sr]. */
  radiance: Vec4
  /** Of the light behind, in [0, 1]. */
  transmittance: Float
  /** Mean distance of what is seen, by what each place contributes; of the first layer if nothing is [m]. */
  distance: Float
  /** Steps that were taken. */
  steps: Float
}

/**
 * Marches a ray through all layers, from shell to shell: jumps where no layer is, skips what the weather
 * leaves clear, and ends where nothing more is seen. Each step is integrated as if its sample were all
 * of it, L += T S (1 − e^{−τ′}), which conserves energy for steps of any length. Steps go in pairs that
 * share weather and light.
 *
 * To be called inside of a shader function.
 */
export function marchClouds(
  context: ShadingContext,
  { direction, end, jitter, start = float(0) }: CloudRay
): MarchedClouds {
  const { field, light, quality } = context
  const { view } = field
  const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
  const radiance = vec4(0).toVar() as Vec4
  const transmittance = float(1).toVar()
  /** Part of the ray's light since the source was last computed; at first, it never was. */
  const sinceLit = float(1).toVar()
  const source = vec3(0).toVar() as Vec3
  /** Of light from the layers between two shells: shares, and distance by opacity. */
  const passing = vec4(0).toVar() as Vec4
  const passingSeen = float(0).toVar()
  const weightedDistance = float(0).toVar()
  const steps = float(0).toVar()
  const position = start.toVar()
  /** End of the stretch between two shells. */
  const shell = float(0).toVar()
  const longest = float(FAR_AWAY).toVar()
  /** The layers on it. */
  const about = {
    base: float(0).toVar(),
    top: float(0).toVar(),
    layered: float(0).toVar(),
    range: { first: int(0).toVar() as Int, last: int(0).toVar() as Int }
  }
  const growth = float(0).toVar()
  const entry = float(0).toVar()
  /** Of the next pair's length: the first one of a row is cut short, by chance, so that no layers show. */
  const part = jitter.toVar()
  const sampleAt = (distance: Float): CloudSample => {
    const at = distance.toConst() as Float
    const offset = direction.mul(at).toConst() as Vec3
    return { offset, ...view.place(offset), distance: at }
  }
  /** Layers apart may be lit apart: a high one is in the sun when a low one is not. */
  const leaveLayers = (): void => {
    If(passingSeen.greaterThan(0), () => {
      const sample = sampleAt(passing.w.div(passingSeen))
      radiance.addAssign(lightUp(field, sample, passing.xyz))
      weightedDistance.addAssign(passing.w)
      passing.assign(vec4(0))
      passingSeen.assign(0)
    })
  }

  loop('cloudPair', quality.pairs, () => {
    If(position.greaterThanEqual(end).or(transmittance.lessThan(OPAQUE)), () => {
      Break()
    })
    steps.addAssign(2)
    If(position.greaterThanEqual(shell), () => {
      leaveLayers()
      const next = nextShell(field, cosView, position.mul(1 + 1e-6).add(0.01))
        .min(end)
        .toConst()
      shell.assign(next)
      part.assign(jitter)
      const { altitude } = view.place(direction.mul(position.add(next).mul(0.5)))
      const found = surroundings(field, altitude)
      about.base.assign(found.base)
      about.top.assign(found.top)
      about.layered.assign(found.layered)
      about.range.first.assign(found.range.first)
      about.range.last.assign(found.range.last)
      // What is thin all the way through has no hard edges.
      const ease = found.depth.div(THIN).clamp(LEAST_EFFORT, 1).toConst() as Float
      growth.assign(quality.stepGrowth.div(ease))
      const span = next.sub(position).toConst()
      const footprint = position.mul(field.pixelAngle)
      longest.assign(
        span
          .div(quality.layerSteps.mul(ease).max(LEAST_STEPS))
          .max(footprint.min(span.div(LEAST_STEPS)))
          .max(1)
      )
      If(found.base.greaterThan(found.top), () => {
        position.assign(next)
      }).ElseIf(entry.equal(0), () => {
        entry.assign(position.max(1))
      })
    }).Else(() => {
      const growing = position.mul(growth).max(quality.shortestStep)
      const left = shell.sub(position).toConst()
      const whole = growing.min(longest).toConst() as Float
      const length = whole.mul(part).min(left.mul(0.5)).max(0.01).toConst() as Float
      part.assign(1)
      const ahead = [0.5, 1.5].map(at => length.mul(at).toConst() as Float)
      const places = ahead.map(distance => position.add(distance).toConst() as Float)
      const matter = pairMatter(
        field,
        sampleAt(position.add(length)),
        places.map(at => () => sampleAt(at)),
        direction,
        about.range
      )
      const depth = matter.extinction.mul(light.depthScale).mul(length).toConst() as Vec2
      const through = depth.negate().exp().toConst() as Vec2
      const seen = vec2(
        transmittance.mul(through.x.oneMinus()),
        transmittance.mul(through.x).mul(through.y.oneMinus())
      ).toConst() as Vec2
      const both = seen.x.add(seen.y).toConst() as Float
      If(both.greaterThan(1e-7), () => {
        const at = places[0].mul(seen.x).add(places[1].mul(seen.y)).toConst()
        sinceLit.addAssign(both)
        If(sinceLit.greaterThan(SHARED_LIGHT), () => {
          const { sun, sky, ground } = sourceAt(context, {
            sample: sampleAt(at.div(both)),
            weather: matter.weather,
            direction,
            transmittance,
            dither: jitter,
            layers: about
          })
          source.assign(vec3(sun, sky, ground))
          sinceLit.assign(0)
        })
        passing.addAssign(vec4(source.mul(both), at))
        passingSeen.addAssign(both)
        transmittance.mulAssign(through.x.mul(through.y))
        position.addAssign(length.mul(2))
      }).Else(() => {
        const clear = ahead[1].add(matter.clearance).toConst() as Float
        part.assign(clear.greaterThan(whole.mul(2)).select(jitter, 1))
        position.addAssign(length.mul(2).max(clear.min(left)))
      })
    })
  })
  leaveLayers()

  const opacity = transmittance.oneMinus().toConst()
  // What is as good as opaque is opaque: nothing bright may shine through.
  const passed = transmittance
    .sub(OPAQUE)
    .max(0)
    .div(1 - OPAQUE)
    .toConst() as Float
  const nothing = entry.greaterThan(0).select(entry, end.min(FAR_AWAY))
  return {
    radiance: radiance.mul(passed.oneMinus().div(opacity.max(1e-6))).toConst(),
    transmittance: passed,
    distance: opacity
      .greaterThan(1e-4)
      .select(weightedDistance.div(opacity.max(1e-6)), nothing)
      .toConst(),
    steps
  }
}
