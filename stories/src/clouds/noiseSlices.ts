import type { CloudNoise } from '@welkin/clouds'
import {
  float,
  Fn,
  screenSize,
  screenUV,
  select,
  texture3D,
  uniform,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import type { Node } from 'three/webgpu'

/** Rows and columns of squares, and the share of one that is left free beside it. */
const [ROWS, COLUMNS, GAP] = [3, 4, 0.06]
/** Grey between the squares. */
const GROUND = 0.02

/** Slices of the noise that clouds are made of, as a picture. */
export interface NoiseSlices {
  readonly node: Node
  /** Place of the slices in the volumes, in [0, 1]. */
  readonly place: { value: number }
}

/** A row of squares for each of weather, shape and detail, with their components side by side. */
export function noiseSlices({ weather, shape, detail }: CloudNoise): NoiseSlices {
  const place = uniform(0.5)
  const node = Fn(() => {
    const across = screenSize.x.div(screenSize.y).mul(ROWS)
    const cells = screenUV
      .mul(vec2(across, ROWS))
      .sub(vec2(across.sub(COLUMNS).div(2), 0))
      .toConst()
    const cell = cells.floor().toConst()
    const inside = cells
      .fract()
      .sub(GAP / 2)
      .div(1 - GAP)
      .toConst()
    const [first, second, third] = [weather, shape, detail].map(noise =>
      texture3D(noise.target.texture, vec3(inside, place)).level(float(0)).toConst()
    )
    const texel = select(cell.y.lessThan(1), first, select(cell.y.lessThan(2), second, third))
    const component = vec4(0, 1, 2, 3).sub(cell.x).abs().lessThan(0.5)
    // As bright on the screen as its value.
    const value = texel.dot(vec4(component)).max(0).pow(2.2).toConst()
    const isSquare = inside
      .sub(0.5)
      .abs()
      .lessThan(0.5)
      .all()
      .and(cell.x.greaterThanEqual(0))
      // Detail has one component.
      .and(cell.x.lessThan(select(cell.y.lessThan(2), float(COLUMNS), float(1))))
    return vec4(vec3(select(isSquare, value, float(GROUND))), 1)
  })()
  return { node, place }
}
