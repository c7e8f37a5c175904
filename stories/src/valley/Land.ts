import type { CloudQualityName } from '@welkin/clouds'
import { Group, type Mesh, type PerspectiveCamera } from 'three'
import { disposeMeshes } from '../scene'
import type { ValleyPrecipitation } from './falling'
import { createBirches, createForest, createGrove } from './forest'
import { drawFromNear } from './drawOrder'
import { createGround, groundHeight } from './ground'
import { OpenSky } from './OpenSky'
import { Relief } from './relief'
import type { StreetLamps } from './StreetLamps'
import type { Trees } from './Trees'
import { trunkTops } from './trunks'
import { outlines } from './village'

/** Quads of the ground along a side, by quality. */
const QUADS: Readonly<Record<CloudQualityName, number>> = {
  low: 256,
  medium: 320,
  high: 640,
  ultra: 800
}

/** Texels along an edge of the map of slopes, by quality. */
const RELIEF: Readonly<Record<CloudQualityName, number>> = {
  low: 512,
  medium: 2048,
  high: 2048,
  ultra: 2048
}

/** Trees that stand one by one, by quality. */
const TREES: Readonly<Record<CloudQualityName, number>> = {
  low: 3000,
  medium: 10_000,
  high: 18_000,
  ultra: 30_000
}

/** Ground and trees, as fine as the quality; it may change while they are shown. */
export class Land extends Group {
  readonly #falling: ValleyPrecipitation
  readonly #lamps: StreetLamps
  #quality?: CloudQualityName
  #hasTrees = true
  #hasVillage = true
  #ground = new Group()
  #relief?: Relief
  #sky?: OpenSky
  #trees: readonly Trees[] = []
  #trunks?: ReturnType<typeof trunkTops> | undefined

  constructor(falling: ValleyPrecipitation, lamps: StreetLamps) {
    super()
    this.name = 'Land'
    this.#falling = falling
    this.#lamps = lamps
  }

  /** Has ground and trees of a quality; makes them anew if it is another. */
  setQuality(quality: CloudQualityName): void {
    if (quality === this.#quality) return
    this.#quality = quality
    this.dispose()
    this.clear()
    this.#relief = new Relief(RELIEF[quality])
    const lamplight = this.#lamps.reflected()
    const { water } = this.#falling
    const trees = TREES[quality]
    this.#trunks = undefined
    this.#trees = [
      createForest(trees, water),
      createGrove(Math.round(trees / 16), water),
      createBirches(Math.round(trees / 48), water)
    ]
    const sky = new OpenSky()
    sky.addHouses(outlines())
    for (const each of this.#trees) sky.addTrees(each.trees.map(({ matrix }) => matrix))
    this.#sky = sky
    this.#ground = createGround(QUADS[quality], water, this.#relief, lamplight, sky)
    this.add(this.#ground, ...this.#trees)
    this.show(this.#hasTrees, this.#hasVillage)
  }

  /** Shows trees or not, and the shade of the village. */
  show(trees: boolean, village: boolean): void {
    this.#hasTrees = trees
    this.#hasVillage = village
    for (const each of this.#trees) each.visible = trees
    this.#sky?.show({ houses: village, trees })
  }

  /** Height of the top of the trunk at a place: −∞ beside all of them, or where trees are not shown [m]. */
  trunkAt(position: Readonly<Record<'x' | 'z', number>>): number {
    if (!this.#hasTrees) return -Infinity
    this.#trunks ??= trunkTops(
      this.#trees.flatMap(({ trees }) => trees),
      groundHeight
    )
    return this.#trunks(position)
  }

  /**
   * Sorts ground and trees for a camera.
   *
   * @returns True if other trees are drawn now.
   */
  update(camera: PerspectiveCamera): boolean {
    for (const tile of this.#ground.children) drawFromNear(tile as Mesh, camera.position)
    return this.#trees.map(each => each.update(camera)).includes(true)
  }

  /** Frees what is drawn. */
  override dispose(): void {
    disposeMeshes(this.#ground.children as Mesh[])
    for (const each of this.#trees) each.dispose()
    this.#relief?.dispose()
    this.#sky?.dispose()
  }
}
