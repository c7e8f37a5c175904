import { Vector3 } from 'three'
import { float, vec2, vec3, vec4 } from 'three/tsl'
import {
  LostLightGrid,
  type LostLight,
  type SeenAir
} from '../../../packages/atmosphere/src/shafts/LostLightGrid'
import {
  columnAt,
  lightRayAt,
  polarRay,
  type PolarFrame
} from '../../../packages/atmosphere/src/shafts/tsl/polarMap'
import { warpedSteps } from '../../../packages/atmosphere/src/shafts/tsl/warpedSteps'
import type { Float, Vec2, Vec3 } from '../../../packages/atmosphere/src/tsl-types'
import { warpedDistance } from '../../../packages/atmosphere/test/twins/shafts/warpedSteps'
import { random } from '../harness/atmosphere'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { parameters } from '../harness/shaft-stage'

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
      steps.partAt(steps.distance(ray.w)),
      steps.distance(float(1))
    )
  })
  rays.forEach(([altitude, cosView, length, part], i) => {
    const at = (x: number): number =>
      warpedDistance(bottomRadius + altitude, cosView, height, length, x)
    const [distance, slope, back, last] = results.subarray(4 * i, 4 * i + 4)
    const label = `ray ${rays[i].join(' ')}`
    expectClose(distance, at(part), { absolute: 2e-5 * length }, label)
    const step = 1e-5
    const [from, to] = [Math.max(part - step, 0), Math.min(part + step, 1)]
    expectClose(slope, (at(to) - at(from)) / (to - from), { relative: 2e-3 }, `${label}, slope`)
    // Where much of the ray is nearly airless, metres are few parts.
    const blur = (3e-7 * length) / slope
    expectClose(back, part, { absolute: 2e-5 + blur }, `${label}, back`)
    expectClose(last, length, { absolute: 2e-5 * length }, `${label}, last`)
  })
})

gpuTest('has a view ray in the row of the rays of light that it crosses', async t => {
  const columns = 512
  const [even, greatest] = [30, 30_000]
  const logScale = (columns - 1) / Math.log2(1 + greatest / even)
  const light = new Vector3(0.3, 0.5, -0.6).normalize()
  const across = new Vector3(0, 1, 0).cross(light).normalize()
  const along = light.clone().cross(across)
  const vector = ({ x, y, z }: Vector3): Vec3 => vec3(x, y, z)
  const frame: PolarFrame = {
    across: vector(across),
    along: vector(along),
    perMeter: float(1 / even),
    logScale: float(logScale),
    logOffset: float(0),
    size: vec2(columns, 4 * columns),
    texelSize: vec2(1 / columns, 1 / (4 * columns))
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
    const row = polar.row.add(0.5).div(4 * columns)
    return vec4(column, row.fract(), polar.cotangent, crossing)
  })
  texels.forEach(([u, v, z], i) => {
    const [column, row, cotangent, crossing] = results.subarray(4 * i, 4 * i + 4)
    const position = Math.max(u * columns - 0.5, 0)
    const distance = Math.max(even * (2 ** (position / logScale) - 1), 1e-3 * even)
    const turn = (row - v + 1.5) % 1
    expectClose((column + 0.5) / columns, u, { absolute: 2e-5 }, 'column')
    // Near the line to the light float32 has few directions.
    const blur = 3e-7 * (1 + Math.abs(z) / distance)
    expectClose(turn, 0.5, { absolute: 2e-5 + blur }, 'row')
    // As of no occluder at most, where a ray goes right away from the light.
    const expected = Math.max(z / distance, -5e4)
    const error = (2 ** -11 + 4 * blur) * (1 + Math.abs(expected))
    expectClose(cotangent, expected, { absolute: error }, 'cotangent of the angle')
    // Of sine and cosine it asks 2⁻¹¹.
    expectClose(
      crossing,
      1,
      { absolute: 2 ** -11 + 4 * blur },
      'distance from the line to the light'
    )
  })
})

/** Octaves by which light grows from a pixel to the next. */
const STEEP = 0.15

gpuTest(
  'takes the part of the light that pixels around lose, at the edges of the picture, too',
  async t => {
    const renderer = await t.createRenderer({ width: 8, height: 8 })
    const [width, height, part] = [48, 30, 0.25]
    const grid = new LostLightGrid(false)
    grid.resize(width, height, 2)
    grid.setAir(1, 1, 0, 6.36e6)
    const least = float(0) as Float
    const airTo = (distance: Float): SeenAir => ({
      rarity: grid.rarityTo(distance.reciprocal(), least),
      least
    })
    const litTo = (distance: Float): Vec3 => vec3(distance.div(1e4)).toConst()
    const march = (_: Vec2, pixel: Vec2): LostLight => {
      const air = airTo(float(1000))
      // More light in the one direction, of which as much more is lost: so steep that pixels look up their own.
      const lit = (): Vec3 => litTo(float(1000)).mul(pixel.x.add(pixel.y).mul(STEEP).exp2())
      return { lost: lit().mul(part), lit, whole: air.rarity, ...air }
    }
    grid.render(renderer, 1, march)
    // Rounding puts places a little beyond the middles of the first and the last pixels.
    const places = [0.5 - 1e-4, 0.5, width / 3, width - 0.5, width - 0.5 + 1e-4].flatMap(x =>
      [0.5 - 1e-4, 0.5, height / 3, height - 0.5, height - 0.5 + 1e-4].map(y => [
        x / width,
        y / height
      ])
    )
    const results = await evaluateOnGpu(
      renderer,
      // Nearer than all.
      places.map(([x, y]) => [x, y, 1, 0]),
      ({ x, y, z }) => vec4(grid.read(vec2(x, y), airTo(z), litTo), 0)
    )
    // The last pixel knows of no other in the corner: it takes its part of what clear air shows up to there, τ/√(1 + τ²) where τ is 1.
    const last = 0.1 * 2 ** (STEEP * (width / 2 - 1 + height / 2 - 1)) * Math.SQRT1_2
    places.forEach(([x, y], i) => {
      const isLast = x * width > width - 1 && y * height > height - 1
      const expected = part * (isLast ? last : 1e-4)
      expectClose(results[4 * i], expected, { relative: 2e-3 }, `at ${x}, ${y}`)
    })
    grid.dispose()
  }
)
