import { heightFieldShadow, type AirOccluder } from '@welkin/atmosphere'
import { CloudLayers, CloudLightTable, cloudAirShadow, clouds, cloudWorldMap } from '@welkin/clouds'
import { Matrix4, Vector3 } from 'three'
import { float } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from '../harness/atmosphere'
import { worldMap } from '../harness/cloud-scene'
import { coarse, fog, SparseNoise } from '../harness/cloud-view'
import type { GpuContext } from '../harness/context'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { addBox, stage, stageSize as size, type Stage } from '../harness/shaft-stage'

/** Sun or moon in the north, soon after it has risen [°]; a deck and the camera over it [m]. */
const LIGHT = 10
const deck = { ...fog, baseAltitude: 300, topAltitude: 600 }
const EYE = 2000

/** A mountain north of the camera: place, breadth from west to east and height [m]. */
const mountain = { z: -2500, width: 3000, height: 2400 }

/** Pixels of a row whose mean is compared: the march has noise. */
const COLUMNS = 8

/** Mean of some pixels of a row. */
const meanOf = (picture: Picture, first: number, y: number): number =>
  Array.from({ length: COLUMNS }, (_, i) => picture.at(first + i, y)[1]).reduce((a, b) => a + b) /
  COLUMNS

/** Edge of the field of heights [m]. */
const FIELD = 20_000

/** A low deck below a camera, in the light of the sun or, with a map of the world, of the moon. */
function deckBelow(
  renderer: WebGPURenderer,
  isMoonlit: boolean
): { set: Stage; pipeline: RenderPipeline; draw: () => Promise<Picture>; dispose: () => void } {
  const set = stage(renderer, LIGHT, {}, isMoonlit)
  const { shafts, camera, air, depth, atmosphere } = set
  const [light, noise, cover] = [new CloudLightTable(), new SparseNoise(), worldMap()]
  const node = clouds(air, depth, camera, atmosphere, new CloudLayers([deck]), {
    quality: coarse,
    noise,
    light,
    worldMap: isMoonlit ? cloudWorldMap(cover) : null,
    extinction: () => float(0.05),
    // Light of the moon alone, or of the sun.
    nightIlluminance: 0
  })
  node.time = 0
  // No light of the picture before.
  node.accumulates = false
  shafts.add(cloudAirShadow(node))
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  pipeline.outputNode = node
  camera.position.y = EYE
  camera.lookAt(new Vector3(0, -0.35, 1).add(camera.position))
  camera.updateMatrixWorld()
  return {
    set,
    pipeline,
    async draw() {
      for (let i = 0; i < 3; i++) {
        await nextFrame()
        pipeline.render()
      }
      await nextFrame()
      return drawToFloat(renderer, () => pipeline.render())
    },
    dispose() {
      for (const owned of [node, pipeline, light, noise, cover, set]) owned.dispose()
    }
  }
}

/** Occluder of all light. */
const darkness: AirOccluder = { castInto: () => ({ transmittance: () => () => float(0) }) }

/** Fails unless the deck is dark in the mountain's shadow and lit outside of it. */
function checkShadow(
  t: GpuContext,
  { camera }: Stage,
  lit: Picture,
  dark: Picture,
  pictures: Record<string, Picture>
): void {
  const { z, width, height } = mountain
  // Where the light that just passes over the mountain meets the deck [m south of the camera].
  const edge = z + (height - deck.topAltitude) / Math.tan((LIGHT * Math.PI) / 180)
  const parts: number[] = []
  for (let y = 0; y < size.height; y++) {
    for (const x of [0, (size.width - COLUMNS) / 2, size.width - COLUMNS]) {
      const ndc = [
        ((x + COLUMNS / 2) / size.width) * 2 - 1,
        1 - ((y + 0.5) / size.height) * 2
      ] as const
      const ray = new Vector3(...ndc, 0.5).unproject(camera).sub(camera.position)
      if (ray.y > -0.1 * ray.length()) continue
      const seen = ray.multiplyScalar((deck.topAltitude - EYE) / ray.y)
      // Places that are clearly inside or outside of the shadow.
      const inside = Math.min(edge - seen.z, width / 2 - Math.abs(seen.x))
      if (Math.abs(inside) < Math.max(0.2 * seen.z, 400)) continue
      for (const [label, picture] of Object.entries(pictures)) {
        const [all, none, here] = [lit, dark, picture].map(each => meanOf(each, x, y))
        const part = (here - none) / (all - none)
        const where = `${label}, ${seen.x.toFixed(0)} m east, ${seen.z.toFixed(0)} m south`
        parts.push(part)
        // Before a shadow air is lit, and before lit places some is in shadow.
        expectClose(part, inside > 0 ? 0 : 1, { absolute: inside > 0 ? 0.15 : 0.2 }, where)
      }
    }
  }
  t.note(`${Math.min(...parts).toFixed(3)} to ${Math.max(...parts).toFixed(3)} of the light`)
  const least = 20 * Object.keys(pictures).length
  expectTrue(parts.length > least, `${parts.length} places are seen`)
}

gpuTest(
  "has a mountain's shadow fall on a low deck at sunrise, by a shadow map and by heights",
  async t => {
    const { set, draw, dispose } = deckBelow(await t.createRenderer(size), false)
    const { shafts, scene } = set
    const { z, width, height } = mountain
    const lit = await draw()
    const block = addBox(scene, [0, height / 2, z], [width, height, 100])
    const byMap = await draw()
    scene.remove(block)
    const matrix = new Matrix4()
      .makeBasis(new Vector3(FIELD, 0, 0), new Vector3(0, 0, FIELD), new Vector3(0, 1, 0))
      .setPosition(-FIELD / 2, 0, -FIELD / 2)
    const hills = heightFieldShadow(
      at => {
        const place = at.sub(0.5).mul(FIELD).toConst()
        const isBeside = place.x.abs().lessThan(width / 2)
        return isBeside.and(place.y.sub(z).abs().lessThan(50)).select(height, 0)
      },
      matrix,
      { size: 1024 }
    )
    shafts.add(hills)
    const byHeights = await draw()
    shafts.remove(hills).add(darkness)
    const dark = await draw()
    checkShadow(t, set, lit, dark, { 'shadow map': byMap, heights: byHeights })
    dispose()
  },
  // The same look-ups as in the air, which WebGL draws, too.
  { backends: ['webgpu'] }
)

gpuTest(
  "has a mountain's shadow fall on a low deck by moonlight, with clouds of a map of the world",
  async t => {
    const { set, draw, dispose } = deckBelow(await t.createRenderer(size), true)
    const { shafts, scene } = set
    const { z, width, height } = mountain
    const lit = await draw()
    addBox(scene, [0, height / 2, z], [width, height, 100])
    const byMap = await draw()
    shafts.add(darkness)
    const dark = await draw()
    checkShadow(t, set, lit, dark, { 'shadow map': byMap })
    dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  "has clouds at a shadow's edge in the same light, whatever the noise of their rays",
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    addBox(set.scene, [0, 300, -1500], [600, 600, 50])
    for (let i = 0; i < 2; i++) await set.draw()
    // Out of the box's shadow, on both sides of the camera's axis.
    const places = Array.from({ length: 401 }, (_, i) => [i / 400 - 0.5, 0.02, -1, 900])
    const lit: number[][] = []
    for (const noise of [0.1, 0.35, 0.6, 0.9]) {
      const found = await evaluateOnGpu(renderer, places, ({ xyz, w }) => {
        const length = xyz.length()
        const ray = { direction: xyz.div(length), jitter: float(noise) }
        return set.shafts.litAt(ray, w.mul(length))
      })
      lit.push(places.map((_, i) => found[4 * i]))
    }
    const apart = Math.max(
      ...places.map((_, i) => {
        const parts = lit.map(row => row[i])
        return Math.max(...parts) - Math.min(...parts)
      })
    )
    const [least, most] = [Math.min(...lit[0]), Math.max(...lit[0])]
    t.note(`${least.toFixed(2)} to ${most.toFixed(2)} lit, ${apart.toFixed(4)} apart at most`)
    expectTrue(least < 0.01 && most > 0.99, 'there is no edge')
    expectTrue(apart < 1e-3, `light is ${apart} apart`)
    set.dispose()
  },
  // Angles are compared alike on both.
  { backends: ['webgpu'] }
)
