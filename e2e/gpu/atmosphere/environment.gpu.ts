import {
  Atmosphere,
  heightFog,
  skyBackground,
  imageEnvironment,
  skyEnvironment,
  skyLuminanceAt,
  SkyLightProbe,
  SunDirectionalLight
} from '@welkin/atmosphere'
import type { SkyEnvironmentNode } from '@welkin/atmosphere'
import {
  BackSide,
  BoxGeometry,
  CubeCamera,
  EquirectangularReflectionMapping,
  HalfFloatType,
  Mesh,
  MeshStandardMaterial,
  OrthographicCamera,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import type { Camera } from 'three'
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js'
import { pmremTexture, positionWorldDirection, uniform, vec3, vec4 } from 'three/tsl'
import { CubeRenderTarget, NodeMaterial, PMREMGenerator } from 'three/webgpu'
import type { Node, WebGPURenderer } from 'three/webgpu'
import { PrefilteredCube } from '../../../packages/atmosphere/src/environment/PrefilteredCube'
import { drawToFloat, random } from '../harness/atmosphere'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { filterCoarsely } from '../harness/filter-samples'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const luminance = ([r, g, b]: readonly number[]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b
const size = { width: 32, height: 32 }
/** When what is drawn again, and with which light, is decided without a backend. */
const once = { backends: ['webgpu'] } as const
// Each takes seconds in software.
const REDRAWS = 2
/** That a redraw of the default size takes: 6 faces, 9 parts of the filter. */
const FRAMES = 15

/** A ball that fills the picture of a camera that looks along −Z, and what lights it. */
function ballScene(roughness: number, metalness: number): { scene: Scene; camera: Camera } {
  const scene = new Scene()
  const material = new MeshStandardMaterial({ color: 0xffffff, roughness, metalness })
  scene.add(new Mesh(new SphereGeometry(1, 128, 96), material))
  const camera = new OrthographicCamera(-1, 1, 1, -1, 0.1, 10)
  camera.position.z = 3
  return { scene, camera }
}

/**
 * A flat mirror that shows what lies in a direction, to a camera at a place. Flat, for three takes a
 * curved one in few pixels for rough.
 */
function mirrorScene(at: Vector3, direction: Vector3): { scene: Scene; camera: Camera } {
  const scene = new Scene()
  const material = new MeshStandardMaterial({ color: 0xffffff, roughness: 0, metalness: 1 })
  const mirror = new Mesh(new PlaneGeometry(9, 9), material)
  const camera = new OrthographicCamera(-1, 1, 1, -1, 0.1, 10)
  // Seen at less than 60°, from a side that is not the direction itself.
  const side = new Vector3(0.31, 0.53, -0.79).cross(direction).normalize()
  const toCamera = direction.clone().add(side).normalize()
  mirror.position.copy(at).addScaledVector(toCamera, -3)
  mirror.lookAt(mirror.position.clone().add(toCamera).add(direction))
  camera.position.copy(at)
  camera.lookAt(mirror.position)
  scene.add(mirror)
  return { scene, camera }
}

const draw = (renderer: WebGPURenderer, scene: Scene, camera: Camera): Promise<Picture> =>
  drawToFloat(renderer, () => renderer.render(scene, camera))

/** Draws until the environment rests. */
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

gpuTest('is mirrored by polished metal as float64 has the sky, in any frame', async t => {
  const renderer = await t.createRenderer({ width: 4, height: 4 })
  const next = random(12)
  const directions = Array.from({ length: 24 }, () =>
    new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).normalize()
  )
  const worlds = [
    { frame: 'local', at: new Vector3(0, 5, 0), up: new Vector3(0, 1, 0) },
    { frame: 'ecef', at: new Vector3(0, 6_378_200, 0), up: new Vector3(0, 1, 0) },
    { frame: 'ecef', at: new Vector3(-6_378_600, 0, 0), up: new Vector3(-1, 0, 0) }
  ] as const
  let worst = 0
  const atmosphere = new Atmosphere()
  atmosphere.sunDirection = new Vector3(-0.5, 0.4, 0.3)
  await atmosphere.bake(renderer)
  for (const { frame, at, up } of worlds) {
    atmosphere.frame = frame
    const environment = skyEnvironment(atmosphere)
    for (const direction of directions) {
      // A texel of the cube is wider than the horizon's edge, and the filter wider still.
      if (Math.abs(direction.dot(up)) < 0.1) continue
      const { scene, camera } = mirrorScene(at, direction)
      scene.environmentNode = environment
      const actual = luminance((await draw(renderer, scene, camera)).at(2, 2))
      const expected = luminance(skyLuminanceAt(atmosphere, at, direction))
      const predicted = expected * atmosphere.luminanceScale
      const label = `${frame}, towards ${direction
        .toArray()
        .map(v => v.toFixed(2))
        .join(' ')}`
      expectClose(actual, predicted, { relative: 0.03 }, label)
      worst = Math.max(worst, Math.abs(actual / predicted - 1))
    }
    expectTrue(environment.redraws === 1, `drawn ${environment.redraws} times`)
    environment.dispose()
  }
  atmosphere.dispose()
  t.note(`worst ${(100 * worst).toFixed(2)} %`)
})

gpuTest(
  'has no sun, and lights matte surfaces once',
  async t => {
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere().setSunAngles(60, 180)
    const { scene, camera } = ballScene(1, 0)
    camera.position.set(0, 3, 0)
    camera.lookAt(0, 0, 0)
    const environment = skyEnvironment(atmosphere)
    scene.environmentNode = environment
    const alone = luminance((await draw(renderer, scene, camera)).at(16, 16))

    const probe = new SkyLightProbe(atmosphere)
    scene.add(probe)
    const both = luminance((await draw(renderer, scene, camera)).at(16, 16))
    scene.environmentNode = null
    const probeAlone = luminance((await draw(renderer, scene, camera)).at(16, 16))
    t.note(
      `environment ${alone.toFixed(4)}, with probe ${both.toFixed(4)}, probe ${probeAlone.toFixed(4)}`
    )
    expectClose(both, probeAlone, { relative: 0.08 }, 'with both, beside its sheen')
    expectTrue(both >= probeAlone, 'the sheen adds light')
    expectClose(alone, probeAlone, { relative: 0.15 }, 'three’s map instead of the probe')

    scene.environmentNode = skyEnvironment(atmosphere, { diffuse: true })
    const twice = luminance((await draw(renderer, scene, camera)).at(16, 16))
    expectTrue(twice > 1.7 * probeAlone, `asked for, both light it: ${twice}`)

    // Towards the sun, polished metal shows the glow about it, not the disc.
    const mirror = ballScene(0, 1)
    mirror.scene.environmentNode = environment
    const background = new Scene()
    background.backgroundNode = skyBackground(atmosphere)
    const eye = new PerspectiveCamera(0.2, 1, 0.1, 10)
    eye.lookAt(atmosphere.sunDirection)
    const disc = luminance((await draw(renderer, background, eye)).at(16, 16))
    const brightest = Math.max(...(await draw(renderer, mirror.scene, mirror.camera)).data)
    expectTrue(brightest < disc / 1000, `${brightest} in the mirror, the disc has ${disc}`)
    atmosphere.dispose()
  },
  once
)

gpuTest(
  'is drawn again when sun or height change, a step a frame, in the same memory',
  async t => {
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere().setSunAngles(20, 100)
    const { scene, camera } = ballScene(0.3, 1)
    scene.add(new SunDirectionalLight(atmosphere))
    const environment = skyEnvironment(atmosphere, { angle: 0.2, climb: 0.1 })
    scene.environmentNode = environment
    renderer.render(scene, camera)
    expectTrue(environment.redraws === 1, `${environment.redraws} after the first frame`)
    for (let i = 0; i < 10; i++) renderer.render(scene, camera)
    expectTrue(environment.redraws === 1, 'nothing moves, nothing is drawn')

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
    environment.needsRedraw = true
    frames = settle(renderer, scene, camera, environment)
    expectTrue(frames === 1, `when asked for, drawn in ${frames} frames`)

    // Software takes seconds to filter a cube: the GPU must not fall behind by more than one.
    const rest = (): Promise<Picture> => draw(renderer, scene, camera)
    await rest()
    const memory = JSON.stringify(renderer.info.memory)
    const before = environment.redraws
    for (let redraw = 1; redraw <= REDRAWS; redraw++) {
      atmosphere.setSunAngles(20.3 + redraw, 100)
      settle(renderer, scene, camera, environment)
      await rest()
    }
    expectTrue(environment.redraws === before + REDRAWS, `${environment.redraws - before} redraws`)
    const after = JSON.stringify(renderer.info.memory)
    expectTrue(after === memory, `memory was ${memory}, is ${after}`)

    const { textures } = renderer.info.memory
    environment.dispose()
    const freed = textures - renderer.info.memory.textures
    expectTrue(freed >= 3, `dispose freed ${freed} textures`)
    atmosphere.dispose()
  },
  { ...once, timeoutSeconds: 240 }
)

gpuTest(
  'follows a moving sun with nothing else of the atmosphere in the scene',
  async t => {
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere().setSunAngles(20, 100)
    const { scene, camera } = ballScene(0.3, 1)
    const environment = skyEnvironment(atmosphere)
    scene.environmentNode = environment
    renderer.render(scene, camera)
    for (let frame = 1; frame <= FRAMES; frame++) {
      atmosphere.setSunAngles(20 + 0.5 * frame, 100)
      renderer.render(scene, camera)
    }
    expectTrue(environment.redraws === 2, `${environment.redraws} redraws`)
    environment.dispose()
    atmosphere.dispose()
  },
  { ...once, timeoutSeconds: 120 }
)

gpuTest(
  'has the luminance scale of now, whatever it was when a face was drawn',
  async t => {
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
    }
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
  { ...once, timeoutSeconds: 120 }
)

gpuTest(
  'is drawn again when layers change',
  async t => {
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
  { ...once, timeoutSeconds: 180 }
)

gpuTest(
  'filters a part at a time what three filters at once, unseen until it is complete',
  async t => {
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
  { bakes: ['webgpu'], timeoutSeconds: 240 }
)

/** A sky as a file in Radiance's format, 4 bytes a pixel without run lengths. */
function hdrFile(atmosphere: Atmosphere, width: number, height: number): ArrayBuffer {
  const header = new TextEncoder().encode(
    `#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y ${height} +X ${width}\n`
  )
  const file = new Uint8Array(header.length + 4 * width * height)
  file.set(header)
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      // three's equirectangular pictures: u = atan(z, x)/2π + ½.
      const azimuth = ((x + 0.5) / width - 0.5) * 2 * Math.PI
      const elevation = (0.5 - (y + 0.5) / height) * Math.PI
      const level = Math.cos(elevation)
      const direction = new Vector3(
        Math.cos(azimuth) * level,
        Math.sin(elevation),
        Math.sin(azimuth) * level
      )
      const color = skyLuminanceAt(atmosphere, new Vector3(0, 2, 0), direction)
      const scaled = color.map(value => Math.max(value * atmosphere.luminanceScale, 0))
      const exponent = Math.ceil(Math.log2(Math.max(...scaled, 1e-9)))
      const bytes = scaled.map(value => Math.min((value / 2 ** exponent) * 256, 255))
      file.set([...bytes, exponent + 128], header.length + 4 * (y * width + x))
    }
  }
  return file.buffer
}

gpuTest('can be an .hdr file, mirrored as the sky that it is of', async t => {
  const renderer = await t.createRenderer(size)
  const atmosphere = new Atmosphere().setSunAngles(35, 60)
  await atmosphere.bake(renderer)
  const { scene, camera } = ballScene(0.35, 1)
  camera.position.y = 0.01
  scene.environmentNode = skyEnvironment(atmosphere)
  const sky = await draw(renderer, scene, camera)
  const url = URL.createObjectURL(new Blob([hdrFile(atmosphere, 96, 48)]))
  const image = await new HDRLoader().loadAsync(url)
  URL.revokeObjectURL(url)
  image.mapping = EquirectangularReflectionMapping
  scene.environmentNode = imageEnvironment(image)
  const file = await draw(renderer, scene, camera)
  for (const [x, y] of [
    [16, 6],
    [16, 12],
    [8, 10],
    [24, 10],
    [16, 25]
  ] as const) {
    const [a, b] = [luminance(file.at(x, y)), luminance(sky.at(x, y))]
    expectClose(a, b, { relative: 0.05 }, `(${x}, ${y})`)
  }
  image.dispose()
  atmosphere.dispose()
})

gpuTest('meets the sky at the horizon of still water without a seam', async t => {
  // What the smoothest material mirrors is filtered a little.
  filterCoarsely(false)
  const renderer = await t.createRenderer({ width: 16, height: 64 })
  const atmosphere = new Atmosphere().setSunAngles(15, 250)
  const scene = new Scene()
  scene.backgroundNode = skyBackground(atmosphere)
  scene.environmentNode = skyEnvironment(atmosphere)
  const sea = new PlaneGeometry(4e4, 4e4).rotateX(-Math.PI / 2)
  scene.add(
    new Mesh(sea, new MeshStandardMaterial({ color: 0xffffff, metalness: 1, roughness: 0 }))
  )
  const camera = new PerspectiveCamera(8, 0.25, 0.1, 1e6)
  camera.position.y = 2
  const picture = await draw(renderer, scene, camera)
  // three blurs what the smoothest material mirrors, and at grazing angles takes a few per cent off.
  // A mirror: as far below the horizon as the sky above it.
  for (let row = 4; row < 30; row += 3) {
    const [above, below] = [picture.at(8, 31 - row), picture.at(8, 32 + row)].map(luminance)
    expectClose(below, above, { relative: 0.05 }, `${(((row + 0.5) * 8) / 64).toFixed(2)}° down`)
  }
  atmosphere.dispose()
})
