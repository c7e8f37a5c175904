import {
  Atmosphere,
  SkyLightProbe,
  SunDirectionalLight,
  sunIlluminanceAt,
  surfaceLighting
} from '@welkin/atmosphere'
import { CloudLayers, cloudShadow } from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import {
  BoxGeometry,
  Color,
  DataTexture,
  FloatType,
  Group,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  PointLight,
  RedFormat,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import { Fn, mrt, normalView, output, pass, texture, vec2, vec4 } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { depthNormal } from '../../../packages/atmosphere/src/lights/tsl/depthNormal'
import { DepthRays } from '../../../packages/atmosphere/src/view/DepthRays'
import {
  depthNormal as twin,
  rayOf,
  type DepthPicture
} from '../../../packages/atmosphere/test/twins/lights/depthNormal'
import { depthToSun } from '../../../packages/clouds/test/twins/cloudShafts'
import { drawToFloat, expectLight, relativeDifferences } from '../harness/atmosphere'
import { radians, unseenClouds } from '../harness/cloud-shafts'
import { fog, SparseNoise } from '../harness/cloud-view'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest, takeFineShadows } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'

takeFineShadows()

const size = { width: 128, height: 72 }

gpuTest('depthNormal agrees with its float64 twin', async t => {
  const camera = new PerspectiveCamera(60, 16 / 9, 1, 100)
  camera.updateProjectionMatrix()
  const tangent = Math.tan(Math.PI / 6)
  /** A roof before a wall: edges between planes, and a step. */
  const roof: DepthPicture = {
    width: 16,
    height: 9,
    tangent,
    distanceAt(column, row) {
      const { x, y } = rayOf(this, column, row)
      if (row < 4) return 40 / (1 + 0.2 * x)
      return column < 8 ? 10 / (1 + 0.7 * x + 0.3 * y) : 10 / (1 - 0.4 * x - 0.5 * y)
    }
  }
  const pixels = Array.from({ length: 16 * 9 }, (_, i) => [i % 16, Math.floor(i / 16)])
  // Standard depth of WebGL and WebGPU alike, in [0, 1].
  const depths = pixels.map(([x, y]) => (100 / 99) * (1 - 1 / roof.distanceAt(x, y)))
  const map = new DataTexture(new Float32Array(depths), 16, 9, RedFormat, FloatType)
  map.needsUpdate = true
  camera.coordinateSystem = t.backend === 'webgpu' ? 2001 : 2000
  camera.updateProjectionMatrix()
  const rays = new DepthRays(texture(map), camera)
  const results = await t.evaluate(pixels, pixel =>
    Fn(({ renderer }) => {
      const at = pixel.xy.add(0.5).div(vec2(16, 9)).toConst()
      return vec4(depthNormal(renderer, rays, at, vec2(16, 9)), 0)
    })()
  )
  pixels.forEach(([x, y], i) => {
    const normal = [0, 1, 2].map(k => results[4 * i + k])
    expectClose(normal, twin(roof, x, y), { absolute: 2e-3 }, `normal of (${x}, ${y})`)
  })
  map.dispose()
})

gpuTest(
  'surfaceLighting lights unlit materials as a Lambert material is lit, shadows and lamps included',
  async t => {
    const renderer = await t.createPlanetRenderer(size)
    renderer.shadowMap.enabled = true
    const atmosphere = new Atmosphere({ frame: 'ecef', date: new Date('2026-06-21T15:30:00Z') })
    const scene = new Scene()
    const place = new Group()
    Ellipsoid.WGS84.eastNorthUpFrame(
      Ellipsoid.WGS84.geodeticToECEF({ longitude: 0, latitude: 45, height: 20 }),
      place.matrix
    )
    place.matrix.decompose(place.position, place.quaternion, place.scale)
    scene.add(place)
    const ground = new Mesh(new PlaneGeometry(400, 400))
    const box = new Mesh(new BoxGeometry(8, 8, 8))
    box.position.set(-5, 8, 4)
    box.rotation.set(0.2, 0.4, 0.7)
    const ball = new Mesh(new SphereGeometry(4, 96, 64))
    ball.position.set(7, 4, 4)
    const meshes = [ground, box, ball]
    const colors = ['#907050', '#7090b0', '#ffffff'].map(color => new Color(color))
    for (const mesh of meshes) mesh.castShadow = mesh.receiveShadow = true
    const sun = new SunDirectionalLight(atmosphere, 60)
    sun.castShadow = true
    Object.assign(sun.shadow.camera, { left: -30, right: 30, top: 30, bottom: -30, far: 150 })
    sun.shadow.normalBias = 0.1
    const sky = new SkyLightProbe(atmosphere)
    const lamp = new PointLight('#ff8040', 60)
    lamp.position.set(2, -8, 3)
    place.add(...meshes, sun, sun.target, sky, lamp)
    const camera = new PerspectiveCamera(40, size.width / size.height, 0.5, 2000)
    place.add(camera)
    camera.position.set(0, -30, 12)
    camera.up.set(0, 0, 1)
    scene.updateMatrixWorld(true)
    camera.up.transformDirection(place.matrix)
    camera.lookAt(place.localToWorld(ground.position.clone().set(0, 0, 2)))

    const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
    const color = scenePass.getTextureNode()
    scenePass.setMRT(mrt({ output, normal: normalView }))
    const depth = scenePass.getTextureNode('depth')
    const lights = [sun, sky, lamp]
    const lighting = surfaceLighting(color, depth, camera, lights)
    const normal = scenePass.getTextureNode('normal')
    const withNormals = surfaceLighting(color, depth, camera, lights, { normal })
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    const draw = async (output: typeof color | typeof lighting): Promise<Picture> => {
      pipeline.outputNode = output
      pipeline.needsUpdate = true
      let picture: Picture | undefined
      for (let i = 0; i < 3; i++) {
        await nextFrame()
        picture = await drawToFloat(renderer, () => pipeline.render())
      }
      return picture!
    }
    const unlit = colors.map(color => new MeshBasicMaterial({ color }))
    const lit = colors.map(color => new MeshLambertMaterial({ color }))
    meshes.forEach((mesh, i) => (mesh.material = unlit[i]))
    const picture = await draw(color)
    const relit = await draw(lighting)
    const relitByNormals = await draw(withNormals)
    lighting.strength = 0
    const untouched = await draw(lighting)
    lighting.strength = 0.5
    const half = await draw(lighting)
    meshes.forEach((mesh, i) => (mesh.material = lit[i]))
    const reference = await draw(color)

    expectLight(relit, 'lit')
    expectTrue(
      untouched.data.every((value, i) => value === picture.data[i]),
      'strength 0 leaves the picture bit for bit'
    )
    const differences = relativeDifferences(relit, reference)
    const at = (part: number): number => differences[Math.floor(part * differences.length)]
    t.note(
      `median ${at(0.5).toExponential(1)}, 95 % ${at(0.95).toFixed(4)}, 99 % ${at(0.99).toFixed(3)}`
    )
    expectTrue(at(0.5) < 2e-3, `median difference ${at(0.5)}`)
    expectTrue(at(0.95) < 0.03, `difference of 95 % ${at(0.95)}`)
    // Normals that are given are those of the materials, at edges too.
    const byNormals = relativeDifferences(relitByNormals, reference)
    const most = byNormals[Math.floor(0.99 * byNormals.length)]
    t.note(`with given normals 99 % ${most.toFixed(4)}`)
    expectTrue(most < 0.5 * at(0.99), `difference of 99 % ${most} with given normals`)
    const i = 4 * (60 * size.width + 64)
    const middle = (picture.data[i] + relit.data[i]) / 2
    expectClose(half.data[i], middle, { relative: 1e-3 }, 'half the strength')
    pipeline.dispose()
    lighting.dispose()
    withNormals.dispose()
    scenePass.dispose()
    atmosphere.dispose()
  }
)

gpuTest(
  'surfaceLighting lights by what waves of cloud let through of the sun, as a float64 march through them',
  async t => {
    const [elevation, height] = [35, 1000]
    const seen = { width: 8, height: 24 }
    const renderer = await t.createRenderer(seen)
    renderer.shadowMap.enabled = true
    // Above the equator, x is up, y east and z north in the clouds' space.
    const atmosphere = new Atmosphere().setSunAngles(elevation, 0)
    const scene = new Scene()
    const color = new Color(0.6, 0.4, 0.2)
    const ground = new Mesh(
      new PlaneGeometry(1e4, 1e4).rotateX(-Math.PI / 2),
      new MeshBasicMaterial({ color })
    )
    ground.receiveShadow = true
    const sun = new SunDirectionalLight(atmosphere)
    sun.castShadow = true
    scene.add(ground, sun, sun.target)
    const camera = new PerspectiveCamera(90, seen.width / seen.height, 100, 2000)
    camera.position.set(0, height, 0)
    camera.rotation.set(-Math.PI / 2, 0, 0)
    camera.updateMatrixWorld()
    const layers = new CloudLayers([{ ...fog, baseAltitude: 1200, topAltitude: 1800 }])
    const [mean, wave] = [0.0015, (2 * Math.PI) / 3000]
    const {
      node,
      draw: drawClouds,
      dispose
    } = await unseenClouds(
      renderer,
      { camera, atmosphere },
      layers,
      new SparseNoise(),
      ({ offset }) => offset.z.mul(wave).sin().add(1).mul(mean)
    )
    Object.assign(sun.shadow, { shadowNode: cloudShadow(node) })
    for (let i = 0; i < 3; i++) await drawClouds()

    const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
    const depth = scenePass.getTextureNode('depth')
    const lighting = surfaceLighting(scenePass.getTextureNode(), depth, camera, [sun], {
      albedo: 0.5
    })
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = lighting
    await nextFrame()
    const picture = await drawToFloat(renderer, () => pipeline.render())

    const deck = {
      planetRadius: atmosphere.parameters.bottomRadius,
      base: 1200,
      top: 1800,
      extinction: (_up: number, _east: number, north: number) => mean * (1 + Math.sin(wave * north))
    }
    const { value: depthScale } = node.field.depthScale
    const open = sunIlluminanceAt(atmosphere, new Vector3())
    const reflected = (0.5 * atmosphere.luminanceScale * Math.sin(radians(elevation))) / Math.PI
    const passing = Array.from({ length: seen.height }, (_, y) => {
      const north = (1 - (2 * y + 1) / seen.height) * height
      return Math.exp(-depthScale * depthToSun(deck, 0, north, radians(elevation)))
    })
    const errors = passing.flatMap((share, y) =>
      color
        .toArray()
        .map((value, k) => picture.at(4, y)[k] / (value * reflected * open[k] * share) - 1)
    )
    const [least, most] = [Math.min(...errors), Math.max(...errors)]
    t.note(
      `passing ${Math.min(...passing).toFixed(3)} to ${Math.max(...passing).toFixed(3)}, off by ${least.toFixed(4)} to ${most.toFixed(4)}`
    )
    expectTrue(Math.max(...passing) > 2 * Math.min(...passing), 'there are shadows')
    expectTrue(Math.max(-least, most) < 0.02, `light is off by ${least} to ${most}`)
    dispose()
    pipeline.dispose()
    lighting.dispose()
    scenePass.dispose()
    atmosphere.dispose()
  },
  // The same numbers on both.
  { backends: ['webgpu'] }
)
