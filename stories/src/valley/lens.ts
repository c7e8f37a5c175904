import { float, Fn, varying, vec2 } from 'three/tsl'
import type { Node, TextureNode } from 'three/webgpu'

/** Distances of places from the middle of the picture, over its size, that a lens focuses on. */
const SPREAD = 0.04

/** Nearest distance that it focuses on [m]. */
const NEAREST = 1.5

/** Blur of what is far away by focus, as three's bokeh scale times metres: a lens of 85 mm at f/1.4; and the most of it. */
const APERTURE = 24
const MOST_BLUR = 2.5

/** A lens as three's depth of field has it. */
interface Lens {
  /** Distance that is sharp, and distance from there over which sharpness is lost [m]. */
  readonly focus: Node<'float'>
  readonly range: Node<'float'>
  /** Bokeh scale. */
  readonly blur: Node<'float'>
}

/**
 * A lens that focuses on what is in the middle of a picture. The farther that is, the less is blurred: mountains stay
 * mountains, and a tree at arm's length stands before a soft valley.
 *
 * @param picture - Has the distance along the camera's axis in alpha [m].
 */
export function lensOn(picture: TextureNode): Lens {
  const focus = varying(
    Fn(() => {
      const places = [-1, 0, 1].flatMap(x => [-1, 0, 1].map(y => [x, y]))
      const nearness = places.map(([x, y]) => {
        const place = vec2(0.5 + SPREAD * x, 0.5 + SPREAD * y)
        return (picture.sample(place).level(float(0)) as unknown as Node<'vec4'>).a.reciprocal()
      })
      const sum = nearness.reduce<Node<'float'>>((total, each) => total.add(each), float(0))
      return float(places.length).div(sum).max(NEAREST)
    })()
  ) as Node<'float'>
  // As far again behind it, half of the greatest blur is reached.
  return { focus, range: focus.mul(2), blur: float(APERTURE).div(focus).min(MOST_BLUR) }
}
