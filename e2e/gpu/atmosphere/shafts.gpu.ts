import {
  aerialPerspective,
  Atmosphere,
  AtmosphereParameters,
  lightShafts,
  moon,
  MoonDirectionalLight,
  SunDirectionalLight,
  type LightShafts,
  type LightShaftsOptions,
  type SpectralMatrix
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import {
  BoxGeometry,
  FloatType,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3
} from 'three'
import { float, pass, vec3, vec4 } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { quantile } from '../../validate/score'
import { distanceToTop } from '../../../packages/atmosphere/src/air/cpu/boundary'
import {
  inScatter,
  type RayNumbers
} from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import {
  columnAt,
  lightRayAt,
  polarRay,
  type PolarFrame
} from '../../../packages/atmosphere/src/shafts/tsl/polarMap'
import { warpedSteps } from '../../../packages/atmosphere/src/shafts/tsl/warpedSteps'
import type { Float, Vec3 } from '../../../packages/atmosphere/src/tsl-types'
import { warpedDistance } from '../../../packages/atmosphere/test/twins/shafts/warpedSteps'
import { drawForward, drawToFloat, random } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { countCompilations, countObjects, nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'

const size = { width: 64, height: 36 }

/** Matrix to XYZ of which linear sRGB is the radiance at the first three wavelengths. */
const unmixed: SpectralMatrix = [
  [0.4124564 / 683, 0.3575761 / 683, 0.1804375 / 683, 0],
  [0.2126729 / 683, 0.7151522 / 683, 0.072175 / 683, 0],
  [0.0193339 / 683, 0.119192 / 683, 0.9503041 / 683, 0]
]

/** Air whose pictures have three wavelengths, per unit irradiance, on a sphere. */
const parameters = (): AtmosphereParameters =>
  new AtmosphereParameters({ spectralToXYZ: unmixed, solarIrradiance: [1, 1, 1, 1] })

interface Stage {
  scene: Scene
  camera: PerspectiveCamera
  atmosphere: Atmosphere
  light: SunDirectionalLight
  shafts: LightShafts
  pipeline: RenderPipeline
  /** The picture with shafts. */
  draw: () => Promise<Picture>
  dispose: () => void
}

/**
 * A scene with light shafts as a post effect; null for shafts draws the same without.
 *
 * @param elevation - Of the sun in the north, or of the full moon while the sun is down [°].
 */
function stage(
  renderer: WebGPURenderer,
  elevation: number,
  options: Omit<LightShaftsOptions, 'light'> | null = {},
  isMoonlit = false
): Stage {
  renderer.shadowMap.enabled = true
  const air = parameters()
  const ellipsoid = new Ellipsoid(air.bottomRadius)
  const atmosphere = new Atmosphere({ parameters: air, ellipsoid, luminanceScale: 1 })
  atmosphere.setSunAngles(elevation, 0)
  const scene = new Scene()
  let light = new SunDirectionalLight(atmosphere, 6000)
  if (isMoonlit) {
    const luna = moon({ direction: atmosphere.sunDirection })
    atmosphere.setSunAngles(-50, 180).add(luna)
    light = new MoonDirectionalLight(atmosphere, luna, 6000)
  }
  light.castShadow = true
  light.shadow.mapSize.setScalar(1024)
  Object.assign(light.shadow.camera, { left: -4000, right: 4000, bottom: -4000, top: 4000 })
  light.shadow.camera.far = 12_000
  // Always drawn and never seen: three draws shadow maps for what takes shadows.
  const receiver = new Mesh(new PlaneGeometry(0, 0), new MeshLambertMaterial())
  receiver.frustumCulled = false
  receiver.receiveShadow = true
  scene.add(light, light.target, receiver)
  const camera = new PerspectiveCamera(60, size.width / size.height, 1, 1e6)
  camera.position.y = 2
  const shafts = lightShafts(atmosphere, camera, { light, ...options })
  const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  const [color, depth] = [scenePass.getTextureNode(), scenePass.getTextureNode('depth')]
  const given = options === null ? {} : { shafts }
  pipeline.outputNode = aerialPerspective(color, depth, camera, atmosphere, given)
  return {
    scene,
    camera,
    atmosphere,
    light,
    shafts,
    pipeline,
    async draw() {
      camera.updateMatrixWorld()
      await nextFrame()
      return drawToFloat(renderer, () => pipeline.render())
    },
    dispose() {
      for (const owned of [scenePass, pipeline, shafts, light, atmosphere]) owned.dispose()
    }
  }
}

/** A box that casts shadows, by its middle and its edges [m]. */
function addBox(scene: Scene, middle: [number, number, number], edges: [number, number, number]) {
  const box = new Mesh(new BoxGeometry(...edges), new MeshLambertMaterial())
  box.position.set(...middle)
  box.castShadow = box.receiveShadow = true
  scene.add(box)
  return box
}

function expectSame(a: Picture, b: Picture, label: string): void {
  const differs = a.data.findIndex((value, i) => value !== b.data[i])
  expectTrue(differs < 0, `${label}: ${a.data[differs]} is not ${b.data[differs]} at ${differs}`)
}

gpuTest('leaves a scene without casters the same to the last bit', async t => {
  const renderer = await t.createRenderer(size)
  const plain = stage(renderer, 20, null)
  const without = await plain.draw()
  const shafted = stage(renderer, 20)
  const withShafts = await shafted.draw()
  expectSame(withShafts, without, 'no casters')
  addBox(shafted.scene, [0, 200, -600], [50, 500, 50])
  const tower = await shafted.draw()
  expectTrue(
    tower.data.some((value, i) => value < 0.99 * without.data[i]),
    'a tower makes a difference'
  )
  plain.dispose()
  shafted.dispose()
})

/** A ray of the stage's camera that looks at an angle above the horizon, in the north, where the sun is. */
function northward(elevation: number, sunElevation: number, altitude: number): RayNumbers {
  const [view, sun] = [elevation, sunElevation].map(angle => (angle * Math.PI) / 180)
  return {
    radius: parameters().bottomRadius + altitude,
    cosView: Math.sin(view),
    cosLight: Math.sin(sun),
    cosViewLight: Math.cos(view - sun)
  }
}

for (const isMoonlit of [false, true]) {
  const light = isMoonlit ? 'moonlight' : 'sunlight'
  gpuTest(
    `takes all ${light} scattered once from air behind a wall, and none before it`,
    async t => {
      const renderer = await t.createRenderer(size)
      const sunElevation = 12
      // The camera looks away from the sun, over a wall in its back, whose shadow ends in the air ahead.
      const options = { quality: 'reference' } as const
      const { scene, camera, draw, shafts, dispose } = stage(
        renderer,
        sunElevation,
        options,
        isMoonlit
      )
      const air = parameters()
      const [wall, height] = [300, 700]
      addBox(scene, [0, height / 2, -wall], [7000, height, 2])
      for (const viewElevation of [3, 25]) {
        const radians = (angle: number): number => (angle * Math.PI) / 180
        camera.fov = 1
        camera.updateProjectionMatrix()
        camera.lookAt(
          new Vector3(0, Math.sin(radians(viewElevation)), Math.cos(radians(viewElevation))).add(
            camera.position
          )
        )
        shafts.enabled = true
        const shadowed = await draw()
        shafts.enabled = false
        const lit = await draw()
        // The shadow's upper face falls from the wall's top; the ray rises from 2 m.
        const [fall, rise] = [sunElevation, viewElevation].map(angle => Math.tan(radians(angle)))
        const level = (height - 2 - wall * fall) / (rise + fall)
        const distance = level / Math.cos(radians(viewElevation))
        const ray = {
          ...northward(180 - viewElevation, sunElevation, 2),
          cosView: Math.sin(radians(viewElevation))
        }
        const expected = inScatter(air, null, ray, distance)
        const whole = inScatter(
          air,
          null,
          ray,
          distanceToTop(ray.radius, ray.cosView, air.topRadius)
        )
        const [x, y] = [size.width / 2, size.height / 2]
        const label = `view ${viewElevation}° up`
        for (let k = 0; k < 3; k++) {
          const irradiance = shafts.source.irradiance.value.getComponent(k)
          const lost = (lit.at(x, y)[k] - shadowed.at(x, y)[k]) / irradiance
          t.note(`${label}: ${((100 * (lost - expected[k])) / whole[k]).toFixed(3)} %`)
          expectClose(lost, expected[k], { absolute: 0.004 * whole[k] }, `${label}, channel ${k}`)
        }
      }
      dispose()
    }
  )
}

gpuTest(
  'draws the same with standard and reversed depth, and follows its caster in the same frame',
  async t => {
    const pictures: Picture[] = []
    for (const reversedDepthBuffer of [false, true]) {
      const renderer = await t.createRenderer({ ...size, reversedDepthBuffer })
      const { scene, draw, dispose } = stage(renderer, 15)
      const tower = addBox(scene, [-300, 200, -600], [40, 500, 40])
      const before = await draw()
      tower.position.x = 100
      const after = await draw()
      const fresh = stage(renderer, 15)
      addBox(fresh.scene, [100, 200, -600], [40, 500, 40])
      expectSame(after, await fresh.draw(), 'moved caster')
      expectTrue(
        before.data.some((value, i) => Math.abs(value - after.data[i]) > 0.01 * value),
        'the shadow moves'
      )
      pictures.push(after)
      dispose()
      fresh.dispose()
    }
    const [standard, reversed] = pictures
    const differences = standard.data
      .map((value, i) => Math.abs(value - reversed.data[i]) / (value + 1e-6))
      .toSorted()
    expectTrue(differences[Math.floor(0.99 * differences.length)] < 2e-3, 'reversed depth')
  }
)

gpuTest("reads three's cascades as it reads one map", async t => {
  const renderer = await t.createRenderer(size)
  const pictures: Picture[] = []
  for (const kind of ['map', 'cascades', 'lit']) {
    const { scene, light, draw, shafts, dispose } = stage(renderer, 15)
    addBox(scene, [-100, 200, -600], [60, 500, 60])
    if (kind === 'cascades') {
      const shadowNode = new CSMShadowNode(light, { cascades: 3, maxFar: 3000, lightMargin: 2000 })
      Object.assign(light.shadow, { shadowNode })
    }
    if (kind === 'lit') shafts.enabled = false
    // CSM draws the cascades of a frame where it has put them in the frame before.
    await draw()
    pictures.push(await draw())
    dispose()
  }
  const [map, cascades, lit] = pictures
  const apart = (a: Picture, b: Picture): number[] =>
    [...a.data].map((value, i) => Math.abs(value - b.data[i]) / (lit.data[i] + 1e-6))
  const [errors, shadows] = [apart(cascades, map), apart(map, lit)].map(all => quantile(all, 0.98))
  t.note(
    `98 % of pixels differ by less than ${errors.toFixed(4)}, by shadows ${shadows.toFixed(4)}`
  )
  expectTrue(shadows > 0.02, 'the tower casts a shadow')
  expectTrue(errors < 0.1 * shadows, 'cascades')
})

gpuTest(
  'has materials draw the air as the post effect does, in the frame in which casters move',
  async t => {
    const renderer = await t.createRenderer(size)
    const { scene, camera, draw, shafts, atmosphere, dispose } = stage(renderer, 15, {
      quality: 'reference'
    })
    const tower = addBox(scene, [-300, 200, -600], [500, 500, 60])
    tower.material.color.set(0)
    await draw()
    tower.position.x = -100
    const post = await draw()
    shafts.enabled = false
    const lit = await draw()
    shafts.enabled = true
    tower.position.x = -300
    atmosphere.add(shafts)
    const forward = async (): Promise<Picture> => {
      await nextFrame()
      return drawForward(renderer, scene, camera, atmosphere)
    }
    await forward()
    // The background is drawn first, and with shadows of this frame.
    tower.position.x = -100
    const moved = await forward()
    expectSame(await forward(), moved, 'a frame later')
    const apart = (a: Picture, b: Picture): number =>
      a.data.reduce((sum, value, i) => sum + Math.abs(value - b.data[i]), 0)
    const [errors, shadows] = [apart(moved, post), apart(post, lit)]
    const all = lit.data.reduce((sum, value) => sum + value, 0)
    t.note(
      `${(errors / shadows).toFixed(3)} of the lost light apart, of ${(shadows / all).toFixed(4)}`
    )
    expectTrue(shadows > 2e-4 * all, 'the tower casts a shadow')
    expectTrue(errors < 0.15 * shadows, 'forward')
    dispose()
  }
)

gpuTest(
  'changes strength, quality and being on without a compile, and frees what it made',
  async t => {
    const renderer = await t.createRenderer(size)
    const { scene, draw, shafts, dispose } = stage(renderer, 15)
    addBox(scene, [0, 200, -600], [200, 500, 40])
    const full = await draw()
    const compilations = countCompilations(renderer)
    shafts.set({ strength: 0.5, quality: 'low' })
    await draw()
    shafts.set({ strength: 1, quality: 'high' })
    expectSame(await draw(), full, 'back again')
    shafts.enabled = false
    const lit = await draw()
    shafts.set({ enabled: true, strength: 0.5 })
    const half = await draw()
    const [x, y] = [size.width / 2, 8]
    const [a, b, c] = [full, half, lit].map(picture => picture.at(x, y)[1])
    expectTrue(a < 0.99 * c, 'the tower casts a shadow')
    expectClose(b, (a + c) / 2, { relative: 1e-4 }, 'half the strength')
    expectTrue(
      Object.values(compilations).every(count => count === 0),
      'nothing is compiled'
    )
    dispose()
  }
)

gpuTest('spaces samples as the float64 twin does', async t => {
  const { bottomRadius } = parameters()
  const height = 8000
  const next = random(12)
  const rays = Array.from({ length: 64 }, () => [
    60_000 * next() ** 3,
    2 * next() - 1,
    10 ** (1 + 4.5 * next()),
    next()
  ])
  const uniforms = { bottomRadius: float(bottomRadius), homogeneousHeight: float(height) } as never
  const results = await t.evaluate(rays, ray => {
    const zero = float(0) as Float
    const steps = warpedSteps(
      uniforms,
      { altitude: ray.x, cosView: ray.y, cosLight: zero, cosViewLight: zero },
      ray.z
    )
    return vec4(
      steps.distance(ray.w),
      steps.slope(ray.w),
      steps.distance(float(0)),
      steps.distance(float(1))
    )
  })
  rays.forEach(([altitude, cosView, length, part], i) => {
    const at = (x: number): number =>
      warpedDistance(bottomRadius + altitude, cosView, height, length, x)
    const [distance, slope, first, last] = results.subarray(4 * i, 4 * i + 4)
    const label = `ray ${rays[i].join(' ')}`
    expectClose(distance, at(part), { absolute: 2e-5 * length }, label)
    const step = 1e-5
    const [from, to] = [Math.max(part - step, 0), Math.min(part + step, 1)]
    expectClose(slope, (at(to) - at(from)) / (to - from), { relative: 2e-3 }, `${label}, slope`)
    expectClose(first, 0, { absolute: 2e-5 * length }, `${label}, first`)
    expectClose(last, length, { absolute: 2e-5 * length }, `${label}, last`)
  })
})

gpuTest('has a view ray in the row of the rays of light that it crosses', async t => {
  const columns = 512
  const [even, greatest] = [30, 30_000]
  const logScale = 1 / Math.log1p(greatest / even)
  const light = new Vector3(0.3, 0.5, -0.6).normalize()
  const across = new Vector3(0, 1, 0).cross(light).normalize()
  const along = light.clone().cross(across)
  const vector = ({ x, y, z }: Vector3): Vec3 => vec3(x, y, z)
  const frame: PolarFrame = {
    across: vector(across),
    along: vector(along),
    evenDistance: float(even),
    logScale: float(logScale),
    logOffset: float(0),
    columns: float(columns)
  }
  const next = random(5)
  const texels = Array.from({ length: 32 }, () => [next(), next(), 1e4 * (2 * next() - 1)])
  // From a texel's ray of light to a point of it, and back.
  const results = await t.evaluate(texels, texel => {
    const { offset, distance } = lightRayAt(frame, texel.xy)
    const point = offset.add(vector(light).mul(texel.z)).toConst() as Vec3
    const direction = point.normalize().toConst() as Vec3
    const polar = polarRay(frame, direction, direction.dot(vector(light)))
    const column = columnAt(frame, distance)
    const crossing = polar.sinViewLight.mul(point.length()).div(distance)
    return vec4(column, polar.row.fract(), polar.angle, crossing)
  })
  texels.forEach(([u, v, z], i) => {
    const [column, row, angle, crossing] = results.subarray(4 * i, 4 * i + 4)
    const position = Math.max((u * columns - 0.5) / (columns - 1), 0)
    const distance = Math.max(even * Math.expm1(position / logScale), 1e-3 * even)
    const turn = (row - v + 1.5) % 1
    expectClose(column, u, { absolute: 2e-5 }, 'column')
    // Near the line to the light float32 has few directions.
    const blur = 3e-7 * (1 + Math.abs(z) / distance)
    expectClose(turn, 0.5, { absolute: 2e-5 + blur }, 'row')
    // WGSL asks 4096 units in the last place of atan2, and software gives no more.
    expectClose(angle, -Math.atan2(z, distance), { absolute: 1e-4 }, 'angle')
    // Of sine and cosine it asks 2⁻¹¹.
    expectClose(
      crossing,
      1,
      { absolute: 2 ** -11 + 4 * blur },
      'distance from the line to the light'
    )
  })
})

gpuTest('frees its textures', async t => {
  const renderer = await t.createRenderer(size)
  const { scene, draw, shafts, dispose } = stage(renderer, 15)
  addBox(scene, [0, 200, -600], [200, 500, 40])
  shafts.enabled = false
  await draw()
  const objects = countObjects(renderer)
  shafts.enabled = true
  const first = await draw()
  expectTrue((objects.Texture ?? 0) > 0, 'shafts have textures')
  const held = objects.Texture
  shafts.dispose()
  expectTrue(objects.Texture < held, `${held} textures, ${objects.Texture} after dispose`)
  expectSame(await draw(), first, 'used again')
  dispose()
})
