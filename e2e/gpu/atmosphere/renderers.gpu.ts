import {
  aerialPerspectiveFog,
  Atmosphere,
  AtmosphereParameters,
  AtmosphereShell,
  milkyWay,
  NightLightProbe,
  skyBackground,
  skyEnvironment,
  SkyLightProbe,
  SunDirectionalLight
} from '@welkin/atmosphere'
import {
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  WebGLRenderer,
  type Object3D
} from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { drawToFloat, expectLight, relativeDifferences } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { Picture } from '../harness/picture'

const size = { width: 64, height: 36 }

function expectError(act: () => unknown, pattern: RegExp): void {
  let said = 'nothing'
  try {
    act()
  } catch (error) {
    said = String(error)
  }
  expectTrue(pattern.test(said), `${pattern} expected, got '${said}'`)
}

const makeCamera = (): PerspectiveCamera => {
  const camera = new PerspectiveCamera(60, size.width / size.height, 1, 1e5)
  camera.position.set(0, 2, 5)
  return camera
}

gpuTest('says what to use in place of a WebGLRenderer', async t => {
  const wrong = new WebGLRenderer()
  wrong.setSize(size.width, size.height)
  const right = await t.createRenderer(size)
  const camera = makeCamera()
  const atmosphere = new Atmosphere()
  const things: Record<string, Object3D> = {
    SunDirectionalLight: new SunDirectionalLight(atmosphere),
    SkyLightProbe: new SkyLightProbe(atmosphere),
    NightLightProbe: new NightLightProbe(atmosphere),
    AtmosphereShell: new AtmosphereShell(new AtmosphereParameters(), 1)
  }
  for (const [name, thing] of Object.entries(things)) {
    const ball = new Mesh(new SphereGeometry(), new MeshStandardMaterial())
    const scene = new Scene().add(ball.add(thing))
    let calls = 0
    const own = (): void => void calls++
    scene.onBeforeRender = own
    const pattern = new RegExp(`${name}: renderer must be a WebGPURenderer of three/webgpu.*, got `)
    for (let i = 0; i < 2; i++) expectError(() => wrong.render(scene, camera), pattern)
    calls = 0
    for (let i = 0; i < 2; i++) right.render(scene, camera)
    expectTrue(
      calls === 2,
      `the scene's own onBeforeRender was called ${calls} times for two renders`
    )
    expectTrue(scene.onBeforeRender === own, `${name} leaves something behind on the scene`)
  }
  expectError(
    () => atmosphere.update(wrong as never, camera),
    /Atmosphere: renderer must be a WebGPURenderer/
  )
  const plain = new Scene().add(new Mesh(new SphereGeometry(), new MeshStandardMaterial()))
  wrong.render(plain, camera)
  wrong.dispose()
  atmosphere.dispose()
})

gpuTest(
  'says where sky and haze belong when they are set as background and fog',
  async t => {
    const renderer = await t.createRenderer(size)
    const camera = makeCamera()
    const atmosphere = new Atmosphere()
    const scene = new Scene().add(new Mesh(new SphereGeometry(), new MeshStandardMaterial()))
    const misplaced = Object.assign(scene, { background: skyBackground(atmosphere) })
    expectError(() => renderer.render(scene, camera), /skyBackground: .* scene\.backgroundNode/)
    Object.assign(misplaced, { background: null, fog: aerialPerspectiveFog(atmosphere) })
    expectError(() => renderer.render(scene, camera), /aerialPerspectiveFog: .* scene\.fogNode/)
    scene.fog = null
    renderer.render(scene, camera)
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

/** Ball, background, fog, lights and environment of one atmosphere. */
function everything(atmosphere: Atmosphere): Scene {
  const ball = new Mesh(new SphereGeometry(), new MeshStandardMaterial({ metalness: 0.5 }))
  const scene = new Scene().add(
    ball,
    new SunDirectionalLight(atmosphere),
    new SkyLightProbe(atmosphere)
  )
  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  scene.environmentNode = skyEnvironment(atmosphere)
  return scene
}

const refusal = /Atmosphere: renderer must be the first, until/

gpuTest(
  'refuses a second renderer until the first is disposed of',
  async t => {
    const camera = makeCamera()
    const atmosphere = new Atmosphere().setSunAngles(40, 60)
    const scene = everything(atmosphere)
    const [first, second, third] = [
      await t.createRenderer(size),
      await t.createRenderer(size),
      await t.createRenderer(size)
    ]
    const draw = async (renderer: WebGPURenderer, what = scene): Promise<Picture> => {
      let picture = new Picture(0, 0, new Float32Array())
      // The environment is complete after some frames.
      for (let i = 0; i < 3; i++)
        picture = await drawToFloat(renderer, () => renderer.render(what, camera))
      expectLight(picture, 'a picture')
      return picture
    }
    const expected = await draw(first)
    const most = (picture: Picture): number => relativeDifferences(expected, picture).at(-1)!
    for (let i = 0; i < 2; i++) expectError(() => second.render(scene, camera), refusal)
    expectTrue(most(await draw(first)) === 0, 'the first draws something else after that')
    expectError(() => atmosphere.update(second, camera), refusal)

    await first.dispose()
    const bySecond = most(await draw(second))
    expectTrue(bySecond < 1e-3, `a renderer in the first's place draws something else: ${bySecond}`)

    expectError(() => third.render(scene, camera), refusal)
    atmosphere.dispose()
    const byThird = most(await draw(third, everything(atmosphere)))
    expectTrue(byThird < 1e-3, `after the atmosphere's dispose it draws something else: ${byThird}`)
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'refuses a layer that another renderer draws',
  async t => {
    const camera = makeCamera()
    const layer = milkyWay()
    const [first, second] = [await t.createRenderer(size), await t.createRenderer(size)]
    const scenes = [0, 1].map(() => everything(new Atmosphere().add(layer)))
    first.render(scenes[0], camera)
    expectError(() => second.render(scenes[1], camera), /MilkyWay: renderer must be the first/)
  },
  { backends: ['webgpu'] }
)
