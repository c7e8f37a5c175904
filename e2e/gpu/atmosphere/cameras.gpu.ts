import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import { Ellipsoid, fitGlobeCamera } from '@welkin/geo'
import type { DepthKind } from '@welkin/geo'
import {
  Mesh,
  MeshBasicMaterial,
  MeshStandardMaterial,
  OrthographicCamera,
  PerspectiveCamera,
  Scene,
  SphereGeometry,
  Vector3,
  type Camera
} from 'three'
import {
  airScene,
  drawForward,
  expectLight,
  postPath,
  random,
  relativeDifferences
} from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const size = { width: 64, height: 36 }
const seed = 20260621

/** A globe a little inside of the ellipsoid, so that cameras on the ground are outside of it. */
function globe(material: MeshBasicMaterial | MeshStandardMaterial): Mesh {
  const mesh = new Mesh(new SphereGeometry(1, 128, 64), material)
  mesh.scale.copy(Ellipsoid.WGS84.radii).subScalar(10)
  return mesh
}

/** Sun and sky. */
function lights(atmosphere: Atmosphere): [SunDirectionalLight, SkyLightProbe] {
  return [new SunDirectionalLight(atmosphere), new SkyLightProbe(atmosphere)]
}

function direction(next: () => number): Vector3 {
  const z = 2 * next() - 1
  const angle = 2 * Math.PI * next()
  return new Vector3(Math.cos(angle), Math.sin(angle), 0)
    .multiplyScalar(Math.sqrt(1 - z * z))
    .setZ(z)
}

gpuTest(
  'draws only light for random cameras, forward and as a post effect',
  async t => {
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    const scene = new Scene()
    scene.add(globe(new MeshStandardMaterial({ color: 0x446688, roughness: 1 })))
    scene.add(...lights(atmosphere))
    const camera = new PerspectiveCamera(60, 64 / 36)
    const post = postPath(renderer, scene, camera, atmosphere)
    const forward = airScene(atmosphere)
    const next = random(seed)
    t.note(`seed ${seed}`)
    for (let i = 0; i < 8; i++) {
      const height = Math.exp(next() * Math.log(6.4e7))
      const place = { longitude: 360 * next() - 180, latitude: 180 * next() - 90, height }
      Ellipsoid.WGS84.geodeticToECEF(place, camera.position)
      camera.up.copy(direction(next))
      camera.lookAt(camera.position.clone().add(direction(next)))
      camera.updateMatrixWorld()
      fitGlobeCamera(camera)
      camera.updateProjectionMatrix()
      atmosphere.date = new Date(1.7e12 + Math.floor(next() * 1e11))
      const label = `camera ${i} at ${height.toFixed(1)} m, seed ${seed}`
      forward.add(...scene.children)
      expectLight(await drawForward(renderer, forward, camera, atmosphere), `${label}, forward`)
      scene.add(...forward.children)
      expectLight(await post.draw(), `${label}, post`)
    }
    post.dispose()
    atmosphere.dispose()
  },
  // WebGL draws the globe in the picture of its imagery, and these paths in the tests below.
  { backends: ['webgpu'] }
)

function cameraOver(height: number, isOrthographic: boolean, depth: DepthKind): Camera {
  const camera = isOrthographic
    ? new OrthographicCamera(-0.9 * height, 0.9 * height, 0.5 * height, -0.5 * height)
    : new PerspectiveCamera(50, 64 / 36)
  Ellipsoid.WGS84.geodeticToECEF({ longitude: 10, latitude: 40, height }, camera.position)
  camera.up.set(0, 0, 1)
  // Between straight down and the horizon.
  const down = camera.position.clone().negate().normalize()
  const north = new Vector3(0, 0, 1)
  camera.lookAt(camera.position.clone().addScaledVector(down, 1).addScaledVector(north, 0.25))
  camera.updateMatrixWorld()
  fitGlobeCamera(camera, { depth: isOrthographic && depth === 'logarithmic' ? 'standard' : depth })
  camera.updateProjectionMatrix()
  return camera
}

for (const depth of ['standard', 'reversed', 'logarithmic'] as const) {
  gpuTest(`draws the same forward and as a post effect with ${depth} depth`, async t => {
    const renderer = await t.createRenderer({
      ...size,
      reversedDepthBuffer: depth === 'reversed',
      logarithmicDepthBuffer: depth === 'logarithmic'
    })
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    atmosphere.sunDirection = new Vector3(1, 0.5, 0.5)
    const scene = new Scene()
    scene.add(globe(new MeshBasicMaterial({ color: 0x808080 })))
    for (const isOrthographic of [false, true]) {
      // Not 20,000 km: a pixel of so small a picture spans 500 km there, and the 1/256 of it that
      // rasterizers round vertices to moves the depth by more than the air is high.
      for (const height of t.backend === 'webgpu' ? [20_000, 4e5, 2e6] : [4e5]) {
        const camera = cameraOver(height, isOrthographic, depth)
        const forward = await drawForward(renderer, scene, camera, atmosphere)
        const post = postPath(renderer, scene, camera, atmosphere)
        const differences = relativeDifferences(forward, await post.draw())
        post.dispose()
        // The last pixels are the globe's edge, and those next to it.
        const most = differences[Math.floor(0.99 * differences.length)]
        const kind = isOrthographic ? 'orthographic' : 'perspective'
        t.note(`${kind} ${height}: ${most.toExponential(1)}`)
        expectTrue(most < 0.01, `${kind}, ${height} m: 1 % of pixels differ by more than ${most}`)
      }
    }
    atmosphere.dispose()
  })
}

gpuTest(
  'has no seam or jump on the way from 2 m to 20,000 km',
  async t => {
    const renderer = await t.createRenderer({ width: 48, height: 27 })
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    atmosphere.sunDirection = new Vector3(0.5, 0.5, 0.7)
    const scene = airScene(atmosphere)
    const camera = new PerspectiveCamera(60, 48 / 27, 0.1, 1e8)
    camera.up.set(1, 0, 0)
    const steps: number[] = []
    const heights: number[] = []
    let before
    for (let i = 0; i <= 28; i++) {
      const height = 2 * 1e7 ** (i / 28)
      // Down to the horizon, so that it stays where it is in the picture.
      const dip = Math.acos(Ellipsoid.WGS84.a / (Ellipsoid.WGS84.a + height))
      camera.position.set(Ellipsoid.WGS84.a + height, 0, 0)
      camera.lookAt(new Vector3(-Math.sin(dip), Math.cos(dip), 0).add(camera.position))
      camera.updateMatrixWorld()
      const picture = await drawForward(renderer, scene, camera, atmosphere)
      if (before !== undefined) {
        const differences = relativeDifferences(before, picture)
        steps.push(differences.reduce((sum, value) => sum + value, 0) / differences.length)
        heights.push(height)
      }
      before = picture
    }
    t.note(`largest step ${Math.max(...steps).toFixed(3)}`)
    steps.forEach((step, i) => {
      const beside = Math.max(steps[i - 1] ?? 0, steps[i + 1] ?? 0)
      expectTrue(
        step < 2 * beside + 0.005,
        `the step to ${heights[i].toFixed(0)} m changes ${step}, those beside it ${beside}`
      )
    })
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'keeps each of two cameras its own sky',
  async t => {
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere()
    const scene = airScene(atmosphere)
    const [low, high, higher] = [2, 40_000, 2e6].map(height => {
      const camera = new PerspectiveCamera(60, 64 / 36, 1, 1e7)
      camera.position.y = height
      camera.updateMatrixWorld()
      return camera
    })
    const draw = (camera: Camera) => drawForward(renderer, scene, camera, atmosphere)
    const first = [await draw(low), await draw(high), await draw(higher)]
    const again = [await draw(low), await draw(high), await draw(higher)]
    first.forEach((picture, i) => {
      const change = relativeDifferences(picture, again[i]).at(-1)!
      expectTrue(change < 1e-4, `camera ${i} sees another sky: ${change}`)
      const other = relativeDifferences(picture, first[(i + 1) % 3]).at(-1)!
      expectTrue(other > 0.1, `camera ${i} sees the sky of another`)
    })
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

for (const kind of ['floating origin', 'unit'] as const) {
  gpuTest(`changes no pixel with the ${kind}`, async t => {
    const renderer = await t.createRenderer(size)
    const scene = new Scene()
    const mesh = new Mesh(new SphereGeometry(1, 32, 16), new MeshStandardMaterial({ roughness: 1 }))
    const camera = new PerspectiveCamera(60, 64 / 36, 10, 1e6)
    const draw = (atmosphere: Atmosphere, origin: Vector3, unit: number) => {
      camera.position.set(300, 1500, -200).sub(origin).divideScalar(unit)
      camera.near = 10 / unit
      camera.far = 1e6 / unit
      camera.updateProjectionMatrix()
      mesh.position.set(2000, 1000, -9000).sub(origin).divideScalar(unit)
      mesh.scale.setScalar(2500 / unit)
      return drawForward(renderer, scene, camera, atmosphere)
    }
    const atmosphere = new Atmosphere().place({ longitude: 10, latitude: 40 })
    scene.add(mesh, ...lights(atmosphere))
    atmosphere.date = new Date('2026-06-21T15:00:00Z')
    const before = await draw(atmosphere, new Vector3(), 1)
    const origin = kind === 'unit' ? new Vector3() : new Vector3(30_000.3, -500.7, 12_345.1)
    const unit = kind === 'unit' ? 1000 : 1
    if (kind === 'unit') atmosphere.metersPerUnit = unit
    else {
      const shifted = origin.clone().applyMatrix4(atmosphere.worldToECEF)
      atmosphere.worldToECEF.setPosition(shifted)
    }
    const after = await draw(atmosphere, origin, unit)
    const differences = relativeDifferences(before, after)
    t.note(`worst ${differences.at(-1)!.toExponential(1)}`)
    // A pixel or two of the silhouette may fall on its other side.
    expectTrue(differences.at(-4)! < 1e-3, `pixels differ by ${differences.at(-4)}`)
    atmosphere.dispose()
  })
}
