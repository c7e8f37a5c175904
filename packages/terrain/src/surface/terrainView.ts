import { attribute, cos, fract, mix, vec3 } from 'three/tsl'
import { fail } from '@welkin/geo'
import type { Float, Vec3, Vec4 } from '../tsl-types'

/** Questions about a terrain that colours answer. */
export type TerrainView = 'levels' | 'tiles' | 'pages'

/** Turn of the hue from a level to the next: the golden angle, so that neighbours differ. */
const HUE_STEP = 0.382

const GREEN = [0.1, 0.5, 0.15]
const YELLOW = [0.7, 0.55, 0.05]
const RED = [0.7, 0.06, 0.04]

const instance = (name: string): Vec4 => attribute(name, 'vec4')
const color = ([r, g, b]: number[]): Vec3 => vec3(r, g, b)

/** Colour of a hue in turns. */
const ofHue = (hue: Float): Vec3 =>
  cos(
    vec3(0, 1 / 3, 2 / 3)
      .add(hue)
      .mul(2 * Math.PI)
  )
    .mul(0.3)
    .add(0.4)

const views: Record<TerrainView, () => Vec3> = {
  levels: () => ofHue(instance('tileOffset').w.log2().mul(-HUE_STEP)),
  tiles: () => {
    const { xyz } = instance('tileCube')
    return ofHue(fract(xyz.div(instance('tileOffset').w).dot(vec3(0.137, 0.291, 0.419))))
  },
  pages: () => {
    const { x: own, y: parent, w: fade } = instance('tilePage')
    const isAlone = own.sub(parent).abs().greaterThan(0.5).or(fade.lessThan(0.5))
    return isAlone.select(mix(color(GREEN), color(YELLOW), fade), color(RED))
  }
}

/**
 * Colour of the ground that shows how a terrain is drawn:
 *
 * ```ts
 * terrain.material.colorNode = terrainView('levels')
 * ```
 *
 * @param view - Levels of detail (`'levels'`), single tiles (`'tiles'`), or whether their pages are there (`'pages'`): green, yellow as one
 *   fades in, and red where there is none and the ground is drawn with the coarser tile's.
 * @throws If there is no such view.
 */
export function terrainView(view: TerrainView): Vec3 {
  if (!(view in views)) {
    fail('terrainView', `view must be one of ${Object.keys(views).join(', ')}`, view)
  }
  return views[view]()
}
