import type { AirOccluder } from '@welkin/atmosphere'
import { cross, float, smoothstep } from 'three/tsl'
import type { Node } from 'three/webgpu'

/** Tangent of the sun's radius, by which shadows blur with their distance. */
const SUN = 0.00465

/** Distances between which the shadow sets in [m]: air beside the window is left alone. */
const FROM = [150, 400] as const

/**
 * Parts of an airliner as boxes in the plane of its wings: middle ahead of the window, half lengths along and across [m], and how
 * far the part is swept back over its half width [–].
 */
const PARTS = [
  [0, 19, 2, 0],
  [-1, 3, 17, 0.45],
  [-17, 1.6, 6, 0.45],
  [-17, 2, 0.3, 0]
] as const

/**
 * Shadow of the aeroplane that the camera looks out of, which flies across the sun's azimuth: for the clouds below, with `LightShafts.add`. It
 * stands in the middle of the glory.
 */
export const aeroplaneShadow = (): AirOccluder => ({
  castInto: () => ({
    transmittance:
      ({ view }) =>
      ({ offset }) => {
        const light = view.lightDirection
        const along = offset.dot(light).negate().toConst() as Node<'float'>
        // Across the rays: along the fuselage, and along the wings, which rays see foreshortened.
        const ahead = cross(view.up, light).normalize().toConst()
        const wing = cross(light, ahead)
        const height = light.dot(view.up).max(0.05)
        const forward = offset.dot(ahead).toConst() as Node<'float'>
        const aside = offset.dot(wing).toConst() as Node<'float'>
        const blur = along.mul(SUN).max(0.1).toConst()
        const inside = (place: Node<'float'>, half: Node<'float'>): Node<'float'> =>
          smoothstep(blur.negate(), blur, half.sub(place.abs()))
        let covered: Node<'float'> = float(0)
        for (const [middle, length, width, sweep] of PARTS) {
          const out = aside.div(height)
          const back = forward.sub(middle).add(out.abs().mul(sweep))
          // A fuselage is as high as it is wide, wings are flat.
          const half = sweep === 0 ? float(width) : height.mul(width)
          const part = inside(back, float(length)).mul(inside(aside, half))
          covered = covered.max(part)
        }
        return covered.mul(smoothstep(...FROM, along)).oneMinus()
      }
  })
})
