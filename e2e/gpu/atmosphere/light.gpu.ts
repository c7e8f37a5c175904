import {
  Atmosphere,
  skyBackground,
  skyIlluminanceAt,
  SkyLightProbe,
  skyLuminanceAt,
  SunDirectionalLight,
  sunIlluminanceAt
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import {
  CubeCamera,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  FloatType,
  OrthographicCamera,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import { CubeRenderTarget } from 'three/webgpu'
import { drawForward, expectLight } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { readPicture } from '../harness/picture'

const small = { width: 16, height: 16 }
const luminance = ([r, g, b]: readonly number[]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b

gpuTest('lights a white plane as float64 predicts, within 1 %', async t => {
  const renderer = await t.createRenderer(small)
  const atmosphere = new Atmosphere().place({ longitude: 10, latitude: 40 })
  await atmosphere.bake(renderer)
  const scene = new Scene()
  const plane = new PlaneGeometry(40, 40).rotateX(-Math.PI / 2)
  scene.add(new Mesh(plane, new MeshLambertMaterial({ color: 0xffffff })))
  scene.add(new SunDirectionalLight(atmosphere), new SkyLightProbe(atmosphere))
  const camera = new OrthographicCamera(-5, 5, 5, -5, 1, 100)
  camera.position.y = 10
  camera.rotation.x = -Math.PI / 2
  const up = new Vector3(0, 1, 0)
  for (const elevation of [80, 40, 10, 3, -3]) {
    atmosphere.setSunAngles(elevation, 150)
    atmosphere.luminanceScale = elevation > 0 ? 1e-4 : 1e-1
    const picture = await t.render(renderer, scene, camera, small)
    const sun = sunIlluminanceAt(atmosphere, new Vector3())
    const sky = skyIlluminanceAt(atmosphere, new Vector3(), up)
    const slope = Math.max(Math.sin((elevation * Math.PI) / 180), 0)
    const expected = sun.map((value, i) => (value * slope + sky[i]) / Math.PI)
    const predicted = luminance(expected) * atmosphere.luminanceScale
    expectClose(luminance(picture.at(8, 8)), predicted, { relative: 0.01 }, `sun at ${elevation}°`)
  }
  atmosphere.dispose()
})

gpuTest(
  'lights the day side of a globe and leaves the night side dark',
  async t => {
    const renderer = await t.createRenderer({ width: 64, height: 64 })
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    atmosphere.sunDirection = new Vector3(1, 0, 0)
    const scene = new Scene()
    const globe = new Mesh(new SphereGeometry(1, 96, 48), new MeshLambertMaterial())
    globe.scale.copy(Ellipsoid.WGS84.radii)
    scene.add(globe, new SunDirectionalLight(atmosphere))
    const camera = new OrthographicCamera(-7e6, 7e6, 7e6, -7e6, 1e6, 4e7)
    camera.position.set(0, -2e7, 0)
    camera.up.set(0, 0, 1)
    camera.lookAt(0, 0, 0)
    const picture = await t.render(renderer, scene, camera, { width: 64, height: 64 })
    expectLight(picture, 'globe')
    expectTrue(luminance(picture.at(52, 32)) > 1, `day is ${picture.at(52, 32)}`)
    for (const x of [8, 16, 24, 29]) {
      expectTrue(luminance(picture.at(x, 32)) === 0, `night at ${x} is ${picture.at(x, 32)}`)
    }
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest('draws the sky that float64 predicts, to any camera and cube camera', async t => {
  const renderer = await t.createRenderer({ width: 32, height: 32 })
  const atmosphere = new Atmosphere().setSunAngles(40, 100)
  await atmosphere.bake(renderer)
  const scene = new Scene()
  const predict = (position: Vector3, direction: Vector3): number[] =>
    skyLuminanceAt(atmosphere, position, direction).map(v => v * atmosphere.luminanceScale)
  const camera = new PerspectiveCamera(60, 1, 1, 1e7)
  for (const height of [2, 40_000]) {
    camera.position.y = height
    camera.updateMatrixWorld()
    const picture = await drawForward(renderer, scene, camera, atmosphere)
    for (const y of [2, 8, 12, 20, 24, 30]) {
      const ray = new Vector3(1 / 32, 1 - (2 * y + 1) / 32, 0.5).unproject(camera)
      const expected = predict(camera.position, ray.sub(camera.position))
      const label = `${height} m, row ${y}`
      expectClose(
        picture.at(16, y).slice(0, 3),
        expected,
        { relative: 0.03, absolute: 2e-3 },
        label
      )
    }
  }
  const target = new CubeRenderTarget(15, { type: FloatType, generateMipmaps: false })
  const cube = new CubeCamera(1, 1e7, target)
  cube.position.y = 2
  scene.backgroundNode = skyBackground(atmosphere)
  cube.update(renderer, scene)
  for (const face of [0, 1, 2, 3, 4, 5]) {
    expectLight(await readPicture(renderer, target, { layer: face }), `face ${face}`)
  }
  const up = await readPicture(renderer, target, { layer: 2 })
  const expected = predict(cube.position, new Vector3(0, 1, 0))
  expectClose(up.at(7, 7).slice(0, 3), expected, { relative: 0.03 }, 'zenith')
  target.dispose()
  atmosphere.dispose()
})

gpuTest('sees haze through glass', async t => {
  const renderer = await t.createRenderer(small)
  const atmosphere = new Atmosphere().setSunAngles(40, 100)
  const scene = new Scene()
  const wall = new Mesh(new PlaneGeometry(1e5, 1e5), new MeshBasicMaterial({ color: 0x000000 }))
  wall.position.z = -20_000
  const glass = new Mesh(
    new PlaneGeometry(10, 10),
    new MeshBasicMaterial({ color: 0x000000, transparent: true, opacity: 0.5 })
  )
  glass.position.set(0, 100, -2)
  scene.add(wall)
  const camera = new PerspectiveCamera(40, 1, 0.1, 1e5)
  camera.position.y = 100
  const open = await drawForward(renderer, scene, camera, atmosphere)
  scene.add(glass)
  const behind = await drawForward(renderer, scene, camera, atmosphere)
  const [a, b] = [open.at(8, 6).slice(0, 3), behind.at(8, 6).slice(0, 3)]
  expectTrue(luminance(a) > 0.01, `haze is ${a}`)
  expectClose(
    b,
    a.map(value => value / 2),
    { relative: 0.01 },
    'through glass'
  )
  atmosphere.dispose()
})
