import {
  Atmosphere,
  SkyLightProbe,
  SunDirectionalLight,
  aerialPerspective,
  aerialPerspectiveFog,
  skyBackground
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import {
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  MeshStandardMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { drawToFloat, random } from './harness/atmosphere'
import { gpuTest } from './harness/gpu-test'
import type { Picture } from './harness/picture'

const shape = Ellipsoid.WGS84

function globe(atmosphere: Atmosphere): Scene {
  const scene = new Scene()
  const mesh = new Mesh(
    new SphereGeometry(1, 128, 64).rotateX(Math.PI / 2),
    new MeshStandardMaterial({ color: 0x446688, roughness: 1 })
  )
  mesh.scale.copy(shape.radii)
  scene.add(mesh, new SunDirectionalLight(atmosphere), new SkyLightProbe(atmosphere))
  return scene
}

function dressed(scene: Scene, atmosphere: Atmosphere): Scene {
  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  return scene
}

function worstDifference(a: Picture, b: Picture, floor: number): number {
  return a.data.reduce(
    (worst, value, i) => Math.max(worst, Math.abs(value - b.data[i]) / (Math.abs(value) + floor)),
    0
  )
}

gpuTest(
  'random cameras see no NaN, no infinity and nothing below zero',
  async t => {
    const renderer = await t.createRenderer({ width: 64, height: 36 })
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    const forward = dressed(globe(atmosphere), atmosphere)
    const plain = globe(atmosphere)
    const camera = new PerspectiveCamera(60, 64 / 36, 1, 1e8)
    const scenePass = pass(plain, camera, { samples: 0 })
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = aerialPerspective(
      scenePass.getTextureNode(),
      scenePass.getTextureNode('depth'),
      camera,
      atmosphere
    )
    const seed = 20260621
    t.note(`seed ${seed}`)
    const next = random(seed)
    for (let round = 0; round < 24; round++) {
      const height = 10 ** (7.8 * next()) - 1
      const latitude = 180 * next() - 90
      shape.geodeticToECEF({ longitude: 360 * next() - 180, latitude, height }, camera.position)
      camera.lookAt(new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).multiplyScalar(1e9))
      camera.near = Math.max(0.5, height * 0.1)
      camera.far = 2e8
      camera.updateProjectionMatrix()
      camera.updateMatrixWorld()
      atmosphere.date = new Date(Date.UTC(2026, 0, 1) + next() * 3.15e10)
      for (const [path, render] of [
        ['forward', () => renderer.render(forward, camera)],
        ['post', () => pipeline.render()]
      ] as const) {
        const { data } = await drawToFloat(renderer, render)
        const wrong = data.findIndex(value => !(value >= 0 && value < 1e6))
        if (wrong >= 0) {
          throw new Error(`${path}, round ${round}, height ${height}: ${data[wrong]} at ${wrong}`)
        }
      }
    }
    pipeline.dispose()
    atmosphere.dispose()
  },
  { timeoutSeconds: 120 }
)

gpuTest(
  'nothing jumps on the way from 2 m to 20,000 km',
  async t => {
    const [width, height] = [48, 27]
    const renderer = await t.createRenderer({ width, height })
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    const scene = dressed(new Scene(), atmosphere)
    const camera = new PerspectiveCamera(60, width / height)
    const direction = new Vector3(0, 1, 0)
    // Directions from the horizon, so that it stays where it is in the picture.
    const steps = 60
    const changes: number[] = []
    let last: Picture | undefined
    for (let step = 0; step <= steps; step++) {
      const altitude = 2 * 1e7 ** (step / steps)
      camera.position.set(shape.a + altitude, 0, 0)
      const dip = Math.acos(shape.a / (shape.a + altitude))
      camera.up.set(1, 0, 0)
      direction.set(-Math.sin(dip), Math.cos(dip), 0).add(camera.position)
      camera.lookAt(direction)
      camera.updateMatrixWorld()
      atmosphere.sunDirection = new Vector3(0.5, 0.5, 0.7)
      const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
      if (last !== undefined) {
        const before = last.data
        const sum = picture.data.reduce((total, value) => total + value, 0)
        const change = picture.data.reduce((total, v, i) => total + Math.abs(v - before[i]), 0)
        changes.push(change / sum)
      }
      last = picture
    }
    // A jump is a step that both its neighbours' neighbours tower below.
    for (let i = 2; i < changes.length - 2; i++) {
      const around = Math.max(changes[i - 2], changes[i - 1], changes[i + 1], changes[i + 2])
      if (changes[i] > 2 * around + 0.01) {
        throw new Error(`step ${i}: ${changes[i]} amid ${changes.slice(i - 2, i + 3).join(', ')}`)
      }
    }
    t.note(`largest change of a step ${Math.max(...changes).toFixed(3)}`)
    atmosphere.dispose()
  },
  { timeoutSeconds: 120 }
)

gpuTest('moving the origin changes no pixel beyond float noise', async t => {
  const renderer = await t.createRenderer()
  const atmosphere = new Atmosphere()
  atmosphere.place({ longitude: 12, latitude: 47, height: 400 })
  atmosphere.setSunAngles(12, 200)
  const sunECEF = atmosphere.sunDirection.transformDirection(atmosphere.worldToECEF)
  const scene = dressed(new Scene(), atmosphere)
  const ball = new Mesh(
    new SphereGeometry(2000, 32, 16),
    new MeshStandardMaterial({ roughness: 1 })
  )
  const camera = new PerspectiveCamera(60, 320 / 180, 10, 1e6)
  scene.add(ball, new SunDirectionalLight(atmosphere), new SkyLightProbe(atmosphere))
  const original = atmosphere.worldToECEF.clone()
  const pictures: Picture[] = []
  for (const offset of [new Vector3(), new Vector3(25_000, 3000, -14_000)]) {
    atmosphere.worldToECEF.copy(original).multiply(new Matrix4().makeTranslation(offset))
    const toWorld = atmosphere.worldToECEF.clone().invert()
    atmosphere.sunDirection = sunECEF.clone().transformDirection(toWorld)
    ball.position.set(1000, 1500, -9000).sub(offset)
    camera.position.set(0, 1200, 0).sub(offset)
    camera.updateMatrixWorld()
    pictures.push(await t.render(renderer, scene, camera))
  }
  const worst = worstDifference(pictures[0], pictures[1], 1e-3)
  t.note(`largest relative difference ${worst.toExponential(1)}`)
  // Silhouettes of the ball may fall on the next pixel; the harness draws without multisampling.
  if (!(worst < 2e-3)) throw new Error(`pixels changed by ${worst}`)
  atmosphere.dispose()
})

for (const elevation of [50, 10, -3]) {
  gpuTest(`a white plane is as bright as the CPU says, sun at ${elevation}°`, async t => {
    const renderer = await t.createRenderer({ width: 16, height: 9 })
    const atmosphere = new Atmosphere()
    atmosphere.place({ longitude: 8, latitude: 50, height: 0 })
    atmosphere.setSunAngles(elevation, 130)
    atmosphere.luminanceScale = elevation > 0 ? 1e-4 : 1e-1
    const scene = new Scene()
    const plane = new Mesh(
      new PlaneGeometry(10, 10).rotateX(-Math.PI / 2),
      new MeshLambertMaterial({ color: 0xffffff })
    )
    scene.add(plane, new SunDirectionalLight(atmosphere), new SkyLightProbe(atmosphere))
    const camera = new PerspectiveCamera(40, 16 / 9, 0.1, 100)
    camera.position.set(0, 3, 0.01)
    camera.lookAt(0, 0, 0)
    camera.updateMatrixWorld()
    const picture = await t.render(renderer, scene, camera, { width: 16, height: 9 })
    await atmosphere.bake(renderer)
    const up = new Vector3(0, 1, 0)
    const sun = atmosphere.sunIlluminanceAt(new Vector3())
    const sky = atmosphere.skyIlluminanceAt(new Vector3(), up)
    const cosine = Math.max(atmosphere.sunDirection.y, 0)
    const expected = sun.map(
      (value, i) => ((value * cosine + sky[i]) / Math.PI) * atmosphere.luminanceScale
    )
    const luminance = (rgb: ArrayLike<number>): number =>
      0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]
    const ratio = luminance(picture.at(8, 4)) / luminance(expected)
    t.note(`${(100 * (ratio - 1)).toFixed(2)} %`)
    if (!(Math.abs(ratio - 1) < 0.01)) {
      throw new Error(`${picture.at(8, 4).slice(0, 3).join()} instead of ${expected.join()}`)
    }
    atmosphere.dispose()
  })
}

gpuTest('two cameras in a frame each see their own sky', async t => {
  const renderer = await t.createRenderer({ width: 64, height: 36 })
  const atmosphere = new Atmosphere()
  const scene = dressed(new Scene(), atmosphere)
  const cameras = [2, 30_000, 800_000].map(height => {
    const camera = new PerspectiveCamera(60, 64 / 36)
    camera.position.y = height
    camera.updateMatrixWorld()
    return camera
  })
  const look = async (i: number): Promise<Picture> =>
    drawToFloat(renderer, () => renderer.render(scene, cameras[i]))
  const alone = [await look(0), await look(1), await look(2)]
  const again = [await look(0), await look(1), await look(2)]
  alone.forEach((picture, i) => {
    const change = worstDifference(picture, again[i], 1e-6)
    // Another place in the atlas rounds otherwise.
    if (change > 1e-3) throw new Error(`camera ${i} changed by ${change}`)
  })
  if (worstDifference(alone[0], alone[1], 1e-3) < 0.1) throw new Error('both see the same')
  atmosphere.dispose()
})

gpuTest(
  'a hundred atmospheres come and go without a trace',
  async t => {
    const renderer = await t.createRenderer({ width: 16, height: 9 })
    const camera = new PerspectiveCamera(60, 16 / 9)
    const round = (): void => {
      const atmosphere = new Atmosphere()
      atmosphere.bakeStepsPerFrame = 1
      const scene = dressed(new Scene(), atmosphere)
      const sun = new SunDirectionalLight(atmosphere)
      const mesh = new Mesh(new PlaneGeometry(), new MeshBasicMaterial())
      scene.add(sun, mesh)
      renderer.render(scene, camera)
      const { backgroundNode } = scene
      atmosphere.dispose()
      sun.dispose()
      mesh.geometry.dispose()
      mesh.material.dispose()
      backgroundNode?.dispose()
    }
    round()
    const { textures, geometries, renderTargets } = renderer.info.memory as Record<string, number>
    const before = { textures, geometries, renderTargets }
    for (let i = 0; i < 100; i++) round()
    const after = renderer.info.memory as unknown as Record<string, number>
    for (const [name, value] of Object.entries(before)) {
      if (value !== undefined && after[name] > value) {
        throw new Error(`${name} grew from ${value} to ${after[name]}`)
      }
    }
    t.note(JSON.stringify(before))
  },
  { timeoutSeconds: 240 }
)
