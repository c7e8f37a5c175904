import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import { GridHeights, Lake, Terrain } from '@welkin/terrain'
import { Color, MathUtils, Matrix4, PerspectiveCamera, Scene, Vector3 } from 'three'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const SIZE = { width: 48, height: 32 }
const MIDDLE = { longitude: 8.5, latitude: 47.2 }
const LEVEL = 420

gpuTest(
  'fills a basin of measured heights with water up to its level, which mirrors the sky at a low angle',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    const atmosphere = new Atmosphere({ frame: 'ecef' })
    const { ellipsoid } = atmosphere
    // A basin that is not round, 25 m deep, between 380 and 600 m.
    const side = 64
    const half = 0.06
    const values = Array.from({ length: side * side }, (_, i) => {
      const x = ((i % side) + 0.5) / side - 0.5
      const y = Math.floor(i / side) / side - 0.5
      return 395 + 900 * x * x + 500 * (y - 0.4 * x) ** 2
    })
    const heights = new GridHeights(values, {
      width: side,
      height: side,
      west: MIDDLE.longitude - half,
      east: MIDDLE.longitude + half,
      south: MIDDLE.latitude - half,
      north: MIDDLE.latitude + half,
      outside: 600
    })
    const terrain = new Terrain(atmosphere, heights, {
      resolution: 8,
      pageMemory: 10,
      windSpeed: 2
    })
    const sun = new SunDirectionalLight(atmosphere)
    const scene = new Scene()
    scene.background = new Color(0, 0, 0)
    scene.add(terrain, sun, sun.target, new SkyLightProbe(atmosphere))
    const camera = new PerspectiveCamera(50, SIZE.width / SIZE.height, 1, 1e6)
    const look = (height: number, pitch: number): void => {
      ellipsoid.geodeticToECEF({ ...MIDDLE, height }, camera.position)
      const frame = ellipsoid.localYUpFrame(camera.position, new Matrix4())
      camera.quaternion.setFromRotationMatrix(frame)
      camera.rotateX(MathUtils.degToRad(pitch))
      camera.updateMatrixWorld()
    }
    look(LEVEL + 4000, -90)
    atmosphere.sunDirection = ellipsoid.surfaceNormal(camera.position)
    terrain.update(renderer, camera, Infinity)
    const ray = new Vector3()
    /** Height of the ground over the water's level in a pixel [m]. */
    const overWater = (column: number, row: number): number => {
      const [x, y] = [(column + 0.5) / SIZE.width, (row + 0.5) / SIZE.height]
      ray
        .set(2 * x - 1, 1 - 2 * y, 0.5)
        .unproject(camera)
        .sub(camera.position)
      return ellipsoid.heightAt(terrain.intersectRay(camera.position, ray)!) - LEVEL
    }
    // Rays hit the lake, too, once it is there.
    const overs = Array.from({ length: SIZE.width * SIZE.height }, (_, i) =>
      overWater(i % SIZE.width, Math.floor(i / SIZE.width))
    )
    const lake = new Lake(terrain, { ...MIDDLE, radius: 4000, level: LEVEL })
    const dry = await t.render(renderer, scene, camera, SIZE)
    scene.add(lake)
    const wet = await t.render(renderer, scene, camera, SIZE)
    let water = 0
    let wrong = 0
    for (let row = 0; row < SIZE.height; row++) {
      for (let column = 0; column < SIZE.width; column++) {
        const over = overs[row * SIZE.width + column]
        const before = dry.at(column, row)
        const isWater = wet.at(column, row).some((value, n) => Math.abs(value - before[n]) > 1e-6)
        water += Number(isWater)
        // A pixel shows 100 m: some of the shore is within it.
        if (Math.abs(over) > 5 && isWater !== over < 0) wrong++
      }
    }
    t.note(`${water} pixels of water, ${wrong} wrong`)
    expectTrue(water > 150 && water < 800, `${water} pixels of water`)
    expectTrue(wrong === 0, `${wrong} pixels on the wrong side of the shore`)

    // Seen from low down it is sky, not bed: brighter, and blue. The sun is behind, where no wave mirrors it.
    const up = ellipsoid.surfaceNormal(camera.position)
    const behind = new Vector3().setFromMatrixColumn(
      ellipsoid.localYUpFrame(camera.position, new Matrix4()),
      2
    )
    atmosphere.sunDirection = up.multiplyScalar(Math.SQRT1_2).addScaledVector(behind, Math.SQRT1_2)
    const mean = async (pitch: number): Promise<number[]> => {
      look(LEVEL + 2, pitch)
      const picture = await t.render(renderer, scene, camera, SIZE)
      const sums = [0, 0, 0]
      for (let column = 0; column < SIZE.width; column++) {
        const pixel = picture.at(column, SIZE.height / 2)
        for (const n of sums.keys()) sums[n] += pixel[n] / SIZE.width
      }
      return sums
    }
    const [steep, low] = [await mean(-80), await mean(-3)]
    t.note(
      `from above ${steep.map(v => v.toPrecision(3)).join(' ')}, low ${low.map(v => v.toPrecision(3)).join(' ')}`
    )
    expectTrue(low[2] > 2 * steep[2], 'low water is no mirror')
    expectTrue(low[2] > 1.2 * low[0], 'low water is not blue')
    expectTrue(lake.center.distanceTo(camera.position) < 10, 'the middle is elsewhere')
    lake.dispose()
    terrain.dispose()
  }
)
