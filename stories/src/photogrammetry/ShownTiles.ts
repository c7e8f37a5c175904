import { Sphere } from 'three'
import type { Group, PerspectiveCamera } from 'three'
import { loadTiles, tilesProgress } from '../globe/loadTiles'
import { viewAt, type View } from '../globe/places'
import { SIGHTS, type SightName } from './places'
import { groundedFrame, placeInWords, standOf, viewOf, type Stand } from './stand'
import { unlitTiles, type TileSource, type UnlitTiles } from './unlitTiles'

/** Camera of the scene that shows tiles, and ways to move it. */
export interface TileScene {
  readonly camera: PerspectiveCamera
  /** Place that was chosen, of those of the whole world. */
  readonly place: SightName
  /** Follows the camera, and updates the tiles; called until all are loaded. */
  prepare(): void
  /** Has the camera look from a view, at once or by a flight. */
  goTo(view: View, flies: boolean): void
}

/** Ways in which tiles can be reached from here. */
interface Network {
  readonly onLine: boolean
  /** Origin of the page, which needs no network. */
  readonly origin: string
}

/** Tiles on show: those of a source, or local ones and the reason why. */
export class ShownTiles {
  /** Line about what is shown; empty for tiles of the world. */
  reason = ''
  /** Settles when all tiles of the view are loaded. */
  ready: Promise<void> = Promise.resolve()
  readonly #group: Group
  readonly #scene: TileScene
  readonly #size = { width: 1, height: 1 }
  #shown?: UnlitTiles
  #stand: Stand = 'place'
  #bounds = new Sphere()
  #loads = 0

  /** @param group - Has the tiles put into it; stands in a world that is ECEF. */
  constructor(group: Group, scene: TileScene) {
    this.#group = group
    this.#scene = scene
  }

  /** Shows the tiles of a source, or local ones if it has none to give or cannot be reached. */
  ask({ url, key }: TileSource, { onLine, origin }: Network): void {
    this.reason = ''
    if (url === '' && key === '') {
      this.reason = 'Local tiles: put a URL or a key into the controls for others.'
    } else if (!onLine && !url.startsWith(origin)) {
      this.reason = 'No network: these are local tiles.'
    }
    this.#show(this.reason === '' ? { url, key } : undefined)
  }

  /** Flies to the place that was chosen, or to the tiles if they stand at one. */
  revisit(): void {
    const { place, camera } = this.#scene
    const isOfPlace = this.#stand !== 'world' && this.#bounds.radius > 0
    const sight = SIGHTS[this.#stand === 'world' ? place : 'local']
    this.#scene.goTo(isOfPlace ? viewOf(this.#bounds, camera) : viewAt(sight), true)
  }

  #show(source: TileSource | undefined): void {
    const count = ++this.#loads
    const isOver = (): boolean => count !== this.#loads
    const { camera, place } = this.#scene
    this.#shown?.dispose()
    this.#group.clear()
    this.#stand = 'place'
    this.#bounds = new Sphere()
    const { tiles } = (this.#shown = unlitTiles(source))
    this.#group.add(tiles.group)
    tiles.setCamera(camera)
    this.setSize(this.#size.width, this.#size.height)
    this.#scene.goTo(viewAt(SIGHTS[source === undefined ? 'local' : place]), false)
    const before = camera.position.clone()
    if (source !== undefined) {
      tiles.addEventListener('load-root-tileset', () => {
        // Who has gone elsewhere meanwhile, by a link say, stays there.
        if (!isOver()) this.#settle(camera.position.distanceTo(before) < 1)
      })
    }
    this.ready = loadTiles([tiles], () => this.#scene.prepare(), isOver).catch(
      async (error: Error) => {
        if (source === undefined) throw error
        if (isOver()) return
        this.reason = `These tiles could not be loaded, so these are local ones.\n${error.message}`
        this.#show(undefined)
        await this.ready
      }
    )
    this.ready.catch(() => {})
  }

  /** Puts the tileset where it stands, and goes there. */
  #settle(goes: boolean): void {
    const tiles = this.#shown!.tiles
    if (!tiles.getBoundingSphere(this.#bounds)) return
    this.#stand = standOf(this.#bounds)
    if (this.#stand === 'world') return
    if (this.#stand === 'own') {
      groundedFrame(this.#bounds).decompose(
        tiles.group.position,
        tiles.group.quaternion,
        tiles.group.scale
      )
      tiles.group.updateMatrixWorld(true)
      this.#bounds.applyMatrix4(tiles.group.matrixWorld)
      this.reason = 'This tileset has no place on the Earth: it was put down in Tennessee.'
    } else {
      this.reason = `This tileset stands at ${placeInWords(this.#bounds.center)}.`
    }
    if (goes) this.#scene.goTo(viewOf(this.#bounds, this.#scene.camera), true)
  }

  /** Loads what the camera sees. */
  update(): void {
    this.#shown?.tiles.update()
  }

  /** Takes the size of the picture [pixels]. */
  setSize(width: number, height: number): void {
    Object.assign(this.#size, { width, height })
    this.#shown?.tiles.setResolution(this.#scene.camera, width, height)
  }

  /** Share of the tiles of the view that are loaded. */
  get progress(): number {
    return this.#shown === undefined ? 0 : tilesProgress([this.#shown.tiles])
  }

  /** Lines to be shown: why these tiles, and whose they are. */
  get text(): string {
    const credits = this.#shown?.tiles.getAttributions() ?? []
    const names = credits.filter(({ type }) => type === 'string').map(({ value }) => String(value))
    return [this.reason, ...names].join('\n').trim()
  }

  dispose(): void {
    this.#loads++
    this.#shown?.dispose()
  }
}
