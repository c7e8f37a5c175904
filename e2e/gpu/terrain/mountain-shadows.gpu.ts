import { groundShadow, terrainShadow } from '@welkin/atmosphere'
import { MountainHeights, Terrain } from '@welkin/terrain'
import { Vector3 } from 'three'
import { mix, uniform } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { lookAt, marchedLoss, measuredLoss, radians } from '../harness/cloud-shafts'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { stage, stageSize as size, type Stage } from '../harness/shaft-stage'

/** A valley south of mountains, how high above its ground one stands, and the square of ground that casts shadows [m]. */
const PLACE = { longitude: 0.331, latitude: 46.305 }
const EYE = 100
const SQUARE = { width: 30_000, texels: 256, size: 512 }

/** Factor from step to step towards the sun, and the first [m]. */
const [GROWTH, FIRST] = [1.015, 40]

/** Half an edge of the ground that is looked at, half of a pixel there, and distance from which mountains are far [m]. */
const [EDGE, PIXEL, FAR] = [6000, 150, 600]

/** A stage on mountains. */
function onMountains(set: Stage): Terrain {
  set.atmosphere.place(PLACE)
  return new Terrain(set.atmosphere, new MountainHeights({ seed: 513 }), {
    resolution: 12,
    pageMemory: 20
  })
}

/** Distance from a point of the world to the first mountain of the square before the sun in the north [m]; 0 if there is none. */
function distanceToShade(terrain: Terrain, point: Vector3, sun: number): number {
  const radius = terrain.atmosphere.parameters.bottomRadius
  const toSun = new Vector3(0, Math.sin(radians(sun)), -Math.cos(radians(sun)))
  const place = new Vector3()
  for (let distance = FIRST; distance < SQUARE.width; distance *= GROWTH) {
    place.copy(point).addScaledVector(toSun, distance)
    if (Math.abs(place.z) > SQUARE.width / 2) return 0
    const altitude = Math.hypot(place.x, radius + place.y, place.z) - radius
    if (altitude < terrain.heightBelow(place)) return distance
  }
  return 0
}

gpuTest(
  "takes the light from air in the shadow of a terrain's own mountains under a low sun",
  async t => {
    const renderer = await t.createRenderer(size)
    const errors: number[] = []
    const set = stage(renderer, 4, { quality: 'reference' })
    const terrain = onMountains(set)
    const { camera, shafts } = set
    const altitude = terrain.heightBelow(camera.position) + EYE
    camera.position.y = altitude
    const mountains = groundShadow(set.atmosphere, terrain, SQUARE)
    shafts.add(mountains)
    for (const sun of [4]) {
      set.atmosphere.setSunAngles(sun, 0)
      let most = 0
      for (const view of [4, 20, 172]) {
        lookAt(set, view)
        const [up, north] = [Math.sin(radians(view)), Math.cos(radians(view))]
        const darkAt = (distance: number): number => {
          const point = new Vector3(0, altitude + up * distance, -north * distance)
          if (Math.abs(point.z) > SQUARE.width / 2) return 0
          return distanceToShade(terrain, point, sun) > 0 ? 1 : 0
        }
        const { whole, lost } = marchedLoss({ view, sun }, Infinity, darkAt, altitude)
        const got = await measuredLoss(set)
        for (let k = 0; k < 3; k++) errors.push(Math.abs(got[k] - lost[k]) / whole[k])
        const [part, found] = [lost[1] / whole[1], got[1] / whole[1]]
        t.note(`sun ${sun}°, view ${view}°: lost ${part.toFixed(4)}, got ${found.toFixed(4)}`)
        most = Math.max(most, part)
      }
      expectTrue(most > 0.05, `under a sun of ${sun}° mountains take ${most}`)
    }
    for (const owned of [mountains, terrain, set]) owned.dispose()
    const worst = Math.max(...errors)
    expectTrue(worst < 0.02, `lost light is off by ${worst}`)
  },
  // WebGL has a ridge's shadow on the ground in `light-paths`, and in the air in `atmosphere/shafts-height-field`.
  { backends: ['webgpu'] }
)

gpuTest(
  "falls on the terrain where a terrain's own mountains hide a low sun",
  async t => {
    const renderer = await t.createPlanetRenderer(size)
    const sun = 6
    const set = stage(renderer, sun)
    const terrain = onMountains(set)
    const { camera, scene, shafts, light, atmosphere } = set
    atmosphere.setSunAngles(sun, 0)
    shafts.enabled = false
    terrain.receiveShadow = true
    scene.add(terrain)
    // From above, without the shadow map of the light, which is of its middle alone.
    camera.position.y = 14_000
    camera.rotation.set(-Math.PI / 2, 0, 0)
    camera.updateMatrixWorld()
    const mountains = groundShadow(atmosphere, terrain, SQUARE)
    const node = terrainShadow(mountains, light)
    const isOpen = uniform(0)
    Object.assign(light.shadow, { shadowNode: mix(node as unknown as Node<'float'>, 1, isOpen) })
    terrain.update(renderer, camera, Infinity)
    await set.draw()
    const shaded = await set.draw()
    isOpen.value = 1
    const lit = await set.draw()
    light.intensity = 0
    const unlit = await set.draw()
    const sunlit = lit.data.map((value, i) => value - unlit.data[i])
    const mean = sunlit.reduce((sum, value) => sum + value, 0) / sunlit.length
    const { bottomRadius } = atmosphere.parameters
    /** Point of the ground, or above, from its displacement east and south of the middle [m]. */
    const pointAt = (x: number, z: number, above: number): Vector3 => {
      const point = new Vector3(x, 0, z)
      point.y = terrain.heightBelow(point) + above - (x ** 2 + z ** 2) / (2 * bottomRadius)
      return point
    }
    const found: Record<'dark' | 'lit', number[]> = { dark: [], lit: [] }
    for (let z = -EDGE; z <= EDGE; z += 500) {
      for (let x = -EDGE; x <= EDGE; x += 500) {
        const { x: right, y: up } = pointAt(x, z, 0).project(camera)
        const [column, row] = [((right + 1) / 2) * size.width, ((1 - up) / 2) * size.height].map(
          Math.floor
        )
        if (Math.min(column, row) < 0 || column >= size.width || row >= size.height) continue
        const i = 4 * (row * size.width + column) + 1
        // Slopes that face away from the sun are dark anyhow.
        if (sunlit[i] < 0.3 * mean) continue
        const part = (shaded.data[i] - unlit.data[i]) / sunlit[i]
        // Shadows of far mountains, as all the pixel has them.
        const around = [-1, 1].flatMap(south =>
          [-1, 1].map(east =>
            distanceToShade(terrain, pointAt(x + PIXEL * east, z + PIXEL * south, 5), sun)
          )
        )
        if (around.every(distance => distance > FAR)) found.dark.push(part)
        if (around.every(distance => distance === 0)) found.lit.push(part)
      }
    }
    const { dark, lit: bright } = found
    const meanOf = (parts: readonly number[]): number =>
      parts.reduce((sum, part) => sum + part, 0) / parts.length
    t.note(
      `${dark.length} dark places have ${meanOf(dark).toFixed(3)} of the light, ${bright.length} lit ones ${meanOf(bright).toFixed(3)}`
    )
    expectTrue(
      dark.length > 20 && bright.length > 12,
      `${dark.length} dark, ${bright.length} lit places`
    )
    expectTrue(meanOf(dark) < 0.1, 'dark places are dark')
    expectTrue(meanOf(bright) > 0.95, 'lit places are lit')
    for (const owned of [node, mountains, terrain, set]) owned.dispose()
  },
  // By the same look-ups as air.
  { backends: ['webgpu'] }
)
