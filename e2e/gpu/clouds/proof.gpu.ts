import {
  Atmosphere,
  SkyLightProbe,
  SunDirectionalLight,
  aerialPerspective
} from '@welkin/atmosphere'
import {
  CloudLayers,
  CloudLightTable,
  CloudNoise,
  clouds,
  cloudShadow,
  cloudSkyLight
} from '@welkin/clouds'
import type { CloudLayerParameters, CloudQuality, CloudsDebug, CloudsNode } from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import {
  BoxGeometry,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  Scene,
  Vector3
} from 'three'
import { pass, shadow, vec4 } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat, expectLight, random } from '../harness/atmosphere'
import type { GpuContext } from '../harness/context'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { countObjects, finishWork, nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'

const size = { width: 24, height: 14 }
const coarse: CloudQuality = {
  steps: 32,
  stepGrowth: 0.08,
  shortestStep: 40,
  layerSteps: 6,
  lightSteps: 1,
  block: 2
}

/** Noise of which no more than so many slices are drawn in a frame: smooth clouds need none. */
class SparseNoise extends CloudNoise {
  constructor(readonly slices = 0) {
    super()
  }

  override get isReady(): boolean {
    return this.slices === 0 || super.isReady
  }

  override update(renderer: WebGPURenderer): boolean {
    return this.slices > 0 ? super.update(renderer, this.slices) : true
  }
}

/** A layer without gaps or shapes: what light does in it is known. */
const fog: Partial<CloudLayerParameters> = {
  baseAltitude: 500,
  topAltitude: 2500,
  coverage: 1,
  density: 0.004,
  shapeAmount: 0,
  detailAmount: 0,
  profileExponent: 1,
  wind: { east: 0, north: 0 }
}

/** What the views of a test share. */
interface Shared {
  readonly noise: CloudNoise
  readonly light: CloudLightTable
}

/** A scene with air and clouds, seen by a camera. */
class View {
  readonly scene = new Scene()
  readonly camera = new PerspectiveCamera(60, size.width / size.height, 1, 1e6)
  readonly node: CloudsNode
  readonly #pipeline: RenderPipeline
  readonly #scenePass

  constructor(
    readonly renderer: WebGPURenderer,
    readonly atmosphere: Atmosphere,
    layers: CloudLayers,
    { noise, light }: Partial<Shared>,
    quality = coarse
  ) {
    const { camera, scene } = this
    this.#scenePass = pass(scene, camera, { samples: 0 })
    const depth = this.#scenePass.getTextureNode('depth')
    const air = aerialPerspective(this.#scenePass.getTextureNode(), depth, camera, atmosphere)
    this.node = clouds(air, depth, camera, atmosphere, layers, { quality, noise, light })
    this.node.time = 0
    this.#pipeline = new RenderPipeline(renderer)
    this.#pipeline.outputColorTransform = false
    this.#pipeline.outputNode = this.node
  }

  render(): void {
    this.camera.updateMatrixWorld()
    this.#pipeline.render()
  }

  /** Draws frames; the last is read back. */
  async draw(frames = 1): Promise<Picture> {
    for (let i = 1; i < frames; i++) {
      await nextFrame()
      this.render()
    }
    await nextFrame()
    return drawToFloat(this.renderer, () => this.render())
  }

  dispose(): void {
    this.node.dispose()
    this.#pipeline.dispose()
    this.#scenePass.dispose()
  }
}

/** At sea level, y up, under a sun 40° high. */
const onGround = (): Atmosphere => {
  const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 }).setSunAngles(40, 150)
  atmosphere.luminanceScale = 3e-5
  return atmosphere
}

/** A view from the middle of a fog, levelly. */
function viewInFog(renderer: WebGPURenderer, atmosphere: Atmosphere, shared: Shared): View {
  const view = new View(renderer, atmosphere, new CloudLayers([fog]), shared)
  view.camera.position.set(0, 1500, 0)
  return view
}

const meanOf = ({ data }: Picture): number => {
  let sum = 0
  for (let i = 0; i < data.length; i += 4) sum += data[i] + data[i + 1] + data[i + 2]
  return sum / (0.75 * data.length)
}

/** Mean difference between pictures, by the brightness of the first. */
const difference = (a: Picture, b: Picture): number =>
  a.data.reduce((sum, value, i) => sum + (i % 4 < 3 ? Math.abs(value - b.data[i]) : 0), 0) /
  (meanOf(a) * 0.75 * a.data.length)

const middle = (picture: Picture): number => {
  const [r, g, b] = picture.at(picture.width >> 1, picture.height >> 1)
  return (r + g + b) / 3
}

/** Pictures of random scenes. */
const ROUNDS = 15

const sizes = [
  [24, 14, 1],
  [1, 1, 1],
  [7, 3, 1],
  [7, 3, 2],
  [24, 14, 1]
] as const
const debugViews: (CloudsDebug | null)[] = ['density', 'steps', 'depth', 'history', null]

/** A layer of any kind, extremes more often than not. */
function randomLayer(next: () => number): Partial<CloudLayerParameters> {
  const extreme = (): number => [0, 1, next(), next()][Math.floor(4 * next())]
  const baseAltitude = next() < 0.3 ? 0 : 12_000 * next()
  const weights = [extreme(), extreme(), extreme(), extreme()] as const
  return {
    baseAltitude,
    topAltitude: baseAltitude + [0.01, 300, 12_000][Math.floor(3 * next())],
    coverage: extreme(),
    density: extreme() ** 3,
    profileExponent: [0.05, 1, 8][Math.floor(3 * next())],
    shapeAmount: extreme(),
    detailAmount: extreme(),
    weatherWeights: weights,
    wind: { east: 200 * (next() - 0.5), north: 200 * (next() - 0.5) },
    shadow: next() < 0.5
  }
}

gpuTest(
  'any camera, layers, size and debug view give finite light, and clouds where there are some',
  async t => {
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    const layers = new CloudLayers([fog, fog, fog, fog])
    const shared = { noise: new CloudNoise(), light: new CloudLightTable() }
    const view = new View(renderer, atmosphere, layers, shared)
    const { camera, node } = view
    const seed = 20_261_121
    const next = random(seed)
    let cloudy = 0
    for (let round = 0; round < ROUNDS; round++) {
      const [width, height, ratio] = sizes[round % sizes.length]
      renderer.setPixelRatio(ratio)
      renderer.setSize(width, height, false)
      camera.aspect = width / height
      const altitude = 10 ** (8 * next())
      const up = new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).normalize()
      camera.position.copy(up).multiplyScalar(Ellipsoid.WGS84.a + altitude)
      camera.up.set(next() - 0.5, next() - 0.5, next() - 0.5)
      camera.lookAt((next() - 0.5) * 1e7, (next() - 0.5) * 1e7, (next() - 0.5) * 1e7)
      camera.near = Math.max(altitude / 10, 0.5)
      camera.far = 1e9
      camera.updateProjectionMatrix()
      atmosphere.sunDirection = new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).normalize()
      for (const layer of layers) layer.set(randomLayer(next))
      const label = `seed ${seed}, round ${round}, ${altitude.toFixed(0)} m`
      node.time = 1000 * next()
      node.debugView = debugViews[Math.floor(round / 3) % debugViews.length]
      expectLight(await view.draw(), `${label}, ${node.debugView}`)
      node.debugView = 'density'
      const { data } = await view.draw()
      expectTrue(
        data.every(value => value >= 0 && value <= 1),
        `${label}: opacities beyond 0 and 1`
      )
      if (data.some((value, i) => i % 4 < 3 && value > 0.01)) cloudy++
      if (round % 4 > 0) continue
      for (const layer of layers) layer.set({ coverage: 0 })
      node.accumulates = false
      const clear = await view.draw()
      node.accumulates = true
      const most = Math.max(...clear.data.filter((_, i) => i % 4 < 3))
      expectTrue(most === 0, `${label}: without clouds the opacity is ${most}`)
    }
    t.note(`clouds in ${cloudy} of ${ROUNDS} pictures`)
    expectTrue(cloudy >= ROUNDS / 4, `clouds in only ${cloudy} of ${ROUNDS} pictures`)
    view.dispose()
    shared.noise.dispose()
    shared.light.dispose()
    atmosphere.dispose()
  },
  { timeoutSeconds: 120 }
)

async function inFog(
  t: GpuContext,
  body: (view: View, shared: Shared) => Promise<void>,
  options = {}
): Promise<void> {
  const renderer = await t.createRenderer({ ...size, ...options })
  const atmosphere = onGround()
  const shared = { noise: new SparseNoise(), light: new CloudLightTable() }
  const view = viewInFog(renderer, atmosphere, shared)
  await body(view, shared)
  view.dispose()
  shared.noise.dispose()
  shared.light.dispose()
  atmosphere.dispose()
}

/** A black wall across the view. */
function wall(distance: number, parameters: object = {}): Mesh<BoxGeometry, MeshBasicMaterial> {
  const material = new MeshBasicMaterial({ color: 0, ...parameters })
  const mesh = new Mesh(new BoxGeometry(2 * distance, 2 * distance, distance / 100), material)
  mesh.position.set(0, 1500, -distance)
  return mesh
}

for (const depth of ['standard', 'reversed', 'logarithmic'] as const) {
  gpuTest(
    `in a cloud what is near hides it, and what is far is hidden by it: ${depth} depth`,
    t =>
      inFog(
        t,
        async view => {
          view.node.quality = { ...coarse, block: 1 }
          const light: number[] = []
          const distances = [20, 100, 400, 6000]
          for (const distance of distances) {
            const black = wall(distance)
            view.scene.add(black)
            const picture = await view.draw(3)
            expectLight(picture, `a wall at ${distance} m`)
            light.push(middle(picture))
            view.scene.remove(black)
            black.geometry.dispose()
            black.material.dispose()
          }
          const open = middle(await view.draw(3))
          const parts = light.map(value => value / open)
          t.note(`light before a wall ${parts.map(part => part.toFixed(3)).join(', ')}`)
          const [near, close, far, farthest] = parts
          // Even fog, of mean extinction 0.004/m, lets e^{−0.004 d} through at the least.
          expectTrue(near > 0 && near < 0.1, `fog before a wall at 20 m has ${near} of all light`)
          expectTrue(close > 2 * near && close < 0.4, `at 100 m it has ${close}`)
          expectTrue(far > 1.5 * close && far < 0.95, `at 400 m it has ${far}`)
          expectTrue(Math.abs(farthest - 1) < 0.05, `at 6 km it has ${farthest}`)
        },
        {
          reversedDepthBuffer: depth === 'reversed',
          logarithmicDepthBuffer: depth === 'logarithmic'
        }
      ),
    { timeoutSeconds: 60 }
  )
}

gpuTest('transparent things are where their depth is, or else that of what is behind them', t =>
  inFog(t, async view => {
    view.node.quality = { ...coarse, block: 1 }
    const open = middle(await view.draw(2))
    const seen: number[] = []
    for (const depthWrite of [true, false]) {
      const glass = wall(20, { transparent: true, opacity: 0.9, depthWrite })
      view.scene.add(glass)
      seen.push(middle(await view.draw(2)) / open)
      view.scene.remove(glass)
      glass.geometry.dispose()
      glass.material.dispose()
    }
    const [written, unwritten] = seen
    t.note(
      `light before black glass at 20 m: ${written.toFixed(3)}, without depth ${unwritten.toFixed(3)}`
    )
    expectTrue(written < 0.2, `glass that writes depth shows ${written} of the fog's light`)
    expectTrue(Math.abs(unwritten - 1) < 0.05, `glass that writes none shows ${unwritten}`)
  })
)

gpuTest('transparent things are over the clouds in a pass of their own', t =>
  inFog(t, async view => {
    const { renderer, scene, camera, atmosphere } = view
    const open = middle(await view.draw(2))
    const opaque = pass(scene, camera, { samples: 0 })
    opaque.transparent = false
    const depth = opaque.getTextureNode('depth')
    const air = aerialPerspective(opaque.getTextureNode(), depth, camera, atmosphere)
    const { field, light } = view.node
    const { noise } = field
    const quality = { ...coarse, block: 1 }
    const node = clouds(air, depth, camera, atmosphere, field.layers, { quality, noise, light })
    const depthTexture = opaque.renderTarget.depthTexture!
    const panes = pass(scene, camera, { samples: 0, depthTexture, autoClearDepth: false })
    panes.opaque = false
    const over = panes.getTextureNode()
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = vec4(node.rgb.mul(over.a.oneMinus()).add(over.rgb), 1)
    const draw = async (): Promise<number> => {
      let value = 0
      for (let i = 0; i < 2; i++) {
        await nextFrame()
        value = middle(await drawToFloat(renderer, () => pipeline.render())) / open
      }
      return value
    }
    const seen: number[] = []
    for (const depthWrite of [true, false]) {
      const glass = wall(20, { transparent: true, opacity: 0.75, depthWrite })
      scene.add(glass)
      seen.push(await draw())
      const before = wall(10)
      glass.material.color.setScalar(100)
      scene.add(before)
      seen.push(await draw())
      for (const mesh of [glass, before]) {
        scene.remove(mesh)
        mesh.geometry.dispose()
        mesh.material.dispose()
      }
    }
    t.note(`light before glass and a wall: ${seen.map(value => value.toFixed(3)).join(', ')}`)
    for (const i of [0, 2]) {
      expectTrue(Math.abs(seen[i] - 0.25) < 0.02, `glass shows ${seen[i]} of the clouds`)
      expectTrue(seen[i + 1] < 0.1, `before bright glass a black wall has ${seen[i + 1]}`)
    }
    pipeline.dispose()
    panes.dispose()
    node.dispose()
    opaque.dispose()
  })
)

gpuTest('a scene is lit again when its clouds are disposed of, and shaded by the next ones', t =>
  inFog(t, async (first, shared) => {
    const { renderer, scene, camera, atmosphere } = first
    renderer.shadowMap.enabled = true
    const sun = new SunDirectionalLight(atmosphere)
    const sky = new SkyLightProbe(atmosphere)
    const board = new Mesh(new BoxGeometry(400, 1, 400), new MeshLambertMaterial())
    board.position.set(0, 1480, -200)
    board.receiveShadow = true
    scene.add(board, sun, sky)
    const draw = async (): Promise<number> => {
      await nextFrame()
      const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
      return Math.max(picture.at(12, 2)[1], picture.at(12, 11)[1])
    }
    const open = await draw()
    const shade = async (view: View): Promise<number> => {
      Object.assign(sun.shadow, { shadowNode: cloudShadow(view.node, shadow(sun)) })
      cloudSkyLight(sky, view.node)
      sun.castShadow = true
      sun.dispose()
      await view.draw(2)
      return draw()
    }
    const shaded = await shade(first)
    // What a node makes for itself goes with it.
    first.dispose()
    shared.noise.dispose()
    const light = [await draw(), await draw()]
    const second = viewInFog(renderer, atmosphere, shared)
    const again = await shade(second)
    t.note([open, shaded, ...light, again].map(value => value.toFixed(4)).join(', '))
    expectTrue(shaded < 0.9 * open, `in shadow the ground has ${shaded}, else ${open}`)
    for (const value of light) expectClose([value], [open], { relative: 1e-3 }, 'without clouds')
    expectClose([again], [shaded], { relative: 0.02 }, 'with others')
    second.dispose()
  })
)

/** In which a picture of blocks of four pixels is whole, twice. */
const FRAMES = 8

gpuTest('two cameras with a node each in a frame see what each sees alone; so after a resize', t =>
  inFog(t, async (first, shared) => {
    const { renderer, atmosphere } = first
    const second = viewInFog(renderer, atmosphere, shared)
    second.camera.position.set(300, 8000, 0)
    second.camera.rotation.x = -0.7
    const alone = [await first.draw(FRAMES), await second.draw(FRAMES)]
    for (const view of [first, second]) view.node.accumulates = false
    await first.draw()
    await second.draw()
    for (const view of [first, second]) view.node.accumulates = true
    const views = [first, second]
    renderer.setSize(10, 22, false)
    for (const view of views) await view.draw()
    renderer.setSize(size.width, size.height, false)
    let together: Picture[] = []
    for (let i = 0; i < FRAMES; i++) {
      await nextFrame()
      together = []
      for (const view of views) {
        together.push(await drawToFloat(renderer, () => view.render()))
      }
    }
    const apart = alone.map((picture, i) => difference(picture, together[i]))
    const between = difference(alone[0], alone[1])
    t.note(
      `apart by ${apart.map(value => value.toFixed(4)).join(', ')}; views ${between.toFixed(2)}`
    )
    expectTrue(between > 0.1, `the two views differ by only ${between}`)
    for (const value of apart) expectTrue(value < 0.02, `pictures are apart by ${value}`)
    second.dispose()
  })
)

gpuTest('leaves no memory behind', async t => {
  const renderer = await t.createRenderer(size)
  const objects = countObjects(renderer)
  const atmosphere = onGround()
  const light = new CloudLightTable()
  const round = async (): Promise<string> => {
    // A leak does not need the whole bake.
    const noise = new SparseNoise(1)
    const view = new View(renderer, atmosphere, new CloudLayers([fog]), { noise, light })
    await view.draw(2)
    renderer.setSize(12, 7, false)
    view.node.quality = 'ultra'
    await view.draw()
    renderer.setSize(size.width, size.height, false)
    view.dispose()
    noise.dispose()
    await finishWork(renderer)
    return `${JSON.stringify(renderer.info.memory)}, objects ${JSON.stringify(objects)}`
  }
  await round()
  const before = await round()
  for (let i = 0; i < 2; i++) {
    const after = await round()
    expectTrue(after === before, `before ${before}\nafter round ${i} ${after}`)
  }
  light.dispose()
  atmosphere.dispose()
})
