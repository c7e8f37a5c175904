import {
  aerialPerspectiveFog,
  Atmosphere,
  distanceFog,
  heightFog,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight,
  type Spectrum
} from '@welkin/atmosphere'
import {
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry
} from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { drawForward, drawToFloat, postPath, relativeDifferences } from '../harness/atmosphere'
import type { GpuContext } from '../harness/context'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { countCompilations, countObjects, finishWork, nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { keepTables, reuseTables } from '../harness/reuse-tables'

const all = (value: number): Spectrum => [value, value, value, value]
const small = { width: 64, height: 36 }

/** A ball in the haze, lit by sun and sky: everything that an atmosphere offers at once. */
class View {
  readonly atmosphere = new Atmosphere().setSunAngles(35, 120)
  readonly camera = new PerspectiveCamera(60, small.width / small.height, 1, 1e6)
  readonly #ball = new Mesh(new SphereGeometry(2500, 32, 16), new MeshLambertMaterial())
  readonly #sun = new SunDirectionalLight(this.atmosphere)
  readonly #sky = new SkyLightProbe(this.atmosphere)
  readonly #background = skyBackground(this.atmosphere)
  readonly #fog = aerialPerspectiveFog(this.atmosphere)
  readonly #scene = new Scene()
  readonly #forward = new Scene()
  readonly #post

  constructor(readonly renderer: WebGPURenderer) {
    this.camera.position.y = 100
    this.#ball.position.set(2000, 1000, -9000)
    this.#scene.add(this.#ball, this.#sun, this.#sky)
    this.#post = postPath(renderer, this.#scene, this.camera, this.atmosphere)
    this.#forward.backgroundNode = this.#background
    this.#forward.fogNode = this.#fog
  }

  render(path: 'forward' | 'post'): void {
    if (path === 'post') this.#post.render()
    else {
      this.#forward.add(...this.#scene.children)
      this.renderer.render(this.#forward, this.camera)
      this.#scene.add(...this.#forward.children)
    }
  }

  dispose(): void {
    this.#post.dispose()
    const { geometry, material } = this.#ball
    const owned = [geometry, material, this.#sun, this.#sky, this.#background, this.#fog]
    for (const part of owned) part.dispose()
    this.atmosphere.dispose()
  }
}

const paths = ['forward', 'post'] as const

/** Pictures of the canvas as a viewer sees it, by each path. */
async function shoot(t: GpuContext, view: View): Promise<Picture[]> {
  const pictures: Picture[] = []
  for (const path of paths) {
    await nextFrame()
    pictures.push(await t.capture(view.renderer, () => view.render(path)))
  }
  return pictures
}

function expectSame(actual: Picture[], expected: Picture[], label: string): void {
  expected.forEach(({ width, height, data }, i) => {
    const [picture, path] = [actual[i], paths[i]]
    const size = `${picture.width}×${picture.height}`
    expectTrue(size === `${width}×${height}`, `${path} ${label}: ${size}, not ${width}×${height}`)
    const changes = data.map((value, k) => Math.abs(picture.data[k] - value))
    const changed = changes.filter(change => change > 0).length
    const most = Math.max(...changes)
    expectTrue(changed === 0, `${path} ${label}: ${changed} numbers changed, by up to ${most}`)
    const [dark, bright] = [Math.min(...data), Math.max(...data)]
    expectTrue(bright - dark > 0.2, `${path}: the picture is flat, from ${dark} to ${bright}`)
  })
}

gpuTest(
  're-bakes for new parameters, at once or step by step, and compiles nothing',
  async t => {
    const renderer = await t.createRenderer(small)
    const counts = countCompilations(renderer)
    const compiled = (): number => Object.values(counts).reduce((sum, count) => sum + count, 0)
    const view = new View(renderer)
    const { atmosphere } = view
    const { parameters, tables } = atmosphere
    // Air of this test alone: the tables that it keeps are those that it takes.
    const rayleighScaleHeight = 8123
    parameters.set({ rayleighScaleHeight })
    const draw = (): Promise<Picture> => drawToFloat(renderer, () => view.render('forward'))
    const read = async (of: Atmosphere): Promise<number[]> => {
      await of.tables.read()
      const depths = await of.tables.transmittance.region.read(renderer)
      return [...of.tables.data!.values, ...depths]
    }
    const before = await draw()
    const values = await read(atmosphere)
    expectTrue(
      values.some(value => value > 0),
      'the tables are empty'
    )
    const first = compiled()
    expectTrue(first > 0, 'the first picture compiled nothing')
    const { mieScattering, mieExtinction, absorptionExtinction, groundAlbedo } = parameters
    parameters.set({
      mieScattering: all(3e-5),
      mieExtinction: all(3.3e-5),
      absorptionExtinction: all(0),
      groundAlbedo: all(0.6)
    })
    const difference = relativeDifferences(before, await draw()).at(-1)!
    t.note(`other aerosols, ozone and ground change ${(100 * difference).toFixed(0)} %`)
    expectTrue(difference > 0.02, `they change no pixel by more than ${difference}`)
    const changed = await read(atmosphere)
    const equal = values.filter((value, i) => value > 0 && value === changed[i]).length
    t.note(`${equal} of ${values.length} texels' numbers are as before`)
    expectTrue(equal < 0.1 * values.length, `${equal} numbers of tables are as before`)

    const expectSameTables = (actual: readonly number[], how: string): void => {
      const differs = values.some((value, i) => value !== actual[i])
      expectTrue(!differs, `tables ${how} differ`)
    }
    /** Bakes a step a frame, until the tables are there. */
    const bakeSteps = (of: Atmosphere): void => {
      const { version } = of.tables
      of.bakeStepsPerFrame = 1
      let frames = 0
      for (; of.tables.version === version && frames < 40; frames++)
        of.update(renderer, view.camera)
      expectTrue(frames > 10, `it took ${frames} frames`)
    }
    const { version } = tables
    parameters.set({ mieScattering, mieExtinction, absorptionExtinction, groundAlbedo })
    // Keeps what it bakes now, and takes nothing.
    reuseTables(true, false)
    bakeSteps(atmosphere)
    expectTrue(tables.version > version, 'no new tables')
    expectSameTables(await read(atmosphere), 'step by step')
    const again = relativeDifferences(before, await draw()).at(-1)!
    expectTrue(again === 0, `with the first parameters again, a pixel differs by ${again}`)
    t.note(`${first} compiled at first`)
    expectTrue(compiled() === first, `compiled ${JSON.stringify(counts)}, of which first ${first}`)
    await keepTables()
    reuseTables(true)
    const other = new Atmosphere()
    other.parameters.set({ rayleighScaleHeight })
    bakeSteps(other)
    expectSameTables(await read(other), 'that were kept')
    other.dispose()
    view.dispose()
  },
  // What is compiled anew is decided without a backend.
  { backends: ['webgpu'], bakes: true }
)

gpuTest(
  'shows and hides layers that come and go between frames',
  async t => {
    const renderer = await t.createRenderer(small)
    const counts = countCompilations(renderer)
    const compiled = (): number => Object.values(counts).reduce((sum, count) => sum + count, 0)
    const atmosphere = new Atmosphere().setSunAngles(35, 120)
    const camera = new PerspectiveCamera(60, small.width / small.height, 1, 1e6)
    camera.position.y = 100
    const ball = new Mesh(new SphereGeometry(2500, 32, 16), new MeshBasicMaterial())
    ball.position.set(2000, 1000, -9000)
    const bare = new Scene().add(ball)
    const post = postPath(renderer, bare, camera, atmosphere)
    const scene = new Scene()
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
    const nodes = [scene.backgroundNode, scene.fogNode]

    const forward = async (of: Scene): Promise<Picture> => {
      of.add(ball)
      const picture = await drawForward(renderer, of, camera, atmosphere)
      bare.add(ball)
      return picture
    }
    /** Both paths, after a change, in one frame each; the next frame compiles nothing. */
    const draw = async (): Promise<Picture[]> => {
      const first = await forward(scene)
      post.refresh()
      const pictures = [first, await post.draw()]
      const before = compiled()
      expectTrue(
        (await forward(scene)).data.every((v, i) => v === first.data[i]),
        'the next frame'
      )
      await post.draw()
      expectTrue(compiled() === before, `compiled ${compiled() - before} more in the next frame`)
      return pictures
    }
    const most = (a: Picture, b: Picture): number => relativeDifferences(a, b).at(-1)!
    const clear = await draw()
    const mist = heightFog({ base: 0, falloff: 300, density: 2e-4 })
    const murk = distanceFog({ density: 1e-4 })
    let last = clear
    for (const [label, change] of [
      ['height fog', () => atmosphere.add(mist)],
      ['distance fog in its place', () => atmosphere.remove(mist).add(murk)],
      ['both', () => atmosphere.add(mist)]
    ] as const) {
      change()
      const pictures = await draw()
      // What has never been rendered before knows nothing of earlier layers.
      const fresh = await forward(new Scene())
      paths.forEach((path, i) => {
        const difference = most(pictures[i], last[i])
        expectTrue(difference > 0.02, `${label} changes ${path} by ${difference}`)
      })
      expectTrue(
        most(pictures[0], fresh) < 1e-6,
        `${label}: ${most(pictures[0], fresh)} from fresh`
      )
      last = pictures
    }
    atmosphere.remove(mist, murk)
    const again = await draw()
    paths.forEach((path, i) => {
      expectTrue(
        most(again[i], clear[i]) === 0,
        `${path} without layers: ${most(again[i], clear[i])}`
      )
    })
    post.dispose()
    for (const part of [ball.geometry, ball.material, ...nodes]) part.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'leaves no memory behind, round after round',
  async t => {
    const renderer = await t.createRenderer(small)
    const objects = countObjects(renderer)
    const round = async (): Promise<string> => {
      const view = new View(renderer)
      // A leak does not need the whole bake.
      view.atmosphere.bakeStepsPerFrame = 1
      await nextFrame()
      for (const path of paths) view.render(path)
      view.dispose()
      await finishWork(renderer)
      return `${JSON.stringify(renderer.info.memory)}, objects ${JSON.stringify(objects)}`
    }
    const before = await round()
    t.note(`objects ${JSON.stringify(objects)}`)
    const after = await round()
    expectTrue(after === before, `before ${before}\nafter a round ${after}`)
  },
  { bakes: true }
)

gpuTest('draws every pixel ratio alike', async t => {
  const renderer = await t.createRenderer(small)
  const view = new View(renderer)
  const first = await shoot(t, view)
  const set = (ratio: number, width: number, height: number): Promise<Picture[]> => {
    renderer.setPixelRatio(ratio)
    renderer.setSize(width, height)
    return shoot(t, view)
  }
  expectSame(await set(2, 32, 18), first, 'with two pixels per unit')
  const fine = await set(1.5, 64, 36)
  expectSame(await set(1, 96, 54), fine, 'with one pixel per unit')
  expectSame(await set(1, 64, 36), first, 'back at the first ratio')
  view.dispose()
})

gpuTest('follows the size of the canvas', async t => {
  const renderer = await t.createRenderer(small)
  const view = new View(renderer)
  const first = await shoot(t, view)
  const resize = (width: number, height: number): void => {
    renderer.setSize(width, height)
    view.camera.aspect = width / height
    view.camera.updateProjectionMatrix()
  }
  resize(40, 50)
  const tall = await shoot(t, view)
  const fresh = new View(renderer)
  fresh.camera.aspect = 40 / 50
  fresh.camera.updateProjectionMatrix()
  expectSame(tall, await shoot(t, fresh), 'after a change of size')
  fresh.dispose()
  resize(small.width, small.height)
  expectSame(await shoot(t, view), first, 'back at the first size')
  view.dispose()
})

gpuTest('outlives a canvas of no size', async t => {
  if (t.backend === 'webgpu') {
    // three's own, of any scene on such a canvas. Textures of the atmosphere have other names.
    t.allowConsole(/texture size \(\[Extent3D width:0, height:0, .* is empty/)
    t.allowConsole(/Could not create a swapchain texture of size 0/)
    t.allowConsole(/\[Invalid Texture(View)?( "depthBuffer")?\] is invalid due to a previous error/)
    t.allowConsole(/\[Invalid CommandBuffer from CommandEncoder "renderContext_\d+"\] is invalid/)
  }
  const renderer = await t.createRenderer(small)
  const view = new View(renderer)
  const first = await shoot(t, view)
  renderer.setSize(0, 0)
  // As many a page computes it.
  view.camera.aspect = renderer.domElement.width / renderer.domElement.height
  view.camera.updateProjectionMatrix()
  await nextFrame()
  for (const path of paths) view.render(path)
  await finishWork(renderer)
  renderer.setSize(small.width, small.height)
  view.camera.aspect = small.width / small.height
  view.camera.updateProjectionMatrix()
  expectSame(await shoot(t, view), first, 'after a canvas of no size')
  view.dispose()
})
