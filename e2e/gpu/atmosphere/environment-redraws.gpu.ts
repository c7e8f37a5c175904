import { Atmosphere, heightFog, skyEnvironment, SunDirectionalLight } from '@welkin/atmosphere'
import type { SkyEnvironmentNode } from '@welkin/atmosphere'
import { BackSide, BoxGeometry, CubeCamera, HalfFloatType, Mesh, Scene, Vector3 } from 'three'
import type { Camera } from 'three'
import { pmremTexture, positionWorldDirection, uniform, vec3, vec4 } from 'three/tsl'
import { CubeRenderTarget, NodeMaterial, PMREMGenerator } from 'three/webgpu'
import type { Node, WebGPURenderer } from 'three/webgpu'
import { PrefilteredCube } from '../../../packages/atmosphere/src/environment/PrefilteredCube'
import { random } from '../harness/atmosphere'
import { ballScene, draw, luminance } from '../harness/environment'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { filterLeast } from '../harness/filter-samples'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const size = { width: 32, height: 32 }
/** Options of these tests: when what is drawn again, and with which light, is decided without a backend. */
const once = { backends: ['webgpu'] } as const
/** Frames that a redraw of the default size takes: 6 faces, 9 parts of the filter. */
const FRAMES = 15

/**
 * Draws until the environment rests.
 *
 * @returns Number of frames that it took.
 */
function settle(
  renderer: WebGPURenderer,
  scene: Scene,
  camera: Camera,
  environment: SkyEnvironmentNode
): number {
  const before = environment.redraws
  let frames = 0
  do renderer.render(scene, camera)
  while (++frames < 20 && environment.redraws === before)
  return frames
}

gpuTest(
  'is drawn again when sun or height change, a step a frame, in the same memory',
  async t => {
    filterLeast()
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere().setSunAngles(20, 100)
    const { scene, camera } = ballScene(0.3, 1)
    scene.add(new SunDirectionalLight(atmosphere))
    const environment = skyEnvironment(atmosphere, { angle: 0.2, climb: 0.1 })
    scene.environmentNode = environment
    const rest = (): Promise<Picture> => draw(renderer, scene, camera)
    await rest()
    expectTrue(environment.redraws === 1, `${environment.redraws} after the first frame`)
    for (let i = 0; i < 10; i++) renderer.render(scene, camera)
    expectTrue(environment.redraws === 1, 'nothing moves, nothing is drawn')
    const memory = JSON.stringify(renderer.info.memory)

    atmosphere.setSunAngles(20.1, 100)
    for (let i = 0; i < 10; i++) renderer.render(scene, camera)
    expectTrue(environment.redraws === 1, 'a tenth of a degree is too little')
    atmosphere.setSunAngles(20.3, 100)
    let frames = settle(renderer, scene, camera, environment)
    expectTrue(frames === FRAMES, `drawn in ${frames} frames`)
    const [ball] = scene.children
    camera.position.y = ball.position.y = 40
    for (let i = 0; i < 10; i++) renderer.render(scene, camera)
    expectTrue(environment.redraws === 2, 'forty metres up the sky is the same')
    camera.position.y = ball.position.y = 80
    frames = settle(renderer, scene, camera, environment)
    expectTrue(frames === FRAMES, `after a climb drawn in ${frames} frames`)
    await rest()
    expectTrue(environment.redraws === 3, `${environment.redraws} redraws`)
    const after = JSON.stringify(renderer.info.memory)
    expectTrue(after === memory, `memory was ${memory}, is ${after}`)

    const { textures } = renderer.info.memory
    environment.dispose()
    const freed = textures - renderer.info.memory.textures
    expectTrue(freed >= 3, `dispose freed ${freed} textures`)
    atmosphere.dispose()
  },
  once
)

gpuTest(
  'follows a moving sun alone in a scene, in the luminance scale of now, whatever it was when a face was drawn',
  async t => {
    filterLeast()
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere().setSunAngles(20, 100)
    const { scene, camera } = ballScene(0.1, 1)
    const environment = skyEnvironment(atmosphere)
    scene.environmentNode = environment
    const { luminanceScale } = atmosphere
    const before = (await draw(renderer, scene, camera)).data
    const timesBefore = (): number[] =>
      Array.from(before, (value, i) =>
        i % 4 === 3 ? value : (value * atmosphere.luminanceScale) / luminanceScale
      )
    atmosphere.luminanceScale = 100 * luminanceScale
    const brighter = (await draw(renderer, scene, camera)).data
    expectTrue(Math.max(...before) > 0.1, 'the ball is dark')
    expectClose(brighter, timesBefore(), { relative: 1e-3 }, 'a hundred times as bright')
    expectTrue(environment.redraws === 1, `drawn ${environment.redraws} times`)

    atmosphere.setSunAngles(40, 100)
    atmosphere.luminanceScale = luminanceScale / 10
    for (let frame = 1; frame < FRAMES; frame++) {
      renderer.render(scene, camera)
      atmosphere.luminanceScale *= 1.3
      // A redraw has the sun of its start, and does not start again.
      atmosphere.setSunAngles(40 + 0.5 * frame, 100)
    }
    atmosphere.setSunAngles(40, 100)
    atmosphere.luminanceScale = luminanceScale
    const inSteps = (await draw(renderer, scene, camera)).data
    expectTrue(environment.redraws === 2, `drawn ${environment.redraws} times`)
    environment.needsRedraw = true
    const atOnce = (await draw(renderer, scene, camera)).data
    expectTrue(environment.redraws === 3, `drawn ${environment.redraws} times`)
    expectClose(inSteps, atOnce, { relative: 5e-3 }, 'faces drawn at other scales')
    environment.dispose()
    atmosphere.dispose()
  },
  once
)

gpuTest(
  'is drawn again when layers change',
  async t => {
    filterLeast()
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere().setSunAngles(40, 100)
    const { scene, camera } = ballScene(0.3, 1)
    const environment = skyEnvironment(atmosphere)
    scene.environmentNode = environment
    const ground = async (): Promise<number> =>
      luminance((await draw(renderer, scene, camera)).at(16, 27))
    // In the middle of the fog.
    camera.position.y = scene.children[0].position.y = 20
    const bare = await ground()
    const fog = heightFog({ density: 0.1 })
    atmosphere.add(fog)
    expectTrue(settle(renderer, scene, camera, environment) === FRAMES, 'fog comes')
    const white = await ground()
    fog.set({ density: 0, albedo: [1, 1, 1, 1] })
    expectTrue(settle(renderer, scene, camera, environment) === FRAMES, 'fog goes')
    const cleared = await ground()
    expectTrue(white > 1.2 * bare, `in fog ${white}, else ${bare}`)
    expectClose(cleared, bare, { relative: 1e-3 }, 'without fog')
    for (let frame = 0; frame < 3; frame++) {
      fog.set({ density: 0, albedo: [1, 1, 1, 1] })
      renderer.render(scene, camera)
    }
    // Any step of a redraw would be followed by the rest.
    for (let frame = 0; frame < FRAMES; frame++) renderer.render(scene, camera)
    expectTrue(environment.redraws === 3, 'drawn though nothing has changed')
    environment.dispose()
    atmosphere.dispose()
  },
  once
)

gpuTest(
  'filters a part at a time what three filters at once, unseen until it is complete',
  async t => {
    filterLeast()
    const renderer = await t.createRenderer(size)
    const cube = new CubeRenderTarget(256, { type: HalfFloatType, depthBuffer: false })
    const box = new Mesh(new BoxGeometry(5, 5, 5), new NodeMaterial())
    box.material.side = BackSide
    // As steep as a sky with a small bright cloud.
    const towards = positionWorldDirection.dot(vec3(0.3, 0.9, 0.3).normalize()).max(0)
    const tone = uniform(new Vector3(0.2, 0.5, 0.9))
    box.material.fragmentNode = vec4(tone.mul(towards.pow(200).mul(50).add(0.3)), 1)
    const drawCube = (): void => new CubeCamera(1, 10, cube).update(renderer, new Scene().add(box))
    drawCube()
    const expected = new PMREMGenerator(renderer).fromCubemap(cube.texture)
    const filtered = new PrefilteredCube(cube.texture)
    // Each counts its own parts.
    let parts = 1
    while (!filtered.filterNext(renderer)) parts++
    expectTrue(parts === FRAMES - 6, `filtered in ${parts} parts`)

    const next = random(5)
    const rays = Array.from({ length: 256 }, (_, i) => {
      const direction = new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).normalize()
      return [...direction.toArray(), (i % 16) / 15].map(Math.fround)
    })
    const look = (map: Node): Promise<Float32Array> =>
      evaluateOnGpu(renderer, rays, ray => {
        // Not a texture any more, of which the context would ask the level.
        const { xyz, w } = ray.toVar()
        return (map as Node<'vec3'>).context({ getUV: () => xyz, getTextureLevel: () => w })
      })
    const whole = await look(pmremTexture(expected.texture))
    const inParts = await look(filtered.node!)
    expectTrue(Math.max(...whole) > 2 * whole[2], 'the map is even')
    expectClose(inParts, whole, { relative: 0 }, 'in parts')

    tone.value.set(0.9, 0.5, 0.2)
    drawCube()
    for (let part = 1; part < parts; part++) expectTrue(!filtered.filterNext(renderer), 'too few')
    expectClose(await look(filtered.node!), whole, { relative: 0 }, 'half done')
    expectTrue(filtered.filterNext(renderer), 'too many parts')
    const redder = await look(filtered.node!)
    expectClose(redder[0], whole[2], { relative: 2e-3 }, 'red then is as blue before')
    filtered.dispose()
    expected.dispose()
    cube.dispose()
  },
  once
)
