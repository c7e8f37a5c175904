import { Atmosphere } from '@welkin/atmosphere'
import { MountainHeights, Terrain } from '@welkin/terrain'
import { Color, Matrix4, PerspectiveCamera, Scene, Vector3 } from 'three'
import { positionView, vec3, vec4, float } from 'three/tsl'
import type { Node } from 'three/webgpu'
import type { GpuContext } from '../harness/context'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

/** Repeatable random numbers in [0, 1). */
function randomNumbers(seed: number): () => number {
  let state = seed
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0
    return state / 2 ** 32
  }
}

const heights = new MountainHeights({ seed: 1 })

/** Height and slope of the ground at a place of the ellipsoid. */
const sampleAt = (position: Vector3) =>
  heights.sampleAt(position, { height: 0, gradient: new Vector3() })

interface Stage {
  readonly terrain: Terrain
  readonly camera: PerspectiveCamera
  readonly atmosphere: Atmosphere
  /** Puts the camera above the ground, looking down, and draws where in the view each pixel's ground is. */
  readonly draw: (
    longitude: number,
    latitude: number,
    height: number,
    pitch: number
  ) => Promise<Picture>
}

async function stage(
  t: GpuContext,
  resolution: number,
  size: { width: number; height: number }
): Promise<Stage> {
  const renderer = await t.createRenderer({ ...size, reversedDepthBuffer: true })
  renderer.highPrecision = true
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const { ellipsoid } = atmosphere
  const terrain = new Terrain(atmosphere, heights, { resolution, seaLevel: -Infinity })
  terrain.material.fragmentNode = vec4(positionView, 1)
  const scene = new Scene()
  scene.background = new Color(0, 0, 0)
  scene.add(terrain)
  const camera = new PerspectiveCamera(60, size.width / size.height, 0.1, 1e9)
  const axes = new Matrix4()
  return {
    terrain,
    camera,
    atmosphere,
    draw(longitude, latitude, height, pitch) {
      const ground = terrain.heightAt(longitude, latitude)
      ellipsoid.geodeticToECEF({ longitude, latitude, height: ground + height }, camera.position)
      ellipsoid.localYUpFrame(camera.position, axes)
      camera.quaternion.setFromRotationMatrix(axes)
      camera.rotateX(pitch)
      camera.near = height / 20
      camera.updateProjectionMatrix()
      return t.render(renderer, scene, camera, size)
    }
  }
}

/** Pixels of a picture that have ground, as positions in ECEF [m]. */
function groundPoints(picture: Picture, camera: PerspectiveCamera): Vector3[] {
  const points: Vector3[] = []
  for (let y = 0; y < picture.height; y += 3) {
    for (let x = 0; x < picture.width; x += 3) {
      const [viewX, viewY, viewZ] = picture.at(x, y)
      if (viewZ < 0) {
        const point = new Vector3(viewX, viewY, viewZ).applyQuaternion(camera.quaternion)
        points.push(point.add(camera.position))
      }
    }
  }
  return points
}

gpuTest('a shader finds heights and slopes as the CPU does', async t => {
  const { ellipsoid } = new Atmosphere()
  const random = randomNumbers(5)
  const subpoint = ellipsoid.geodeticToECEF({ longitude: 1.02, latitude: 47.01 })
  const reference = subpoint.clone().divideScalar(256).round()
  const origin = reference.clone().multiplyScalar(256)
  const inputs = Array.from({ length: 300 }, () => {
    const reach = 10 ** (4 * random())
    const offset = new Vector3(random() - 0.5, random() - 0.5, random() - 0.5)
    const place = offset.multiplyScalar(reach).add(subpoint)
    return ellipsoid.footPoint(place).sub(origin).toArray().map(Math.fround)
  })
  const sample = (input: Node<'vec4'>) =>
    heights.sample(
      { reference: vec3(reference.x, reference.y, reference.z), offset: input.xyz },
      float(1e-3)
    )
  const results = await t.evaluate(inputs, sample)
  let worstHeight = 0
  let worstSlope = 0
  for (const [i, [x, y, z]] of inputs.entries()) {
    const { height, gradient } = sampleAt(new Vector3(x, y, z).add(origin))
    worstHeight = Math.max(worstHeight, Math.abs(results[4 * i + 3] - height))
    const [gx, gy, gz] = results.subarray(4 * i, 4 * i + 3)
    worstSlope = Math.max(worstSlope, gradient.distanceTo(new Vector3(gx, gy, gz)))
  }
  t.note(
    `height within ${(1000 * worstHeight).toFixed(2)} mm, slope ${worstSlope.toExponential(1)}`
  )
  if (worstHeight > 0.004) throw new Error(`heights differ by ${worstHeight} m`)
  // Half a degree of a normal is 0.0087.
  if (worstSlope > 0.002) throw new Error(`slopes differ by ${worstSlope}`)
})

gpuTest('the ground 2 m away is drawn where the CPU finds it, within 1 cm', async t => {
  const { draw, camera, atmosphere, terrain } = await stage(t, 16, { width: 96, height: 64 })
  const { ellipsoid } = atmosphere
  let worst = 0
  let count = 0
  // A summit, a plain, the antimeridian, a pole.
  for (const [longitude, latitude] of [
    [1, 47],
    [12.3, 45.6],
    [180, -12],
    [70, 89.999999]
  ]) {
    const picture = await draw(longitude, latitude, 2, -Math.PI / 2)
    for (const point of groundPoints(picture, camera)) {
      const { longitude: east, latitude: north, height } = ellipsoid.ecefToGeodetic(point)
      worst = Math.max(worst, Math.abs(height - terrain.heightAt(east, north)))
      count++
    }
  }
  t.note(`${count} points, within ${(1000 * worst).toFixed(1)} mm`)
  if (count < 2000) throw new Error(`only ${count} points of ground`)
  if (worst > 0.01) throw new Error(`the drawn ground is ${worst} m off`)
  terrain.dispose()
})

gpuTest('there is no hole in the ground for cameras anywhere', async t => {
  const { draw, camera, atmosphere, terrain } = await stage(t, 8, { width: 96, height: 64 })
  const random = randomNumbers(11)
  // What is sure to be below the horizon: a ray that meets the ellipsoid below all ground.
  const { ellipsoid } = atmosphere
  const core = ellipsoid.grown(heights.lowest)
  const ray = new Vector3()
  let pixels = 0
  for (let n = 0; n < 60; n++) {
    const longitude = 360 * random() - 180
    const latitude = (Math.asin(2 * random() - 1) * 180) / Math.PI
    const height = 2 * 10 ** (7 * random())
    const picture = await draw(longitude, latitude, height, -Math.PI * random() * 0.5)
    const holes: string[] = []
    for (let y = 0; y < picture.height; y++) {
      for (let x = 0; x < picture.width; x++) {
        ray
          .set((x + 0.5) / 48 - 1, 1 - (y + 0.5) / 32, 0.5)
          .unproject(camera)
          .sub(camera.position)
        if (!(core.intersectRayDistance(camera.position, ray)! > 0)) continue
        pixels++
        if (!(picture.at(x, y)[2] < 0)) holes.push(`${x},${y}`)
      }
    }
    if (holes.length > 0) {
      const place = `${longitude}°, ${latitude}°, ${height} m`
      throw new Error(`holes from ${place} at pixels ${holes.slice(0, 8).join(' ')}`)
    }
  }
  t.note(`60 cameras, ${pixels} pixels`)
  terrain.dispose()
})

gpuTest(
  'the ground does not jump on the way from 2 m to 20,000 km',
  async t => {
    const { draw, camera, terrain } = await stage(t, 16, { width: 48, height: 32 })
    // Narrow: no slope is seen from behind.
    camera.fov = 20
    let worst = 0
    let where = 0
    for (let height = 2; height < 2e7; height *= 3.3) {
      const distances = async (factor: number): Promise<Float32Array> => {
        const picture = await draw(1, 47, height * factor, -Math.PI / 2)
        return picture.data.filter((_, i) => i % 4 === 2).map(z => -z / (height * factor))
      }
      // Ever closer heights: jumps would stay, what moves does not.
      const [before, after] = [await distances(1), await distances(1.00002)]
      before.forEach((value, i) => {
        if (!(value > 0 && after[i] > 0)) throw new Error(`a hole at ${height} m`)
        const change = Math.abs(after[i] - value) / value
        if (change > worst) {
          worst = change
          where = height
        }
      })
    }
    t.note(`changes of distance by at most ${worst.toExponential(1)}, at ${where.toPrecision(2)} m`)
    if (worst > 1e-3) throw new Error(`the ground jumps by ${worst} of its distance`)
    terrain.dispose()
  },
  { backends: ['webgpu'] }
)
