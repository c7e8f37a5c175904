import {
  Atmosphere,
  moon,
  type Moon,
  MoonDirectionalLight,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight,
  sunFlare,
  moonIlluminanceAt,
  skyIlluminanceAt,
  sunIlluminanceAt
} from '@welkin/atmosphere'
import {
  Mesh,
  MeshLambertMaterial,
  OrthographicCamera,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3
} from 'three'
import { drawForward, expectLight, postPath } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const luminance = ([r, g, b]: readonly number[]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b
const origin = new Vector3()
const noFlare = { innerStrength: 0, outerStrength: 0 }

/** Looks at the moon, from above the air. */
function telescope(luna: Moon, degrees: number): PerspectiveCamera {
  const camera = new PerspectiveCamera(degrees, 1, 0.1, 100)
  camera.position.y = 2e5
  camera.lookAt(camera.position.clone().add(luna.seenFrom(camera.position).direction))
  camera.updateMatrixWorld()
  return camera
}

/** Light of a picture of the sky on a plane that faces it [lx]. */
function illuminance({ width, height, data }: Picture, degrees: number, scale: number): number {
  let sum = 0
  for (let i = 0; i < data.length; i += 4) sum += luminance([data[i], data[i + 1], data[i + 2]])
  const side = 2 * Math.tan((degrees * Math.PI) / 360)
  return (sum * side * side) / (width * height) / scale
}

gpuTest(
  'draws a moon whose light is the illuminance that it gives',
  async t => {
    const size = 96
    const renderer = await t.createRenderer({ width: size, height: size })
    const atmosphere = new Atmosphere()
    atmosphere.sunDirection = new Vector3(0, -1, 0)
    const direction = new Vector3(1, 4, 1)
    const luna = moon({ direction, mapSize: 128, flare: noFlare, lightsAir: false })
    atmosphere.add(luna)
    const camera = telescope(luna, 0.6)
    const scene = new Scene()
    // The full disc's mean is held tightly; in other phases it matters which ground is lit.
    for (const [phase, relative] of [
      [0.5, 0.02],
      [0.35, 0.1],
      [0.25, 0.15],
      [0.7, 0.15]
    ]) {
      luna.phase = phase
      const picture = await drawForward(renderer, scene, camera, atmosphere)
      expectLight(picture, `phase ${phase}`)
      const measured = illuminance(picture, 0.6, atmosphere.luminanceScale)
      const expected = luminance(moonIlluminanceAt(luna, camera.position))
      t.note(`phase ${phase}: ${(measured / expected).toFixed(4)}`)
      expectClose(measured, expected, { relative }, `phase ${phase}`)
    }
    atmosphere.dispose()
  },
  // The same numbers on both.
  { backends: ['webgpu'] }
)

gpuTest('has its seas in their places, and the far side of the terminator dark', async t => {
  const size = 96
  const renderer = await t.createRenderer({ width: size, height: size })
  const atmosphere = new Atmosphere()
  // Due west of the moon: the terminator runs from north to south.
  atmosphere.sunDirection = new Vector3(-1, 0, 0)
  const luna = moon({
    mapSize: 256,
    flare: noFlare,
    lightsAir: false,
    direction: new Vector3(0, 0.5, 1)
  })
  atmosphere.add(luna)
  const camera = telescope(luna, 0.56)
  // The moon's north is up in the picture.
  const scene = new Scene()
  luna.phase = 0.5
  const full = await drawForward(renderer, scene, camera, atmosphere)
  const radius = size * (luna.seenFrom(camera.position).angularRadius / ((0.56 * Math.PI) / 180))
  const at = (picture: Picture, longitude: number, latitude: number): number => {
    const [l, b] = [longitude, latitude].map(degrees => (degrees * Math.PI) / 180) as [
      number,
      number
    ]
    const x = size / 2 + radius * Math.cos(b) * Math.sin(l)
    const y = size / 2 - radius * Math.sin(b)
    let sum = 0
    for (const dx of [-1, 0, 1]) {
      for (const dy of [-1, 0, 1])
        sum += luminance(picture.at(Math.floor(x + dx), Math.floor(y + dy)))
    }
    return sum / 9
  }
  const highland = (at(full, 0, -35) + at(full, 20, -55) + at(full, 15, -30)) / 3
  for (const [name, longitude, latitude] of [
    ['Imbrium', -16, 34],
    ['Serenitatis', 18, 27],
    ['Tranquillitatis', 30, 9],
    ['Crisium', 59, 17],
    ['Fecunditatis', 52, -5],
    ['Procellarum', -52, 15],
    ['Nubium', -17, -20],
    ['Humorum', -39, -24]
  ] as const) {
    const ratio = at(full, longitude, latitude) / highland
    expectTrue(ratio < 0.65 && ratio > 0.25, `${name} is ${ratio} of the highlands`)
  }
  // The full moon has no dark limb: 80° from the middle it is as bright as anywhere.
  expectTrue(at(full, 0, -72) / highland > 0.7, `limb is ${at(full, 0, -72) / highland}`)
  luna.phase = 0.25
  const quarter = await drawForward(renderer, scene, camera, atmosphere)
  const [west, east] = [at(quarter, -40, -40), at(quarter, 40, -40)]
  expectTrue(east > 300 * west && west > 0, `first quarter: east ${east}, earthshine ${west}`)
  luna.phase = 0.75
  const last = await drawForward(renderer, scene, camera, atmosphere)
  expectTrue(at(last, -40, -40) > 300 * at(last, 40, -40), 'last quarter')
  atmosphere.dispose()
})

gpuTest('lights a plane and the sky over it as float64 predicts, within 2 %', async t => {
  const small = { width: 16, height: 16 }
  const renderer = await t.createRenderer(small)
  const atmosphere = new Atmosphere().setSunAngles(-40, 0)
  const luna = moon({ mapSize: 16, strength: 1e4 })
  atmosphere.add(luna)
  await atmosphere.bake(renderer)
  const scene = new Scene()
  const plane = new PlaneGeometry(40, 40).rotateX(-Math.PI / 2)
  scene.add(new Mesh(plane, new MeshLambertMaterial({ color: 0xffffff })))
  scene.add(new MoonDirectionalLight(atmosphere, luna), new SkyLightProbe(atmosphere, luna.source))
  const camera = new OrthographicCamera(-5, 5, 5, -5, 1, 100)
  camera.position.y = 10
  camera.rotation.x = -Math.PI / 2
  const up = new Vector3(0, 1, 0)
  for (const [elevation, phase] of [
    [60, 0.5],
    [20, 0.3],
    [5, 0.5]
  ]) {
    const angle = (elevation * Math.PI) / 180
    luna.direction = new Vector3(Math.cos(angle), Math.sin(angle), 0)
    luna.phase = phase
    const picture = await t.render(renderer, scene, camera, small)
    const direct = moonIlluminanceAt(luna, camera.position)
    const sky = skyIlluminanceAt(atmosphere, camera.position, up, { source: luna.source })
    const expected = direct.map((value, i) => (value * Math.sin(angle) + sky[i]) / Math.PI)
    const predicted = luminance(expected) * atmosphere.luminanceScale
    expectClose(luminance(picture.at(8, 8)), predicted, { relative: 0.02 }, `moon at ${elevation}°`)
  }
  atmosphere.dispose()
})

gpuTest(
  'glows like the sky by day, a 400,000th as bright, by either path',
  async t => {
    const renderer = await t.createRenderer({ width: 32, height: 32 })
    const camera = new PerspectiveCamera(60, 1, 1, 1e6)
    camera.position.y = 2
    camera.rotation.x = 0.4
    camera.updateMatrixWorld()
    const direction = new Vector3(1, 1, 1).normalize()
    const aboveTheAir = new Vector3(0, 1e6, 0)
    const atmosphere = new Atmosphere()
    atmosphere.sunDirection = direction
    const daylight = await drawForward(renderer, new Scene(), camera, atmosphere)
    const sunlight = luminance(sunIlluminanceAt(atmosphere, aboveTheAir))
    atmosphere.sunDirection = new Vector3(0, -1, 0)
    const strength = 1e5
    const luna = moon({ direction, phase: 0.5, mapSize: 16, strength, flare: noFlare })
    atmosphere.add(luna)
    const moonlight = await drawForward(renderer, new Scene(), camera, atmosphere)
    const light = luminance(moonIlluminanceAt(luna, aboveTheAir))
    for (const [x, y] of [
      [4, 4],
      [16, 12],
      [28, 20]
    ]) {
      const ratio = luminance(moonlight.at(x, y)) / luminance(daylight.at(x, y))
      expectClose(ratio, light / sunlight, { relative: 0.06 }, `pixel ${x}, ${y}`)
    }
    const scene = new Scene()
    const wall = new Mesh(new PlaneGeometry(6e4, 6e4), new MeshLambertMaterial({ color: 0 }))
    wall.position.z = -30_000
    scene.add(wall)
    const forward = await drawForward(renderer, scene, camera, atmosphere)
    const post = postPath(renderer, scene, camera, atmosphere)
    const after = await post.draw()
    for (const picture of [forward, after]) expectLight(picture, 'haze by moonlight')
    const haze = forward.at(16, 24).slice(0, 3)
    expectTrue(luminance(haze) > 1e-4, `haze is ${haze}`)
    expectClose(after.at(16, 24).slice(0, 3), haze, { relative: 0.02 }, 'post path')
    post.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'air takes up the light of a full moon at dusk without a step',
  async t => {
    const renderer = await t.createRenderer({ width: 64, height: 64 })
    // Where moonlit air begins.
    const atmosphere = new Atmosphere().setSunAngles(-2.02, 270)
    const camera = new PerspectiveCamera(60, 1, 1, 1e6)
    camera.position.y = 2
    const direction = new Vector3(0.94, 0.34, 0)
    camera.lookAt(camera.position.clone().add(new Vector3(0.94, 0.34, 0.1)))
    camera.updateMatrixWorld()
    const drawWith = async (lightsAir: boolean): Promise<Picture> => {
      const luna = moon({ direction, phase: 0.5, mapSize: 16, flare: noFlare, lightsAir })
      atmosphere.add(luna)
      const picture = await drawForward(renderer, new Scene(), camera, atmosphere)
      luna.dispose()
      return picture
    }
    const [without, lit] = [await drawWith(false), await drawWith(true)]
    let most = 0
    for (let y = 0; y < 64; y++) {
      for (let x = 0; x < 64; x++) {
        const before = luminance(without.at(x, y))
        most = Math.max(most, luminance(lit.at(x, y)) / before - 1)
      }
    }
    t.note(`${(100 * most).toFixed(2)} % at most`)
    expectTrue(most > 0 && most < 0.01, `the sky grows by ${most}`)
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'hides the sun and dims light, sky and haze in an eclipse',
  async t => {
    const size = { width: 64, height: 64 }
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere().place({ longitude: -96.797, latitude: 32.777 })
    const draw = async (time: string): Promise<{ sky: Picture; plane: number }> => {
      atmosphere.date = new Date(`2024-04-08T${time}Z`)
      const camera = new PerspectiveCamera(2, 1, 0.1, 100)
      camera.position.y = 2
      camera.lookAt(camera.position.clone().add(atmosphere.sunDirection))
      camera.updateMatrixWorld()
      const scene = new Scene()
      const sky = await drawForward(renderer, scene, camera, atmosphere)
      expectLight(sky, time)
      const plane = new PlaneGeometry(400, 400)
      scene.add(new Mesh(plane, new MeshLambertMaterial()), new SunDirectionalLight(atmosphere))
      scene.children[0].rotation.x = -Math.PI / 2
      camera.lookAt(0, 0, 0.01)
      camera.updateMatrixWorld()
      const ground = await t.render(renderer, scene, camera, size)
      const lit = luminance(ground.at(32, 32))
      const sun = luminance(sunIlluminanceAt(atmosphere, origin)) * atmosphere.sunDirection.y
      expectClose(
        lit,
        (sun / Math.PI) * 1e-4,
        { relative: 0.02, absolute: 1e-9 },
        `plane at ${time}`
      )
      return { sky, plane: lit }
    }
    const bare = await draw('18:42:38')
    atmosphere.add(sunFlare(), moon({ mapSize: 64 }))
    const total = await draw('18:42:38')
    const partial = await draw('18:10:00')
    expectTrue(luminance(total.sky.at(32, 32)) < 1e-5 * luminance(bare.sky.at(32, 32)), 'disc')
    const ring = luminance(total.sky.at(32, 22))
    expectTrue(ring > 1e-3 && ring < 10, `corona is ${ring}`)
    expectTrue(total.plane < 3e-6 * bare.plane, `light in totality is ${total.plane}`)
    expectTrue(
      partial.plane > 0.3 * bare.plane && partial.plane < 0.8 * bare.plane,
      `partial light is ${partial.plane}`
    )
    atmosphere.dispose()
  },
  // WebGL's picture of totality has it.
  { backends: ['webgpu'] }
)

gpuTest(
  'leaves no memory behind when it comes and goes under a sky that stays',
  async t => {
    const renderer = await t.createRenderer({ width: 16, height: 16 })
    const atmosphere = new Atmosphere().setSunAngles(-20, 90)
    const camera = new PerspectiveCamera()
    const scene = new Scene()
    const background = skyBackground(atmosphere)
    scene.backgroundNode = background
    const memory = (): string => {
      renderer.render(scene, camera)
      const { programs, renderTargets, textures, texturesSize, uniformBuffers } =
        renderer.info.memory
      return JSON.stringify({ programs, renderTargets, textures, texturesSize, uniformBuffers })
    }
    const [without, withMoon] = [[memory()], Array<string>()]
    for (let i = 0; i < 4; i++) {
      const luna = moon({ mapSize: 16 })
      atmosphere.add(luna)
      withMoon.push(memory())
      luna.dispose()
      without.push(memory())
    }
    background.dispose()
    atmosphere.dispose()
    t.note(`${without[0]} without, ${withMoon[0]} with it`)
    expectTrue(withMoon[0] !== without[0], 'a moon takes no memory')
    // What all moons share stays after the first.
    expectTrue(new Set(without.slice(1)).size === 1, `without: ${without.join('\n')}`)
    expectTrue(new Set(withMoon.slice(1)).size === 1, `with: ${withMoon.join('\n')}`)
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'leaves no memory behind',
  async t => {
    const renderer = await t.createRenderer({ width: 8, height: 8 })
    const camera = new PerspectiveCamera(60, 1, 1, 1e6)
    const round = (): string => {
      const atmosphere = new Atmosphere().setSunAngles(-30, 0)
      // Tables that are never done are never read back.
      atmosphere.bakeStepsPerFrame = 1
      atmosphere.add(sunFlare(), moon({ mapSize: 16 }))
      const scene = new Scene()
      const background = skyBackground(atmosphere)
      scene.backgroundNode = background
      renderer.render(scene, camera)
      background.dispose()
      atmosphere.dispose()
      return JSON.stringify(renderer.info.memory)
    }
    const before = round()
    const after = round()
    expectTrue(before === after, `before ${before}, after ${after}`)
  },
  // What atmospheres leave on WebGL: see `atmosphere/lifecycle`.
  { bakes: true, backends: ['webgpu'] }
)
