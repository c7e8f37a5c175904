import {
  Atmosphere,
  skyBackground,
  imageEnvironment,
  skyEnvironment,
  skyLuminanceAt,
  SkyLightProbe
} from '@welkin/atmosphere'
import {
  EquirectangularReflectionMapping,
  Mesh,
  MeshStandardMaterial,
  OrthographicCamera,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3
} from 'three'
import type { Camera } from 'three'
import { HDRLoader } from 'three/addons/loaders/HDRLoader.js'
import { random } from '../harness/atmosphere'
import { ballScene, draw, luminance } from '../harness/environment'
import { expectClose, expectTrue } from '../harness/expect'
import { filterCoarsely } from '../harness/filter-samples'
import { gpuTest } from '../harness/gpu-test'

const size = { width: 32, height: 32 }

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
  { backends: ['webgpu'] }
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

gpuTest(
  'can be an .hdr file, mirrored as the sky that it is of',
  async t => {
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
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'meets the sky at the horizon of still water without a seam',
  async t => {
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
  },
  { backends: ['webgpu'] }
)
