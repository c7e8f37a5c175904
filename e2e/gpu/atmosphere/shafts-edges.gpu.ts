import { Matrix4, Vector3 } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import type { LightShaftsQuality } from '@welkin/atmosphere'
import { airScene, drawForward } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { addBox, stage, type Stage } from '../harness/shaft-stage'

/** Rows out of the middle of a picture of 1920×1080 and 60° [pixels], and the angle that they span [°]. */
const size = { width: 1920, height: 24 }
const FIELD = (2 * Math.atan((size.height / 1080) * Math.tan(Math.PI / 6)) * 180) / Math.PI

const ELEVATION = 25

/** Height and width of the wall, and its distance [m]. */
const WALL = 3000
const DISTANCE = 300

/** Largest displacement of an edge [°]. */
const GOAL = 0.2

/** Half of the band on either side in which light is taken to be even, and the gap about the edge [pixels]. */
const BAND = 100
const GAP = 40

const radians = Math.PI / 180

/**
 * A wall that hides one half of the sky about the sun: its edge goes through the sun as the camera sees it, at an angle
 * from the vertical. So all air on one side of the plane of camera, sun and edge is dark, and the edge of its shadow is that
 * plane from wherever the camera looks.
 *
 * @returns A direction in the plane, by its angle from the sun [rad].
 */
function hideHalf({ scene, light, camera }: Stage, toSun: Vector3, angle: number) {
  const across = new Vector3().crossVectors(toSun, new Vector3(0, 1, 0)).normalize()
  const above = new Vector3().crossVectors(across, toSun)
  const edge = above
    .clone()
    .multiplyScalar(Math.cos(angle))
    .addScaledVector(across, Math.sin(angle))
  const aside = new Vector3().crossVectors(edge, toSun)
  const wall = addBox(scene, [0, 0, 0], [2 * WALL, 2 * WALL, 1])
  wall.setRotationFromMatrix(new Matrix4().makeBasis(aside, edge, toSun))
  wall.position.copy(camera.position).addScaledVector(toSun, DISTANCE).addScaledVector(aside, WALL)
  light.shadow.mapSize.setScalar(4096)
  Object.assign(light.shadow.camera, { left: -1500, right: 1500, bottom: -1500, top: 1500 })
  light.shadow.camera.updateProjectionMatrix()
  const at = (fromSun: number): Vector3 =>
    toSun.clone().multiplyScalar(Math.cos(fromSun)).addScaledVector(edge, Math.sin(fromSun))
  return { wall, aside, at }
}

const mean = (values: readonly number[]): number =>
  values.reduce((sum, value) => sum + value, 0) / values.length

/** Place of the step of a profile that has two levels [pixels], by its area. */
function stepOf(profile: readonly number[]): number {
  const middle = profile.length / 2
  const before = mean(profile.slice(middle - BAND, middle - GAP))
  const after = mean(profile.slice(middle + GAP, middle + BAND))
  expectTrue(Math.abs(after - before) > 0.2 * Math.max(after, before), 'there is an edge')
  const parts = profile
    .slice(middle - GAP, middle + GAP)
    .map(value => (value - after) / (before - after))
  return middle - GAP + parts.reduce((sum, part) => sum + part, 0)
}

/** Angles of the wall's edge from the vertical, and of the middle of the picture from the sun [°]. */
const VIEWS = [
  [3, 60],
  [17, 120],
  [-11.3, 90],
  [-29.6, 75],
  [8.55, 105],
  [22.2, 140],
  [-4.9, 45],
  [33.45, 90]
] as const

/** A stage with such a camera, for views one after the other. */
function rowStage(renderer: WebGPURenderer, elevation: number, quality: LightShaftsQuality): Stage {
  const set = stage(renderer, elevation, { quality })
  const { camera } = set
  camera.fov = FIELD
  camera.aspect = size.width / size.height
  camera.updateProjectionMatrix()
  return set
}

/** Displacement of the edge of a half-plane's shadow in a view [°]. */
async function displacement(
  renderer: WebGPURenderer,
  set: Stage,
  [angle, fromSun]: readonly [number, number],
  isForward = false,
  offsetDegrees = 0.27
): Promise<number> {
  const { scene, camera, light, atmosphere, shafts } = set
  const { wall, aside, at } = hideHalf(set, atmosphere.sunDirection, angle * radians)
  // The plane is upright in the picture, and not quite in its middle.
  camera.up.copy(at(fromSun * radians - 0.5 * Math.PI)).negate()
  const offset = offsetDegrees * radians
  const direction = at(fromSun * radians).addScaledVector(aside, offset)
  camera.lookAt(direction.add(camera.position))
  const forward = async (): Promise<Picture> => {
    camera.updateMatrixWorld()
    await nextFrame()
    return drawForward(renderer, scene, camera, atmosphere)
  }
  const draw = isForward ? forward : set.draw
  shafts.enabled = light.shadow.autoUpdate = true
  // The volume that materials read is of the frame before.
  if (isForward) await draw()
  const shadowed = await draw()
  // Nothing moves: there is no need for another map.
  shafts.enabled = light.shadow.autoUpdate = false
  const lit = await draw()
  const profile = Array.from({ length: size.width }, (_, x) => {
    const rows = [-8, -4, 0, 4, 8].map(y => size.height / 2 + y)
    return mean(rows.map(y => lit.at(x, y)[1] - shadowed.at(x, y)[1]))
  })
  const perPixel = FIELD / size.height
  const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0)
  const sign = Math.sign(right.dot(aside))
  const expected = size.width / 2 - (sign * Math.tan(offset)) / radians / perPixel
  scene.remove(wall)
  return (stepOf(profile) - expected) * perPixel
}

for (const quality of ['medium', 'high', 'low'] as const) {
  gpuTest(
    `has edges of shafts where a half-plane has them, at ${quality} quality`,
    async t => {
      const renderer = await t.createRenderer(size)
      const set = rowStage(renderer, ELEVATION, quality)
      const displaced: number[] = []
      // Every other one of the qualities that are not the default.
      const views = VIEWS.filter((_, i) => quality === 'medium' || i % 2 === 1)
      for (const view of views) displaced.push(await displacement(renderer, set, view))
      set.dispose()
      t.note(displaced.map(degrees => `${degrees.toFixed(3)}°`).join(', '))
      const most = Math.max(...displaced.map(Math.abs))
      expectTrue(most <= GOAL, `edges are displaced by ${most.toFixed(3)}°`)
    },
    { backends: ['webgpu'] }
  )
}

gpuTest(
  'has edges of shafts in materials where a half-plane has them',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = rowStage(renderer, ELEVATION, 'medium')
    set.atmosphere.add(set.shafts)
    airScene(set.atmosphere, set.scene)
    const displaced: number[] = []
    // Rays are 0.8° apart: at one place between them and the next.
    for (const [i, view] of VIEWS.entries()) {
      const offset = 0.8 * ((i + 0.5) / VIEWS.length)
      displaced.push(await displacement(renderer, set, view, true, offset))
    }
    set.dispose()
    t.note(displaced.map(degrees => `${degrees.toFixed(3)}°`).join(', '))
    const most = Math.max(...displaced.map(Math.abs))
    expectTrue(most <= GOAL, `edges are displaced by ${most.toFixed(3)}°`)
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'has rays opposite a sunset run together at the point opposite the sun',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = rowStage(renderer, 3, 'medium')
    for (const view of [
      [14, 166],
      [-8, 160]
    ] as const) {
      const displaced = await displacement(renderer, set, view)
      t.note(`${view[1]}° from the sun: ${displaced.toFixed(3)}°`)
      expectTrue(Math.abs(displaced) <= GOAL, `a ray is displaced by ${displaced.toFixed(3)}°`)
    }
    set.dispose()
  },
  { backends: ['webgpu'] }
)
