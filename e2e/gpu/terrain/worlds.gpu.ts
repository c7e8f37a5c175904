import { Atmosphere, AtmosphereParameters } from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import {
  GridHeights,
  MountainHeights,
  Terrain,
  type HeightSource,
  type PageSource,
  type TerrainOptions
} from '@welkin/terrain'
import { Color, Matrix4, OrthographicCamera, PerspectiveCamera, Scene, Vector3 } from 'three'
import { positionView, vec4 } from 'three/tsl'
import { randomNumbers } from '../../../packages/terrain/test/randomNumbers'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'

const SIZE = { width: 48, height: 32 }
/** Angle of view [°]: a wider one has three times as many pages. */
const FOV = 20
const PLACE = { longitude: 0.494, latitude: 46.35 }
/** Small pages: a software renderer draws them. */
const options = { resolution: 8, seaLevel: -Infinity, pageMemory: 10 }

/** A terrain that draws where its pixels are, from the camera [units]. */
function groundOf(
  atmosphere: Atmosphere,
  source: HeightSource | PageSource = new MountainHeights({ seed: 513 }),
  more: TerrainOptions = {}
): { terrain: Terrain; scene: Scene } {
  const terrain = new Terrain(atmosphere, source, { ...options, ...more })
  terrain.material.fragmentNode = vec4(positionView, 1)
  const scene = new Scene()
  scene.background = new Color(0, 0, 0)
  return { terrain, scene: scene.add(terrain) }
}

/** Camera above a place, in the frame of the world; its pitch in degrees. */
function cameraOver(terrain: Terrain, clearance: number, pitch: number): PerspectiveCamera {
  const { atmosphere } = terrain
  const { ellipsoid } = atmosphere
  const units = 1 / atmosphere.metersPerUnit
  const camera = new PerspectiveCamera(FOV, SIZE.width / SIZE.height, 0.05 * units, 1e8 * units)
  const height = terrain.heightAt(PLACE.longitude, PLACE.latitude) + clearance
  const position = ellipsoid.geodeticToECEF({ ...PLACE, height })
  const toWorld = atmosphere.worldToECEF.clone().invert()
  const frame = ellipsoid.localYUpFrame(position, new Matrix4()).premultiply(toWorld)
  frame.decompose(camera.position, camera.quaternion, new Vector3())
  camera.rotateX((pitch * Math.PI) / 180)
  camera.updateMatrixWorld()
  return camera
}

/** Distance of what a picture shows from the ground that the CPU finds, at most [m]. @throws If there is a hole. */
function worstError(terrain: Terrain, camera: PerspectiveCamera, picture: Picture): number {
  const { worldToECEF, ellipsoid } = terrain.atmosphere
  const point = new Vector3()
  let worst = 0
  for (let row = 0; row < SIZE.height; row += 2) {
    for (let column = 0; column < SIZE.width; column += 2) {
      const [x, y, z] = picture.at(column, row)
      expectTrue(z < 0, 'a hole')
      point.set(x, y, z).applyMatrix4(camera.matrixWorld)
      const below = terrain.heightBelow(point)
      worst = Math.max(worst, Math.abs(ellipsoid.heightAt(point.applyMatrix4(worldToECEF)) - below))
    }
  }
  return worst
}

gpuTest(
  'draws the ground where the CPU finds it, in kilometres with a moved origin, and on a small planet',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    const moved = new Atmosphere()
    moved.place(PLACE)
    moved.metersPerUnit = 1000
    moved.worldToECEF.multiply(new Matrix4().makeTranslation(-30, 0.2, 45))
    const parameters = new AtmosphereParameters({ bottomRadius: 1e6, topRadius: 1.06e6 })
    const small = new Atmosphere({ parameters, ellipsoid: new Ellipsoid(1e6) })
    small.place(PLACE)
    for (const [label, atmosphere] of Object.entries({ moved, small })) {
      const { terrain, scene } = groundOf(atmosphere)
      const metres = atmosphere.metersPerUnit
      const camera = cameraOver(terrain, 2, -90)
      terrain.update(renderer, camera, Infinity)
      const worst = worstError(terrain, camera, await t.render(renderer, scene, camera, SIZE))
      t.note(`${label}: ${(1000 * worst).toFixed(1)} mm, in units of ${metres} m`)
      expectTrue(worst < 0.01, `${label}: ${worst} m off`)
      terrain.dispose()
    }
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'draws measured ground where the CPU finds it, within 1 cm at 2 m',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    const atmosphere = new Atmosphere()
    atmosphere.place(PLACE)
    // Numbers 90 m apart that jump by up to 60 m.
    const side = 64
    const random = randomNumbers(5)
    const values = Array.from({ length: side * side }, () => 400 + 60 * random())
    const half = (side / 2) * 0.0008
    const grid = new GridHeights(values, {
      width: side,
      height: side,
      west: PLACE.longitude - half,
      east: PLACE.longitude + half,
      south: PLACE.latitude - half,
      north: PLACE.latitude + half,
      outside: 430
    })
    // As fine as a terrain is by default.
    const { terrain, scene } = groundOf(atmosphere, grid, { resolution: 12 })
    const camera = cameraOver(terrain, 2, -90)
    terrain.update(renderer, camera, Infinity)
    const worst = worstError(terrain, camera, await t.render(renderer, scene, camera, SIZE))
    t.note(`${(1000 * worst).toFixed(2)} mm`)
    expectTrue(worst < 0.01, `${worst} m off`)
    terrain.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'draws two cameras in a frame as each alone, and all of an orthographic view',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    const atmosphere = new Atmosphere()
    atmosphere.place(PLACE)
    const { terrain, scene } = groundOf(atmosphere)
    // Beyond the horizon, which is 2,300 km away.
    const wide = new OrthographicCamera(-3.9e6, 3.9e6, 2.6e6, -2.6e6, 0, 1e7)
    wide.position.y = terrain.heightAt(PLACE.longitude, PLACE.latitude) + 400_000
    wide.rotation.x = -Math.PI / 2
    wide.updateMatrixWorld()
    const cameras = [cameraOver(terrain, 2, -80), cameraOver(terrain, 500, -90), wide]
    const alone: Picture[] = []
    for (const camera of cameras) {
      terrain.update(renderer, camera, Infinity)
      alone.push(await t.render(renderer, scene, camera, SIZE))
    }
    const holes = alone.map(({ data }) => data.filter((z, i) => i % 4 === 2 && !(z < 0)).length)
    t.note(`pixels without ground: ${holes.join(', ')}`)
    expectTrue(Math.max(...holes) === 0, `pixels without ground: ${holes.join(', ')}`)
    for (let frame = 0; frame < 2; frame++) {
      await nextFrame()
      for (const [i, camera] of cameras.slice(0, 2).entries()) {
        const { data } = await t.render(renderer, scene, camera, SIZE)
        const apart = data.reduce(
          (most, value, k) => Math.max(most, Math.abs(value - alone[i].data[k])),
          0
        )
        expectTrue(apart < 1e-3, `camera ${i} in frame ${frame} is ${apart} m off`)
      }
    }
    terrain.dispose()
  },
  { backends: ['webgpu'] }
)
