import {
  aerialPerspective,
  aerialPerspectiveFog,
  Atmosphere,
  planetGround,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight
} from '@welkin/atmosphere'
import { Terrain, type HeightSource } from '@welkin/terrain'
import {
  DataTexture,
  FloatType,
  Matrix4,
  PerspectiveCamera,
  RenderTarget,
  RepeatWrapping,
  Scene,
  Vector3
} from 'three'
import { pass, vec3, vec4 } from 'three/tsl'
import { RenderPipeline, type Node } from 'three/webgpu'
import { WaveHeights } from '../../bench/cracksGround'
import { gpuTest } from '../harness/gpu-test'
import { boxFromAbove, expectBoxShadow, sharesOf } from '../harness/ground'
import { readPicture, type Picture } from '../harness/picture'

const SIZE = { width: 64, height: 48 }
const PLACE = { longitude: 12, latitude: 47 }

/** Floor of a deep sea, or a plain. */
const level = (height: number): HeightSource => ({
  lowest: height,
  highest: height,
  variation: () => 0,
  sampleAt(_position, target) {
    target.height = height
    target.gradient.set(0, 0, 0)
    return target
  },
  sample: (): Node<'vec4'> => vec4(0, 0, 0, height)
})

const luminance = (picture: Picture, x: number, y: number): number => {
  const [red, green, blue] = picture.at(x, y)
  return 0.2126 * red + 0.7152 * green + 0.0722 * blue
}

/** Camera above a place, that looks down by an angle [rad]. */
function cameraAt(atmosphere: Atmosphere, height: number, pitch: number): PerspectiveCamera {
  const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, height / 20, 1e8)
  atmosphere.ellipsoid.geodeticToECEF({ ...PLACE, height }, camera.position)
  const axes = atmosphere.ellipsoid.localYUpFrame(camera.position, new Matrix4())
  camera.quaternion.setFromRotationMatrix(axes)
  camera.rotateX(pitch)
  camera.updateMatrixWorld()
  return camera
}

/** Puts the sun at a height above the horizon of the place, in the east [rad]. */
function setSun(atmosphere: Atmosphere, elevation: number): void {
  const position = atmosphere.ellipsoid.geodeticToECEF(PLACE)
  const up = atmosphere.ellipsoid.surfaceNormal(position)
  const east = up.clone().set(-up.y, up.x, 0).normalize()
  atmosphere.sunDirection = up
    .multiplyScalar(Math.sin(elevation))
    .addScaledVector(east, Math.cos(elevation))
}

gpuTest(
  'haze before the ground is the same as fog and as a post effect, within 2 %',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    const atmosphere = new Atmosphere({ frame: 'ecef' })
    setSun(atmosphere, 0.5)
    const heights = new WaveHeights()
    const terrain = new Terrain(atmosphere, heights, { pageMemory: 20, seaLevel: -Infinity })
    const sun = new SunDirectionalLight(atmosphere)
    const scene = new Scene().add(terrain, sun, sun.target, new SkyLightProbe(atmosphere))
    const camera = cameraAt(atmosphere, heights.highest + 3000, -0.25)
    terrain.update(renderer, camera, Infinity)
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
    const asFog = await t.render(renderer, scene, camera, SIZE)
    scene.backgroundNode = scene.fogNode = null
    const clear = await t.render(renderer, scene, camera, SIZE)
    const scenePass = pass(scene, camera, { samples: 0 })
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputNode = aerialPerspective(
      scenePass.getTextureNode(),
      scenePass.getTextureNode('depth'),
      camera,
      atmosphere
    )
    pipeline.outputColorTransform = false
    const target = new RenderTarget(SIZE.width, SIZE.height, { type: FloatType })
    renderer.setRenderTarget(target)
    pipeline.render()
    renderer.setRenderTarget(null)
    const asPost = await readPicture(renderer, target)
    let [worst, haze] = [0, 0]
    for (let y = SIZE.height / 2; y < SIZE.height; y++) {
      for (let x = 0; x < SIZE.width; x++) {
        const [fog, post, bare] = [asFog, asPost, clear].map(picture => luminance(picture, x, y))
        worst = Math.max(worst, Math.abs(fog - post) / fog)
        haze = Math.max(haze, Math.abs(fog - bare) / fog)
      }
    }
    t.note(`within ${(100 * worst).toFixed(2)} %, of haze up to ${(100 * haze).toFixed(0)} %`)
    pipeline.dispose()
    target.dispose()
    terrain.dispose()
    if (haze < 0.2) throw new Error('there is no haze')
    if (worst > 0.02) throw new Error(`fog and post effect differ by ${worst}`)
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'the ground receives shadows of things',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    renderer.shadowMap.enabled = true
    const atmosphere = new Atmosphere()
    atmosphere.place(PLACE)
    atmosphere.setSunAngles(40, 90)
    const terrain = new Terrain(atmosphere, level(0), { pageMemory: 20, seaLevel: -Infinity })
    const sun = new SunDirectionalLight(atmosphere, 100)
    sun.castShadow = true
    sun.shadow.mapSize.setScalar(512)
    Object.assign(sun.shadow.camera, {
      left: -20,
      right: 20,
      top: 20,
      bottom: -20,
      near: 1,
      far: 200
    })
    sun.shadow.camera.updateProjectionMatrix()
    const scene = new Scene().add(terrain, sun, sun.target)
    const { box, camera } = boxFromAbove(SIZE.width / SIZE.height)
    scene.add(box)
    terrain.update(renderer, camera, Infinity)
    const row = async (): Promise<number[]> => {
      const picture = await t.render(renderer, scene, camera, SIZE)
      return Array.from({ length: SIZE.width }, (_, x) => luminance(picture, x, SIZE.height / 2))
    }
    const alone = await row()
    // Told after a first frame, of which the material need not know: three has the shadow in the next but one.
    terrain.receiveShadow = box.castShadow = true
    await row()
    expectBoxShadow(t, await row(), alone)
    terrain.receiveShadow = false
    const left = sharesOf(await row(), alone).slice(0, 26)
    t.note(`when it no longer receives any, ${Math.min(...left).toFixed(4)} of the light at least`)
    terrain.dispose()
    if (!left.every(share => share > 0.99)) throw new Error('the shadow stays')
  },
  // WebGL has them in `cascades`.
  { backends: ['webgpu'] }
)

/** A ridge 60 m high, from north to south through the place. */
function ridge(atmosphere: Atmosphere): HeightSource {
  const [height, width] = [60, 40]
  const origin = atmosphere.ellipsoid.geodeticToECEF(PLACE)
  const east = new Vector3(-origin.y, origin.x, 0).normalize()
  const inSteps = origin.clone().divideScalar(256)
  return {
    lowest: 0,
    highest: height,
    variation: distance => Math.min((height / width) * distance, height),
    sampleAt(position, target) {
      const away = position.clone().sub(origin).dot(east) / width
      target.height = height * Math.exp(-away * away)
      target.gradient.copy(east).multiplyScalar((-2 * away * target.height) / width)
      return target
    },
    sample({ reference, offset }): Node<'vec4'> {
      const axis = vec3(east.x, east.y, east.z)
      const start = reference.sub(vec3(inSteps.x, inSteps.y, inSteps.z)).mul(256)
      const away = start.add(offset).dot(axis).div(width).toConst()
      const rise = away.mul(away).negate().exp().mul(height).toConst()
      return vec4(axis.mul(away.mul(rise).mul(-2 / width)), rise)
    }
  }
}

gpuTest('a ridge casts its shadow on the ground behind it', async t => {
  const renderer = await t.createPlanetRenderer(SIZE)
  renderer.shadowMap.enabled = true
  const atmosphere = new Atmosphere()
  atmosphere.place(PLACE)
  atmosphere.setSunAngles(15, 90)
  const terrain = new Terrain(atmosphere, ridge(atmosphere), {
    pageMemory: 20,
    seaLevel: -Infinity
  })
  terrain.receiveShadow = true
  const sun = new SunDirectionalLight(atmosphere, 1000)
  sun.castShadow = true
  sun.shadow.normalBias = 1.5
  sun.shadow.mapSize.setScalar(1024)
  const sides = { left: -400, right: 400, top: 400, bottom: -400, near: 1, far: 2000 }
  Object.assign(sun.shadow.camera, sides).updateProjectionMatrix()
  const scene = new Scene().add(terrain, sun, sun.target)
  const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, 1, 1e7)
  camera.position.y = 300
  camera.rotation.x = -Math.PI / 2
  camera.updateMatrixWorld()
  const row = async (castsShadow: boolean): Promise<number[]> => {
    terrain.castShadow = castsShadow
    terrain.update(renderer, camera, Infinity)
    const picture = await t.render(renderer, scene, camera, SIZE)
    return Array.from({ length: SIZE.width }, (_, x) => luminance(picture, x, SIZE.height / 2))
  }
  const alone = await row(false)
  const shares = (await row(true)).map((value, x) => value / alone[x])
  terrain.dispose()
  // The shadow is 224 m long to the west, the picture 460 m wide.
  const behind = Math.max(...shares.slice(6, 18))
  const before = Math.min(...shares.slice(46))
  t.note(`behind it at most ${behind.toFixed(3)} of the light, before it ${before.toFixed(3)}`)
  if (!(behind < 0.05)) throw new Error('the ridge casts no shadow')
  if (!(before > 0.95)) throw new Error('the side of the sun is in the shadow')
})

gpuTest(
  'from orbit the sea is that of planetGround',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    const atmosphere = new Atmosphere({ frame: 'ecef' })
    setSun(atmosphere, 0.6)
    const camera = cameraAt(atmosphere, 4e5, -1.1)
    const sun = new SunDirectionalLight(atmosphere)
    const terrain = new Terrain(atmosphere, level(-3000), { pageMemory: 20 })
    const scene = new Scene().add(terrain, sun, sun.target, new SkyLightProbe(atmosphere))
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
    terrain.update(renderer, camera, Infinity)
    const drawn = await t.render(renderer, scene, camera, SIZE)
    scene.remove(terrain)
    terrain.dispose()
    const [surface, water] = [0, 255].map(value => {
      const map = new DataTexture(new Uint8Array(4).fill(value), 1, 1)
      map.wrapS = RepeatWrapping
      map.needsUpdate = true
      return map
    })
    const other = new Atmosphere({ frame: 'ecef' })
    setSun(other, 0.6)
    other.add(planetGround({ surface, water }))
    scene.backgroundNode = skyBackground(other)
    scene.fogNode = null
    const expected = await t.render(renderer, scene, camera, SIZE)
    let worst = 0
    let sum = 0
    for (let y = 0; y < SIZE.height; y++) {
      for (let x = 0; x < SIZE.width; x++) {
        const ratio = luminance(drawn, x, y) / luminance(expected, x, y)
        worst = Math.max(worst, Math.abs(Math.log(ratio)))
        sum += Math.log(ratio)
      }
    }
    const mean = Math.exp(sum / (SIZE.width * SIZE.height))
    t.note(`mean ratio ${mean.toFixed(3)}, worst ${Math.exp(worst).toFixed(3)}`)
    t.note(`${drawn.at(32, 24)}; ${expected.at(32, 24)}`)
    for (const map of [surface, water]) map.dispose()
    if (Math.abs(mean - 1) > 0.1 || worst > 0.3) throw new Error('they are two seas')
  },
  { backends: ['webgpu'] }
)
