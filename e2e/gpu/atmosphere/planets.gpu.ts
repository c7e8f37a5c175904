import {
  Atmosphere,
  AtmosphereParameters,
  SunDirectionalLight,
  airlessParameters,
  planetGround,
  skyBackground,
  skyLuminanceAt,
  venusParameters
} from '@welkin/atmosphere'
import { LightQuery } from '../../../packages/atmosphere/src/queries/LightQuery'
import { Ellipsoid } from '@welkin/geo'
import {
  DataTexture,
  FloatType,
  Mesh,
  MeshLambertMaterial,
  NearestFilter,
  PerspectiveCamera,
  PlaneGeometry,
  RGBAFormat,
  RepeatWrapping,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import { vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import {
  airScene,
  drawForward,
  expectLight,
  postPath,
  random,
  relativeDifferences
} from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const luminance = ([r, g, b]: readonly number[]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b

/** Direction of a pixel's centre in world space. */
function pixelDirection(camera: PerspectiveCamera, x: number, y: number, size: number[]): Vector3 {
  const point = new Vector3(((x + 0.5) / size[0]) * 2 - 1, 1 - ((y + 0.5) / size[1]) * 2, 0.5)
  return point.unproject(camera).sub(camera.position).normalize()
}

gpuTest(
  'draws the limb from 400 km within 5 % of the march',
  async t => {
    const size = [4, 128]
    const renderer = await t.createRenderer({ width: size[0], height: size[1] })
    const parameters = new AtmosphereParameters()
    const radius = parameters.bottomRadius
    const atmosphere = new Atmosphere({ parameters, ellipsoid: new Ellipsoid(radius, radius) })
    await atmosphere.bake(renderer)
    const scene = airScene(atmosphere)
    const camera = new PerspectiveCamera(1.8, size[0] / size[1], 1, 1e8)
    camera.position.y = 4e5
    const tangent = Math.acos((radius + 30_000) / (radius + 4e5))
    camera.rotation.x = -tangent
    camera.updateMatrixWorld()
    for (const [elevation, azimuth] of [
      [60, 90],
      [20, 0],
      [20, 180],
      [5, 60]
    ] as const) {
      atmosphere.setSunAngles(elevation, azimuth)
      const picture = await drawForward(renderer, scene, camera, atmosphere)
      const profile = Array.from({ length: size[1] }, (_, y) => {
        const direction = pixelDirection(camera, 1, y, size)
        const lowest = (radius + 4e5) * Math.sqrt(1 - direction.y ** 2) - radius
        const expected = luminance(skyLuminanceAt(atmosphere, camera.position, direction))
        const got = luminance(picture.at(1, y)) / atmosphere.luminanceScale
        return { lowest, expected, got }
      }).filter(({ lowest }) => lowest > 0 && lowest < 60_000)
      expectTrue(profile.length > 80, `only ${profile.length} pixels see the limb`)
      const brightest = Math.max(...profile.map(({ expected }) => expected))
      const errors = profile.map(({ lowest, expected, got }) => ({
        lowest,
        relative: Math.abs(got / expected - 1),
        ofBrightest: Math.abs(got - expected) / brightest
      }))
      // In the uppermost 2 km the air ends abruptly, and what light is left is 0.5 % of the brightest.
      const limb = errors.filter(({ lowest }) => lowest < 58_000)
      const mean = limb.reduce((sum, { relative }) => sum + relative, 0) / limb.length
      const worst = Math.max(...limb.map(({ relative }) => relative))
      const top = Math.max(...errors.map(({ ofBrightest }) => ofBrightest))
      const label = `sun ${elevation}°, azimuth ${azimuth}°`
      const percent = (value: number): string => `${(100 * value).toFixed(2)} %`
      t.note(`${label}: mean ${percent(mean)}, worst ${percent(worst)}`)
      expectTrue(worst < 0.05, `${label}: ${percent(worst)} off`)
      expectTrue(top < 0.01, `${label}: ${percent(top)} of the brightest off`)
    }
    atmosphere.dispose()
  },
  // `atmosphere/light` holds the same shader to float64 on both.
  { backends: ['webgpu'] }
)

/** A sphere of equirectangular texels, one longitude lighter than the next. */
function stripes(width: number): DataTexture {
  const data = new Float32Array(4 * width)
  for (let i = 0; i < width; i++) data.fill(i % 2 === 0 ? 0.1 : 0.9, 4 * i, 4 * i + 4)
  const map = new DataTexture(data, width, 1, RGBAFormat, FloatType)
  map.minFilter = map.magFilter = NearestFilter
  map.wrapS = RepeatWrapping
  map.needsUpdate = true
  return map
}

gpuTest(
  'puts the ground where float64 does, from 2 m to 20,000 km',
  async t => {
    const size = [64, 36]
    const renderer = await t.createRenderer({ width: size[0], height: size[1] })
    const { a, b } = Ellipsoid.WGS84
    const parameters = airlessParameters({ radius: a })
    const atmosphere = new Atmosphere({ parameters, ellipsoid: new Ellipsoid(a, a, b) })
    const columns = 3600
    const map = stripes(columns)
    atmosphere.add(planetGround({ surface: map, roughness: 0 }))
    const scene = airScene(atmosphere)
    const camera = new PerspectiveCamera(40, size[0] / size[1], 1, 1e8)
    for (const height of [2, 100, 1e4, 4e5, 2e7]) {
      // An edge between two texels runs straight ahead.
      atmosphere.place({ longitude: 50, latitude: 40 }).setSunAngles(50, 120)
      camera.position.y = height
      camera.rotation.x = height < 1e6 ? -0.4 : -Math.PI / 2
      camera.updateMatrixWorld()
      const picture = await drawForward(renderer, scene, camera, atmosphere)
      const origin = camera.position.clone().applyMatrix4(atmosphere.worldToECEF)
      const light = new LightQuery('test', atmosphere, camera.position)
      const white = luminance(light.linearSRGB([1, 1, 1, 1])) / Math.PI
      let worst = 0
      let seen = 0
      for (let y = 0; y < size[1]; y++) {
        for (let x = 0; x < size[0]; x++) {
          const ray = pixelDirection(camera, x, y, size).transformDirection(atmosphere.worldToECEF)
          const distance = atmosphere.ellipsoid.intersectRayDistance(origin, ray)
          if (distance === null) continue
          seen++
          const hit = origin.clone().addScaledVector(ray, distance)
          const longitude = Math.atan2(hit.y, hit.x)
          const column = (longitude / (2 * Math.PI) + 0.5) * columns
          const cosLight = atmosphere.ellipsoid
            .surfaceNormal(hit)
            .dot(atmosphere.sunDirection.transformDirection(atmosphere.worldToECEF))
          if (cosLight < 0.05) continue
          const isLight = Math.floor(column) % 2 === 1
          const value = luminance(picture.at(x, y)) / cosLight
          const looksLight = value > 0.5 * white * atmosphere.luminanceScale
          if (looksLight === isLight) continue
          // How far from the edge between two texels, on the ground.
          const off = Math.abs(column - Math.round(column)) / columns
          worst = Math.max(worst, off * 2 * Math.PI * Math.hypot(hit.x, hit.y))
        }
      }
      t.note(`${height} m: ${worst.toFixed(2)} m`)
      expectTrue(seen > 300, `${height} m: only ${seen} pixels see the ground`)
      expectTrue(worst < 3 + 1e-6 * height, `${height} m: the ground is ${worst} m off`)
    }
    atmosphere.dispose()
    map.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'draws even ground as the model does',
  async t => {
    const renderer = await t.createRenderer({ width: 48, height: 27 })
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    const map = new DataTexture(new Float32Array([0.1, 0.1, 0.1, 1]), 1, 1, RGBAFormat, FloatType)
    map.needsUpdate = true
    const ground = planetGround({ surface: map, roughness: 0 })
    const camera = new PerspectiveCamera(60, 48 / 27, 1, 1e8)
    const pictures: Picture[][] = []
    for (const layer of [undefined, ground]) {
      if (layer !== undefined) atmosphere.add(layer)
      const scene = airScene(atmosphere)
      const row: Picture[] = []
      for (const height of [2, 3000, 4e5, 2e7]) {
        Ellipsoid.WGS84.geodeticToECEF({ longitude: 20, latitude: 50, height }, camera.position)
        camera.up.copy(camera.position).normalize()
        camera.lookAt(height > 1e6 ? new Vector3() : new Vector3(0, 0, -2e6))
        camera.updateMatrixWorld()
        atmosphere.sunDirection = new Vector3(1, 0.6, 0.5)
        row.push(await drawForward(renderer, scene, camera, atmosphere))
      }
      pictures.push(row)
    }
    pictures[0].forEach((picture, i) => {
      const differences = relativeDifferences(picture, pictures[1][i])
      const most = differences[Math.floor(0.99 * differences.length)]
      t.note(`view ${i}: ${most.toExponential(1)}`)
      expectTrue(most < 0.01, `view ${i}: 1 % of pixels differ by more than ${most}`)
    })
    atmosphere.dispose()
  },
  // The same numbers on both.
  { backends: ['webgpu'] }
)

gpuTest(
  'shows only light, and no hole, from random cameras, forward and as a post effect',
  async t => {
    const renderer = await t.createRenderer({ width: 48, height: 27 })
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    const map = stripes(64)
    atmosphere.add(planetGround({ nightLights: map }))
    // Scenes of their own, so that only the first case compiles.
    const [scene, bare] = [airScene(atmosphere), new Scene()]
    const camera = new PerspectiveCamera(60, 48 / 27, 1, 1e8)
    const next = random(7)
    const post = postPath(renderer, bare, camera, atmosphere)
    for (let i = 0; i < 10; i++) {
      const height = Math.exp(next() * Math.log(6.4e7))
      const place = { longitude: 360 * next() - 180, latitude: 180 * next() - 90, height }
      Ellipsoid.WGS84.geodeticToECEF(place, camera.position)
      camera.lookAt(2e7 * next() - 1e7, 2e7 * next() - 1e7, 2e7 * next() - 1e7)
      camera.updateMatrixWorld()
      atmosphere.sunDirection = new Vector3(next() - 0.5, next() - 0.5, next() - 0.5)
      const picture = await drawForward(renderer, scene, camera, atmosphere)
      expectLight(picture, `camera ${i}`)
      const differences = relativeDifferences(picture, await post.draw())
      expectTrue(
        differences[Math.floor(0.98 * differences.length)] < 0.01,
        `camera ${i}: post differs by ${differences.at(-1)}`
      )
    }
    post.dispose()
    for (const node of [scene.backgroundNode!, scene.fogNode!]) node.dispose()
    atmosphere.dispose()
    map.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'feeds the mean albedo of its ground to the air',
  async t => {
    const renderer = await t.createRenderer({ width: 32, height: 32 })
    const atmosphere = new Atmosphere()
    const half = new Float32Array(4 * 2 * 4).map((_, i) =>
      Math.floor(i / 4) % 2 === 0 ? 0.2 : 0.6
    )
    const map = new DataTexture(half, 2, 4, RGBAFormat, FloatType)
    map.minFilter = map.magFilter = NearestFilter
    map.needsUpdate = true
    const albedo = await planetGround({ surface: map }).meanAlbedo(renderer, atmosphere.parameters)
    expectClose(albedo, [0.4, 0.4, 0.4, 0.4], { relative: 5e-3 }, 'albedo')
    const made = await planetGround().meanAlbedo(renderer, atmosphere.parameters)
    t.note(`made up: ${made.map(value => value.toFixed(3)).join(', ')}`)
    made.forEach(value => expectTrue(value > 0.08 && value < 0.3, `made-up albedo is ${value}`))
    map.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'shows a body without air: black sky, sun, sunlit ground',
  async t => {
    const renderer = await t.createRenderer({ width: 64, height: 36 })
    // As large as in the test of the ground above, whose tables it takes.
    const parameters = airlessParameters({ radius: Ellipsoid.WGS84.a })
    const { bottomRadius } = parameters
    const ellipsoid = new Ellipsoid(bottomRadius, bottomRadius)
    const atmosphere = new Atmosphere({ parameters, ellipsoid }).setSunAngles(10, 0)
    const scene = new Scene()
    const ball = new Mesh(new SphereGeometry(1, 32, 16), new MeshLambertMaterial())
    ball.position.set(6, 0, -20)
    scene.add(ball, new SunDirectionalLight(atmosphere))
    const camera = new PerspectiveCamera(50, 64 / 36, 0.1, 1e6)
    camera.position.y = 2
    camera.rotation.x = 0.1
    camera.updateMatrixWorld()
    const picture = await drawForward(renderer, scene, camera, atmosphere)
    expectLight(picture, 'airless')
    expectTrue(luminance(picture.at(8, 4)) === 0, `the sky is ${picture.at(8, 4)}`)
    const brightest = Math.max(...picture.data)
    expectTrue(brightest > 1000, `the sun's disc is ${brightest}`)
    const reflected = parameters.groundAlbedo.map(
      albedo => (albedo * Math.sin(Math.PI / 18) * atmosphere.luminanceScale) / Math.PI
    )
    const expected = luminance(
      new LightQuery('test', atmosphere, camera.position).linearSRGB(reflected)
    )
    expectClose(luminance(picture.at(2, 34)), expected, { relative: 0.01 }, 'ground')
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'keeps two atmospheres in one scene apart',
  async t => {
    const size = { width: 48, height: 27 }
    const renderer = await t.createRenderer(size)
    const earth = new Atmosphere().setSunAngles(30, 40)
    // The test of Venus below takes its tables, too.
    const parameters = venusParameters()
    const { bottomRadius } = parameters
    const venus = new Atmosphere({
      parameters,
      ellipsoid: new Ellipsoid(bottomRadius, bottomRadius)
    })
    // A bright planet 20,000 km overhead.
    venus.worldToECEF.makeTranslation(0, -2e7, 1e7)
    venus.sunDirection = earth.sunDirection
    const camera = new PerspectiveCamera(70, 48 / 27, 1, 1e8)
    camera.position.y = 100
    camera.rotation.x = 0.9
    camera.updateMatrixWorld()
    const draw = (background: Node) => {
      const scene = new Scene()
      scene.backgroundNode = background
      return drawForward(renderer, scene, camera, earth)
    }
    const alone = [await draw(skyBackground(earth)), await draw(skyBackground(venus))]
    const [near, far] = [skyBackground(earth), skyBackground(venus)] as unknown as Node<'vec4'>[]
    const both = await draw(vec4(near.rgb.add(far.rgb), 1))
    const sum = alone[0].data.map((value, i) => (i % 4 < 3 ? value + alone[1].data[i] : 1))
    expectClose(both.data, sum, { relative: 1e-3, absolute: 1e-5 }, 'sum')
    const again = await draw(skyBackground(earth))
    expectTrue(relativeDifferences(alone[0], again).at(-1)! < 1e-4, 'the first sky has changed')
    const most = Math.max(...alone[1].data.filter((_, i) => i % 4 === 0))
    expectTrue(most > 0.05, `the planet is not to be seen: ${most}`)

    // One after the other in a scene, sky and haze.
    const wall = new Mesh(new PlaneGeometry(6e5, 6e5), new MeshLambertMaterial({ color: 0 }))
    wall.position.set(-3e5, 0, -4e5)
    const scene = new Scene().add(wall)
    await drawForward(renderer, scene, camera, earth)
    const second = await drawForward(renderer, scene, camera, venus)
    const afresh = await drawForward(renderer, new Scene().add(wall), camera, venus)
    expectTrue(relativeDifferences(second, afresh).at(-1)! < 1e-4, 'the first sky or haze stays')
    earth.dispose()
    venus.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'keeps up and the sky of a flat world wherever the camera goes',
  async t => {
    const renderer = await t.createRenderer({ width: 32, height: 18 })
    const atmosphere = new Atmosphere({ flat: true }).setSunAngles(5, 60)
    const scene = new Scene()
    const camera = new PerspectiveCamera(60, 32 / 18, 1, 1e7)
    const pictures = []
    for (const [x, z] of [
      [0, 0],
      [2e6, -5e6]
    ]) {
      camera.position.set(x, 50, z)
      camera.updateMatrixWorld()
      pictures.push(await drawForward(renderer, scene, camera, atmosphere))
    }
    expectTrue(relativeDifferences(pictures[0], pictures[1]).at(-1)! < 1e-4, 'the sky has changed')
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'draws only light on Venus, from the clouds to space',
  async t => {
    const renderer = await t.createRenderer({ width: 32, height: 18 })
    const parameters = venusParameters()
    const { bottomRadius } = parameters
    const ellipsoid = new Ellipsoid(bottomRadius, bottomRadius)
    const atmosphere = new Atmosphere({ parameters, ellipsoid })
    const camera = new PerspectiveCamera(60, 32 / 18, 1, 1e8)
    const scene = airScene(atmosphere)
    for (const height of [0, 2, 1e4, 1e5, 1e7]) {
      for (const sun of [90, -3]) {
        atmosphere.setSunAngles(sun, 30)
        camera.position.y = height
        camera.rotation.x = height > 1e6 ? -1.5 : -0.1
        camera.updateMatrixWorld()
        const picture = await drawForward(renderer, scene, camera, atmosphere)
        expectLight(picture, `${height} m, sun ${sun}°`)
      }
    }
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)
