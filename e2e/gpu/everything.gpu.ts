import { aerialPerspectiveFog, skyBackground } from '@welkin/atmosphere'
import { Vector3 } from 'three'
import { RenderPipeline } from 'three/webgpu'
import { recipes } from 'virtual:recipes'
import { drawForward, drawToFloat, expectLight } from './harness/atmosphere'
import type { GpuContext } from './harness/context'
import { luminance } from './harness/environment'
import { LIT, World, worldSize as size } from './harness/everything'
import { expectTrue } from './harness/expect'
import { gpuTest } from './harness/gpu-test'
import { nextFrame } from './harness/graphics'
import { expectLit } from './harness/lit-picture'
import type { Picture } from './harness/picture'
import { watchShaders, type Shader } from './harness/shaders'

/** Textures that a stage may sample on WebGPU's default limits and on WebGL2. */
const LIMIT = 16

/** Textures that a material with all of it, and ambient occlusion, has left: the README says so. */
const LEFT = 2

/** Fails if a shader of any stage samples more textures than may be; says which sample the most. */
function checkTextures(t: GpuContext, shaders: readonly Shader[]): void {
  const counted = shaders.map(({ stage, name, textures, lines }) => ({
    label: `${name || 'unnamed'}: ${textures} textures, ${lines} lines`,
    stage,
    textures
  }))
  for (const stage of ['fragment', 'vertex', 'compute']) {
    const own = counted.filter(each => each.stage === stage)
    const most = own.toSorted((a, b) => b.textures - a.textures).slice(0, 4)
    t.note(`${stage}, most textures: ${most.map(({ label }) => label).join('; ')}`)
  }
  const over = counted.filter(({ textures }) => textures > LIMIT)
  expectTrue(over.length === 0, `too many: ${over.map(({ label }) => label).join('; ')}`)
}

const situations = [
  { name: 'by day on the ground', sun: 35, moon: 20, altitude: 2 },
  { name: 'at night on the ground', sun: -30, moon: 40, altitude: 2 },
  { name: 'in an eclipse on the ground', sun: 35, moon: null, altitude: 2 },
  { name: 'by day in orbit', sun: 35, moon: 20, altitude: 400_000 }
] as const

/** Median luminance of what has light in a picture that was exposed by the one before: a stop or two about grey by day, moonlit nights a tenth of that. */
const EXPOSED = [0.17 / 10 / 8, 0.17 * 8] as const

/** Mean luminance of all of a picture. */
function meanOf(drawn: Picture): number {
  let sum = 0
  for (let i = 0; i < drawn.data.length; i += 4)
    sum += luminance([...drawn.data.subarray(i, i + 3)])
  return (4 * sum) / drawn.data.length
}

gpuTest(
  'all that there is draws light at once, under GTAO, TRAA and bloom, and no stage samples more than 16 textures',
  async t => {
    const renderer = await t.createRenderer(size)
    const shaders = watchShaders(renderer)
    const world = new World(renderer, true)
    await world.prepare()
    for (const { name, sun, moon: moonAt, altitude } of situations) {
      world.setLights(sun, moonAt)
      world.look(altitude)
      world.expose()
      const isLit = altitude > 1e5 ? world.isAir : () => true
      // History begins anew: a picture that changes at once is coarse.
      expectLight(await world.draw(), `${name}, first`)
      await world.exposure.settle()
      const { luminance: metered } = world.exposure
      expectTrue(metered !== null && metered > 0, `${name}: ${metered} cd/m² are metered`)
      const drawn = await world.draw()
      const after = expectLit(drawn, isLit, name)
      const before = expectLit(await world.beforeEffects(), isLit, `${name}, before the effects`)
      const figures = [after, before].map(
        ({ median, least }) => `${median.toPrecision(2)} (${least.toPrecision(2)})`
      )
      t.note(`${name}: ${figures.join(', before ')}`)
      const isExposed = after.median > EXPOSED[0] && after.median < EXPOSED[1]
      expectTrue(isExposed, `${name}: the median is ${after.median}`)
      if (sun > -20 || altitude > 1e5) continue
      // A flash begins in a frame, and has light from the next on.
      world.storm.addEventListener('strike', () => (world.storm.time = 0.5))
      world.storm.strike({ kind: 'ground', at: new Vector3(0, 0, -3000) })
      await world.draw()
      const lit = await world.draw()
      expectLit(lit, isLit, `${name}, in a flash`)
      const brighter = meanOf(lit) / meanOf(drawn)
      t.note(`a flash makes it ${brighter.toPrecision(3)} times as bright`)
      expectTrue(brighter > 2, `${name}, a flash makes it ${brighter} times as bright`)
      world.storm.time = 10
    }
    checkTextures(t, shaders)
    world.dispose()
  },
  // The material with six maps has most of it on WebGL, and each feature a test or a picture of its own.
  { timeoutSeconds: 900, backends: ['webgpu'] }
)

gpuTest(
  "a material with six maps takes environment, four cascades, shadows of moon and clouds, probes, light shafts and the README's ambient occlusion at once, wet and in its own haze",
  async t => {
    const renderer = await t.createRenderer(size)
    const shaders = watchShaders(renderer)
    const world = new World(renderer, false)
    const texturesOf = (from: number): number =>
      Math.max(...shaders.slice(from).flatMap(each => (each.name === LIT ? each.textures : [])))
    const { scene, camera, atmosphere, shafts } = world
    await world.prepare()
    const everywhere = (): boolean => true
    // The last is by day on the ground, as is what follows.
    for (const { name, sun, moon, altitude } of situations.toReversed()) {
      world.setLights(sun, moon)
      world.look(altitude)
      world.expose()
      const isLit = altitude > 1e5 ? world.isAir : everywhere
      const { median } = expectLit(await world.draw(), isLit, `six maps, ${name}`)
      t.note(`${name}: ${median.toPrecision(2)}`)
    }
    world.look(20)
    // As a `skyBackground` and in the haze of the material, with shafts.
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
    atmosphere.add(shafts)
    const compiled = shaders.length
    await nextFrame()
    const draw = () => drawForward(renderer, scene, camera, atmosphere)
    expectLight(await draw(), 'shafts that begin')
    await nextFrame()
    const plain = await draw()
    expectLit(plain, everywhere, 'in its own haze')
    const textures = texturesOf(compiled)
    const { backgroundNode, fogNode } = scene
    const { scenePass, pipeline } = recipes[0]({ renderer, scene, camera, atmosphere })
    // The recipe has air as a post effect; this scene draws its own, in the pass before the occlusion, too.
    Object.assign(scene, { backgroundNode, fogNode })
    const occluded = new RenderPipeline(renderer)
    occluded.outputColorTransform = false
    occluded.outputNode = scenePass
    const before = shaders.length
    for (let i = 0; i < 2; i++) {
      await nextFrame()
      const drawn = await drawToFloat(renderer, () => occluded.render())
      expectLit(drawn, everywhere, 'with ambient occlusion')
    }
    const withOcclusion = texturesOf(before)
    t.note(`lit: ${textures} textures, ${withOcclusion} with ambient occlusion`)
    expectTrue(withOcclusion === textures + 1, `GTAO takes ${withOcclusion - textures} textures`)
    // Fewer would be a material that lacks one of them.
    expectTrue(withOcclusion === LIMIT - LEFT, `${LIMIT - withOcclusion} textures are left`)
    checkTextures(t, shaders)
    for (const each of [occluded, pipeline, scenePass]) each.dispose()
    world.dispose()
  },
  // WebGPU has the same lights, shadows and layers in the scene above, and unit tests count what six maps take there.
  { timeoutSeconds: 900, backends: ['webgl'] }
)
