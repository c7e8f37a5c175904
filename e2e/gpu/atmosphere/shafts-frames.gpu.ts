import {
  aerialPerspective,
  Atmosphere,
  AtmosphereParameters,
  AtmosphereShell,
  forwardShafts,
  SunDirectionalLight,
  type AirOccluder
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import {
  FloatType,
  Matrix4,
  OrthographicCamera,
  PerspectiveCamera,
  Quaternion,
  Scene,
  Vector3
} from 'three'
import { SunLight } from 'three/addons/lights/SunLight.js'
import { SunLightNode } from 'three/addons/lights/SunLightNode.js'
import { float, pass, vec3 } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { quantile } from '../../validate/score'
import { drawToFloat } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { cameraAt, VIEWS } from '../harness/shell'
import {
  addBox,
  addTowers,
  expectSame,
  secondCamera,
  stage,
  stageSize as size
} from '../harness/shaft-stage'

const apart = (a: Picture, b: Picture): number =>
  a.data.reduce((sum, value, i) => sum + Math.abs(value - b.data[i]), 0)

gpuTest(
  'has the same shafts in world units of a kilometre and in ECEF axes',
  async t => {
    // Vertices of the planet's size are none of three's, but by this.
    const renderer = await t.createRenderer(size)
    renderer.highPrecision = true
    const drawIn = async (frame: 'metres' | 'kilometres' | 'ECEF'): Promise<Picture[]> => {
      const set = stage(renderer, 15)
      const { atmosphere, camera, light, shafts } = set
      const before = atmosphere.worldToECEF.clone()
      if (frame === 'kilometres') atmosphere.metersPerUnit = 1000
      if (frame === 'ECEF') {
        atmosphere.worldToECEF.identity()
        atmosphere.sunDirection = atmosphere.sunDirection.clone().transformDirection(before)
      }
      const matrix = atmosphere.worldToECEF.clone().invert().multiply(before)
      const units = matrix.getMaxScaleOnAxis()
      addTowers(set, matrix)
      const [position, turn] = [camera.position.clone().applyMatrix4(matrix), new Quaternion()]
      matrix.decompose(light.target.position, turn, new Vector3())
      camera.position.copy(position)
      camera.quaternion.premultiply(turn)
      camera.near *= units
      camera.far *= units
      camera.updateProjectionMatrix()
      light.distance = 6000 * units
      const { camera: lens } = light.shadow
      for (const side of ['left', 'right', 'bottom', 'top', 'near', 'far'] as const)
        lens[side] *= units
      lens.updateProjectionMatrix()
      await set.draw()
      const shadowed = await set.draw()
      shafts.enabled = false
      const lit = await set.draw()
      set.dispose()
      return [shadowed, lit]
    }
    const [expected, lit] = await drawIn('metres')
    const shadows = apart(lit, expected)
    expectTrue(
      shadows > 2e-4 * lit.data.reduce((sum, value) => sum + value, 0),
      'towers cast shadows'
    )
    for (const frame of ['kilometres', 'ECEF'] as const) {
      const [picture, litThere] = await drawIn(frame)
      const error = Math.abs(apart(litThere, picture) / shadows - 1)
      const difference = Math.abs(apart(picture, expected) - apart(litThere, lit)) / shadows
      t.note(
        `${frame}: shafts ${(100 * error).toFixed(2)} % and ${(100 * difference).toFixed(2)} % apart`
      )
      expectTrue(error < 0.02, `${frame}: as much light is lost`)
      expectTrue(difference < 0.05, `${frame}: where it is lost`)
    }
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'has the same shafts when the origin of the world moves',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    const { atmosphere, camera, light } = set
    addTowers(set, new Matrix4())
    await set.draw()
    const before = await set.draw()
    set.shafts.enabled = false
    const lit = await set.draw()
    set.shafts.enabled = true
    const step = new Vector3(3000, -20, 1500)
    atmosphere.worldToECEF.multiply(new Matrix4().makeTranslation(step))
    for (const { position } of [camera, light.target, set.scene.children.at(-1)!])
      position.sub(step)
    const after = await set.draw()
    const error = apart(before, after) / apart(before, lit)
    t.note(`${(100 * error).toFixed(2)} % of the shafts apart`)
    expectTrue(error < 0.02, `${error} of the shafts apart`)
    set.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  "reads the cascades of three's SunLight as it reads one map",
  async t => {
    const renderer = await t.createRenderer(size)
    SunLight.registerNode(SunLightNode)
    const set = stage(renderer, 15)
    // As fine as cascades: edges of coarser texels are elsewhere.
    set.light.shadow.mapSize.setScalar(2048)
    const tower = addBox(set.scene, [-100, 200, -600], [150, 500, 60])
    // Not seen itself: its own front is where shadow maps of other texels differ.
    Object.assign(tower.material, { colorWrite: false, depthWrite: false })
    await set.draw()
    const map = await set.draw()
    set.shafts.enabled = false
    const lit = await set.draw()
    const light = new SunLight()
    light.position.copy(set.atmosphere.sunDirection)
    light.castShadow = true
    light.shadow.mapSize.setScalar(2048)
    light.shadow.camera.far = 3000
    set.scene.remove(set.light).add(light)
    const { pipeline, dispose } = secondCamera(
      { ...set, light: light as never },
      renderer,
      set.camera
    )
    let cascades = map
    for (let i = 0; i < 2; i++) {
      await nextFrame()
      cascades = await drawToFloat(renderer, () => pipeline.render())
    }
    const relative = (a: Picture, b: Picture): number =>
      quantile(
        [...a.data].map((value, i) => Math.abs(value - b.data[i]) / (lit.data[i] + 1e-6)),
        0.98
      )
    const [errors, shadows] = [relative(cascades, map), relative(map, lit)]
    t.note(
      `98 % of pixels differ by less than ${errors.toFixed(4)}, by shadows ${shadows.toFixed(4)}`
    )
    expectTrue(shadows > 0.02, 'the tower casts a shadow')
    expectTrue(errors < 0.03 * shadows, 'cascades')
    dispose()
    light.dispose()
    set.dispose()
  },
  // `shafts-maps` reads cascades' shadows of surfaces on both.
  { backends: ['webgpu'] }
)

gpuTest(
  'draws two cameras in a frame as it draws each alone',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    addTowers(set, new Matrix4())
    const camera = set.camera.clone()
    camera.position.set(-200, 60, 100)
    camera.lookAt(0, 300, -600)
    camera.updateMatrixWorld()
    set.camera.updateMatrixWorld()
    const other = secondCamera(set, renderer, camera)
    const pipelines = [set.pipeline, other.pipeline]
    const alone: Picture[] = []
    for (const pipeline of pipelines) {
      for (let i = 0; i < 2; i++) {
        await nextFrame()
        alone[pipelines.indexOf(pipeline)] = await drawToFloat(renderer, () => pipeline.render())
      }
    }
    expectTrue(apart(alone[0], alone[1]) > 0, 'the cameras see something else')
    for (let i = 0; i < 2; i++) {
      await nextFrame()
      for (const [k, pipeline] of pipelines.entries()) {
        expectSame(await drawToFloat(renderer, () => pipeline.render()), alone[k], `camera ${k}`)
      }
    }
    other.dispose()
    set.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'takes from the air of a shell what it takes from the sky',
  async t => {
    const renderer = await t.createRenderer(size)
    // Black ground, which a shell has none of.
    const air = new AtmosphereParameters({ groundAlbedo: [0, 0, 0, 0] })
    const ellipsoid = new Ellipsoid(air.bottomRadius)
    const atmosphere = new Atmosphere({ parameters: air, ellipsoid })
    atmosphere.worldToECEF.identity()
    atmosphere.sunDirection = new Vector3(0.5, 0.6, 0.4)
    const light = new SunDirectionalLight(atmosphere)
    const occluder: AirOccluder = {
      castInto: () => ({
        transmittance: () => place => place.positionWorld().x.greaterThan(0).select(0, 1)
      })
    }
    const camera = new PerspectiveCamera()
    const shafts = forwardShafts(atmosphere, camera, light).add(occluder)
    const scenePass = pass(new Scene(), camera, { samples: 0, type: FloatType })
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    const [color, depth] = [scenePass.getTextureNode(), scenePass.getTextureNode('depth')]
    const options = { shafts, showSun: false }
    pipeline.outputNode = aerialPerspective(color, depth, camera, atmosphere, options)
    const [plain, shaded] = [{}, { shafts }].map(
      given => new AtmosphereShell(air, air.bottomRadius, { sun: atmosphere, ...given })
    )
    const scenes = [shaded, plain].map(shell => new Scene().add(shell))
    const draws = [
      () => pipeline.render(),
      ...scenes.map(scene => () => renderer.render(scene, camera))
    ]
    // Outside the air, close to it, and in it.
    for (const [distance, pitch] of VIEWS) {
      camera.copy(cameraAt(distance, air.bottomRadius, pitch))
      camera.updateMatrixWorld()
      shafts.enabled = true
      const drawAll = async (): Promise<Picture[]> => {
        const pictures: Picture[] = []
        await nextFrame()
        for (const draw of draws) pictures.push(await drawToFloat(renderer, draw))
        return pictures
      }
      await drawAll()
      const shadowed = await drawAll()
      shafts.enabled = false
      const lit = await drawAll()
      expectSame(lit[1], lit[2], 'without shadows')
      expectSame(shadowed[2], lit[2], 'without shafts')
      const lost = [0, 1].map(i =>
        lit[i].data.map((value, k) => (k % 4 < 3 ? value - shadowed[i].data[k] : 0))
      )
      const total = lost[0].reduce((sum, value) => sum + value, 0)
      const error = lost[0].reduce((sum, value, k) => sum + Math.abs(value - lost[1][k]), 0) / total
      const part = total / lit[0].data.reduce((sum, value, k) => sum + (k % 4 < 3 ? value : 0), 0)
      t.note(
        `${distance} radii: ${(100 * part).toFixed(1)} % is lost, ${(100 * error).toFixed(2)} % of it apart`
      )
      expectTrue(part > 0.1, `${distance} radii: light is lost`)
      expectTrue(error < 0.01, `${distance} radii: ${error} of it apart`)
    }
    for (const owned of [plain, shaded, shafts, pipeline, scenePass]) owned.dispose()
    light.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'takes light from the air of a shell along the parallel rays of an orthographic camera',
  async t => {
    const renderer = await t.createRenderer(size)
    const air = new AtmosphereParameters({ groundAlbedo: [0, 0, 0, 0] })
    const { bottomRadius: radius } = air
    const atmosphere = new Atmosphere({ parameters: air, ellipsoid: new Ellipsoid(radius) })
    atmosphere.worldToECEF.identity()
    atmosphere.sunDirection = new Vector3(0.3, 0.6, 0.6)
    const light = new SunDirectionalLight(atmosphere)
    // 400 km across, from 500 km up, obliquely down.
    const half = 200_000
    const camera = new OrthographicCamera(-half, half, (half * 9) / 16, (-half * 9) / 16, 1e4, 1e7)
    camera.position.set(0, 0, radius + 500_000)
    camera.rotation.x = 0.6
    camera.updateMatrixWorld()
    const shafts = forwardShafts(atmosphere, camera, light)
    const shell = new AtmosphereShell(air, radius, { shafts })
    const scene = new Scene().add(shell)
    const draw = async (occluder?: AirOccluder): Promise<Picture> => {
      if (occluder !== undefined) shafts.add(occluder)
      let picture: Picture | undefined
      for (let i = 0; i < 2; i++) {
        await nextFrame()
        picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
      }
      if (occluder !== undefined) shafts.remove(occluder)
      return picture!
    }
    const plane = (normal: Vector3, from: number, isFlipped = false): AirOccluder => ({
      castInto: () => ({
        transmittance: () => place => {
          const isAbove = place.positionWorld().dot(vec3(normal)).greaterThan(from)
          return isAbove.select(isFlipped ? 1 : 0, isFlipped ? 0 : 1)
        }
      })
    })
    const lit = await draw()
    const dark = await draw({ castInto: () => ({ transmittance: () => () => float(0) }) })
    // A wall along the rays: each pixel is on one side of it, as no ray from the camera's own place would be.
    const wall = 80_000
    const walled = await draw(plane(new Vector3(1, 0, 0), wall))
    let places = 0
    for (let y = 0; y < size.height; y += 5) {
      for (let x = 0; x < size.width; x++) {
        const east = ((x + 0.5) / size.width - 0.5) * 2 * half
        if (Math.abs(east - wall) < half / size.width) continue
        const [all, none, here] = [lit, dark, walled].map(picture => picture.at(x, y)[1])
        expectTrue(none < 0.95 * all && none > 0, `${x}, ${y}: ${none} of ${all}`)
        expectClose(here, east > wall ? none : all, { relative: 1e-4 }, `${x}, ${y}`)
        places++
      }
    }
    // What a plane among the air and its other side take is all that there is to take.
    const normal = new Vector3(0.02, Math.sin(0.054), Math.cos(0.054))
    const from = radius + 4000
    const [above, below] = [await draw(plane(normal, from)), await draw(plane(normal, from, true))]
    const lost = [dark, above, below].map(picture => apart(lit, picture))
    t.note(
      `${places} places; ${lost.map(sum => (sum / lost[0]).toFixed(4)).join(', ')} of the light`
    )
    expectTrue(Math.min(lost[1], lost[2]) > 0.1 * lost[0], 'both sides take light')
    expectClose(lost[1] + lost[2], lost[0], { relative: 0.01 }, 'both sides')
    shafts.enabled = false
    expectSame(await draw(), lit, 'without shadows')
    for (const owned of [shell, shafts, light, atmosphere]) owned.dispose()
  },
  // The looks of shafts in the sky, which WebGL draws, too.
  { backends: ['webgpu'] }
)
