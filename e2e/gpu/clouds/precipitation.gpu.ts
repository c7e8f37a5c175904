import { moon, raindrops, type ScatteringPhase } from '@welkin/atmosphere'
import { CloudLayers, CloudLightTable, cloudQualities, precipitationShafts } from '@welkin/clouds'
import { DataTexture, DataUtils, HalfFloatType, RGBAFormat, Vector3 } from 'three'
import { float, int, step, texture, vec3, vec4 } from 'three/tsl'
import type { WeatherMap } from '../../../packages/clouds/src/density/WeatherMap'
import { QualityUniforms } from '../../../packages/clouds/src/march/quality'
import { fallStretch } from '../../../packages/clouds/src/precipitation/tsl/fallStretch'
import {
  marchPrecipitation,
  type FallSpace
} from '../../../packages/clouds/src/precipitation/tsl/marchPrecipitation'
import { lightAt } from '../../../packages/clouds/src/light/tsl/lighting'
import {
  lightPrecipitation,
  type CloudsAbove
} from '../../../packages/clouds/src/precipitation/tsl/lightPrecipitation'
import type { CloudShadows } from '../../../packages/clouds/src/shadow/tsl/sampleShadows'
import type { Float, LevelTexture, Vec2, Vec3, Vec4 } from '../../../packages/clouds/src/tsl-types'
import { number, vector2, vector3, vector4 } from '../../../packages/clouds/src/uniforms'
import { evenClouds, mean, type CloudScene } from '../harness/cloud-scene'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Angles from the point opposite the sun: inside of the bow, in its red, in the dark band outside, and in the outer bow's red [°]. */
const ANGLES = [36, 41.8, 46, 51.3] as const
const BASE = 1500
/** It rains from here on to the east: beside the camera over the ground, everywhere in sight from above [m]. */
const EDGES = { ground: 300, above: -50_000 } as const
/** Depth of the cloud that shades it, where one does. */
const SHADE = 1000

/** Rain along a ray. */
interface SeenRain {
  /** Red light of sun or moon that it scatters once, over the irradiance of the bare sun [1/sr]. */
  readonly once: number
  /** Part of the picture's light that it scatters. */
  readonly weight: number
  /** Red light of all that it scatters, over that of drops that make no bow. */
  readonly shine: number
}

/** A look at rain. */
interface Look {
  /** Elevation of the sun, or of a full moon by night [°]. */
  readonly light: number
  readonly isMoonlit?: boolean
  /** Distance to the east from which it rains [m]. */
  readonly edge: number
  /** Length of rays [m]. */
  readonly reach: number
  /** True under clouds that let no sunlight through. */
  readonly isShaded: boolean
}

/** Rays at an angle from the point opposite the light, even around it [°]. The light is in the south, y is up, and north −z. */
function raysAround(angle: number, light: number, count: number): Vector3[] {
  const [height, away] = [(light * Math.PI) / 180, (angle * Math.PI) / 180]
  const opposite = new Vector3(0, -Math.sin(height), -Math.cos(height))
  const east = new Vector3(1, 0, 0)
  const above = east.clone().cross(opposite)
  return Array.from({ length: count }, (_, i) => {
    const around = (2 * Math.PI * (i + 0.5)) / count
    return opposite
      .clone()
      .multiplyScalar(Math.cos(away))
      .addScaledVector(above, Math.cos(around) * Math.sin(away))
      .addScaledVector(east, Math.sin(around) * Math.sin(away))
  })
}

/** Rain in the east under a layer, and how rays see it, marched and lit as in pictures. */
function rainInTheEast(
  { renderer, field, update }: Pick<CloudScene, 'renderer' | 'field' | 'update'>,
  drops: ScatteringPhase
): (rays: readonly Vector3[], look: Look) => Promise<SeenRain[]> {
  const medium = precipitationShafts({ drops })
  const light = new CloudLightTable()
  light.bake()
  const quality = new QualityUniforms()
  quality.set(cloudQualities.ultra)
  const [east, edge, reach] = [vector3(), number(), number()]
  const column = (subpoint: Vec3): Vec4 =>
    vec4(step(edge, subpoint.dot(east)).mul(1.5).sub(1), vec3(0))
  const weatherMap = { fallAt: (_: unknown, subpoint: Vec3) => column(subpoint) }
  const texel = Uint16Array.from([1, 0, SHADE, SHADE], value => DataUtils.toHalfFloat(value))
  const dark = new DataTexture(texel, 1, 1, RGBAFormat, HalfFloatType)
  dark.needsUpdate = true
  const [u, v, w] = [vector4(), vector4(), vector4()]
  // All places lie in its middle.
  u.value.set(0, 0, 0, 0.5)
  v.value.set(0, 0, 0, 0.5)
  w.value.set(0, 0, 0, 0)
  const cascade = { u, v, w, isDrawn: number(), isCast: number(), atlasTile: number() }
  const shadows: CloudShadows = {
    map: texture(dark) as unknown as LevelTexture<Vec2>,
    cascades: [cascade],
    scale: vector2(),
    isMoonlit: number()
  }
  shadows.scale.value.set(1, 1)
  const luna = moon({ phase: 0.5 })
  const above: CloudsAbove = {
    depth: float(10),
    layered: float(1),
    baseAltitude: float(BASE),
    period: float(20_000)
  }
  const map = weatherMap as unknown as WeatherMap
  const context = { field, weatherMap: map, light: light.nodes, shadows, quality }
  const space: FallSpace = {
    fallOf: index => medium.fallOf(index),
    layers: { first: int(0), last: int(1) },
    ceiling: medium.ceiling,
    width: float(1500),
    shortest: float(150)
  }
  return async (
    rays,
    { light: elevation, isMoonlit = false, edge: from, reach: end, isShaded }
  ) => {
    edge.value = from
    reach.value = end
    const { atmosphere } = field
    atmosphere.setSunAngles(elevation, 180)
    if (isMoonlit) {
      luna.direction = atmosphere.sunDirection.clone()
      atmosphere.setSunAngles(-40, 0).add(luna)
    }
    shadows.isMoonlit.value = isMoonlit ? 1 : 0
    const view = update()
    medium.update(field, view)
    cascade.isDrawn.value = isShaded ? 1 : 0
    const toMapped = (ray: Vector3): Vector3 =>
      ray.clone().applyMatrix3(view.viewToMapped).normalize()
    east.value.copy(toMapped(new Vector3(1, 0, 0)))
    const inputs = rays.map(ray => toMapped(ray).toArray().map(Math.fround))
    const results = await evaluateOnGpu(renderer, inputs, input => {
      const direction = input.xyz as unknown as Vec3
      const ray = { direction, jitter: float(0.5) }
      const altitudes = { ceiling: medium.ceiling, floor: float(-1000) }
      const stretch = fallStretch(field, altitudes, { direction, end: reach })
      const seen = marchPrecipitation(context, space, ray, stretch)
      const { up, altitude } = field.view.localCoordinates(direction)
      const source = lightAt(context, { offset: direction, up, altitude, distance: float(1) })
      const phase = drops.phase({
        cosViewLight: direction.dot(source.direction),
        cosView: direction.dot(up),
        cosLight: source.cosine
      })
      const shining = (phases: ScatteringPhase | null): Float =>
        lightPrecipitation(context, phases, direction, seen, above).w
      // What is lit by the moon has a millionth of the light.
      const shine = shining(drops).div(shining(null).max(1e-20))
      return vec4(phase.w.mul(seen.lit.x), seen.weight, shine, 0)
    })
    return rays.map((_, i) => {
      const [once, weight, shine] = results.slice(4 * i)
      return { once, weight, shine }
    })
  }
}

gpuTest(
  'rain has its bow where sun or moon and drops are, no farther, and a whole circle from above',
  async t => {
    const drops = raindrops({ rate: 8 })
    const layers = new CloudLayers([
      {
        baseAltitude: BASE,
        topAltitude: 3000,
        shapeAmount: 0,
        shear: 0,
        wind: { east: 0, north: 0 },
        precipitation: { rate: 8, freezingLevel: 9000 }
      }
    ])
    const place = { longitude: 20, latitude: 45 }
    const scene = await evenClouds(t, layers, { ...place, height: 30 })
    const look = rainInTheEast(scene, drops)
    const say = (values: readonly number[]): string =>
      values.map(value => value.toPrecision(3)).join(', ')

    const overGround = ANGLES.map(angle => raysAround(angle, 25, 60).filter(({ y }) => y > 0.02))
    const rays = overGround.flat()
    for (const [isMoonlit, isShaded] of [
      [false, false],
      [false, true],
      [true, false]
    ]) {
      const here = { light: 25, isMoonlit, edge: EDGES.ground, reach: 4000, isShaded }
      const found = await look(rays, here)
      for (const [i, { weight }] of found.entries()) {
        const isWet = rays[i].x > 0.1
        if (isWet || rays[i].x < 0) {
          expectTrue(isWet ? weight > 0.1 : weight === 0, `${weight} towards east ${rays[i].x}`)
        }
      }
      const wet = overGround.map(same =>
        same.filter(({ x }) => x > 0.1).map(ray => found[rays.indexOf(ray)])
      )
      const [inside, bow, outside, outer] = wet.map(seen =>
        mean(seen.map(({ once, weight }) => once / weight))
      )
      const shines = wet.map(seen => mean(seen.map(({ shine }) => shine)))
      const name = isMoonlit ? 'moonlit' : isShaded ? 'in shadow' : 'sunlit'
      t.note(`${name}: ${say([inside, bow, outside, outer])}, shining ${say(shines)}`)
      if (isShaded) expectTrue(bow < 1e-6, `a bow in the shadow of clouds: ${bow}`)
      else expectTrue(bow > 1.5 * inside && bow > 3 * outside, `${inside}, ${bow}, ${outside}`)
      if (!isShaded) expectTrue(outer > 3 * outside, `${outer} in the outer bow, ${outside} before`)
      // All of the light, with what is scattered more often and with that of sky and ground.
      const isBow = shines[1] > 1.1 * shines[0] && shines[1] > 1.2 * shines[2]
      expectTrue(isBow !== isShaded, `${name}: light ${say(shines)} times that without a bow`)
    }

    scene.field.atmosphere.remove(...scene.field.atmosphere.layers)
    // From an aeroplane, over rain all around.
    scene.field.atmosphere.place({ ...place, height: 5000 })
    const around = 24
    const circles = ANGLES.map(angle => raysAround(angle, 60, around))
    const found = await look(circles.flat(), {
      light: 60,
      edge: EDGES.above,
      reach: 40_000,
      isShaded: false
    })
    for (let i = 0; i < around; i++) {
      const [within, on, beyond, outer] = ANGLES.map((_, k) => found[k * around + i].once)
      expectTrue(
        on > 1.5 * within && on > 3 * beyond && outer > 3 * beyond,
        `no bow from above at ${(360 * (i + 0.5)) / around}°: ${say([within, on, beyond, outer])}`
      )
    }
    scene.dispose()
    drops.dispose()
  }
)
