import type { CloudQualityName } from '@welkin/clouds'
import { Group, type Mesh, type PerspectiveCamera } from 'three'
import { disposeMeshes } from '../scene'
import type { ValleyPrecipitation } from './falling'
import { createBirches, createForest, createGrove } from './forest'
import { createGround } from './ground'
import { Relief } from './relief'
import type { StreetLamps } from './StreetLamps'
import type { Trees } from './Trees'

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
  #ground = new Group()
  #relief?: Relief
  #trees: readonly Trees[] = []

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
    this.#ground = createGround(QUADS[quality], water, this.#relief, lamplight)
    const trees = TREES[quality]
    const snow = water.snowCoverNode
    this.#trees = [
      createForest(trees, snow),
      createGrove(Math.round(trees / 16), snow),
      createBirches(Math.round(trees / 48), snow)
    ]
    this.add(this.#ground, ...this.#trees)
    this.showTrees(this.#hasTrees)
  }

  showTrees(areShown: boolean): void {
    this.#hasTrees = areShown
    for (const each of this.#trees) each.visible = areShown
  }

  /**
   * Sorts the trees for a camera.
   *
   * @returns True if other trees are drawn now.
   */
  update(camera: PerspectiveCamera): boolean {
    return this.#trees.map(each => each.update(camera)).includes(true)
  }

  /** Frees what is drawn. */
  override dispose(): void {
    disposeMeshes(this.#ground.children as Mesh[])
    for (const each of this.#trees) each.dispose()
    this.#relief?.dispose()
  }
}
