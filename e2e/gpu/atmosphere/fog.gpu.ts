import {
  airStyle,
  Atmosphere,
  distanceFog,
  droplets,
  heightFog,
  moon,
  raindrops,
  skyBackground,
  type HeightFog
} from '@welkin/atmosphere'
import {
  BoxGeometry,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3
} from 'three'
import { float } from 'three/tsl'
import * as twin from '../../../packages/atmosphere/test/twins/fog/heightFog'
import {
  airMass,
  fogDepth,
  multipleScattering
} from '../../../packages/atmosphere/src/fog/tsl/heightFog'
import { erfcx } from '../../../packages/atmosphere/src/fog/tsl/erfcx'
import {
  drawForward,
  expectLight,
  postPath,
  random,
  relativeDifferences
} from '../harness/atmosphere'
import type { GpuContext } from '../harness/context'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const BOTTOM = 6_378_137
const size = { width: 48, height: 27 }
const luminance = ([r, g, b]: readonly number[]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b

gpuTest('has the optical depth of its float64 twin', async t => {
  const next = random(31)
  const layer = { density: 0.01, falloff: 50, base: 100 }
  const rays = Array.from({ length: 600 }, () => {
    const height = (next() * 8 - 1) * layer.falloff
    const cosView = (next() * 2 - 1) ** 3
    const radius = BOTTOM + layer.base + height
    const down = -radius * cosView
    const limit = cosView < 0 ? ((height + 4 * layer.falloff) / -cosView) * 0.9 : 1e6
    return [height, cosView, Math.min(10 ** (next() * 5), limit, down > 0 ? 2e5 : 1e6), 0]
  })
  const actual = await t.evaluate(rays, ray => {
    const nodes = { density: float(layer.density), falloff: float(layer.falloff) }
    return fogDepth(nodes, ray.x, ray.x.add(BOTTOM + layer.base), ray.y, ray.z).depth
  })
  let worst = 0
  rays.forEach(([height, cosView, distance], i) => {
    const expected = twin.fogDepth(layer, BOTTOM + layer.base + height, cosView, BOTTOM, distance)
    const error = Math.abs(actual[4 * i] - expected)
    worst = Math.max(worst, error / (expected + 0.01))
    const label = `height ${height.toFixed(1)}, μ ${cosView.toFixed(5)}, ${distance.toFixed(1)} m`
    expectClose(actual[4 * i], expected, { relative: 2e-3, absolute: 5e-5 }, label)
  })
  t.note(`worst ${(100 * worst).toFixed(3)} %`)
})

gpuTest('has the error function and the multiple scattering of their twins', async t => {
  const next = random(5)
  const inputs = Array.from({ length: 200 }, () => [
    10 ** (next() * 6 - 3),
    next() * 3,
    next() * 3,
    0.003 + next() * 0.997
  ])
  const values = await t.evaluate(inputs, input => erfcx(input.x))
  const light = await t.evaluate(inputs, ({ y, z, w }) => multipleScattering(y, y.add(z), w))
  const mass = await t.evaluate(inputs, ({ w }) => airMass(float(1e5), w))
  inputs.forEach(([x, above, below, cosLight], i) => {
    expectClose(values[4 * i], twin.erfcx(x), { relative: 2e-5 }, `erfcx ${x}`)
    const expected = twin.multipleScattering(above, above + below, cosLight)
    expectClose(light[4 * i], expected, { absolute: 2e-6, relative: 1e-4 }, `light ${i}`)
    // The sphere hardly counts away from the horizon.
    if (cosLight > 0.1)
      expectClose(mass[4 * i], 1 / cosLight, { relative: 2e-3 }, `mass ${cosLight}`)
  })
})

/** Boxes from near to far on a plain, and a camera that looks along it. */
function plainScene(): { scene: Scene; camera: PerspectiveCamera } {
  const scene = new Scene()
  // No vertex right below the camera, where w is 0: software rasterisers take that ill.
  const ground = new PlaneGeometry(40_000, 40_000, 63, 63).rotateX(-Math.PI / 2)
  scene.add(new Mesh(ground, new MeshBasicMaterial({ color: 0x446633 })))
  for (let i = 0; i < 8; i++) {
    const box = new Mesh(new BoxGeometry(1, 1, 1), new MeshLambertMaterial({ emissive: 0x662211 }))
    const distance = 20 * 2.4 ** i
    box.scale.setScalar(distance / 6)
    box.position.set((i - 3.5) * distance * 0.17, distance / 12, -distance)
    scene.add(box)
  }
  const camera = new PerspectiveCamera(50, size.width / size.height, 0.5, 1e5)
  camera.position.y = 12
  return { scene, camera }
}

/** Heights of a camera [m], elevations of the sun [°], and bases of fog [m]. */
const anyCase = [
  [12, 30, 0],
  [1, 2, 0],
  [150, 5, 0],
  [3, -4, 0],
  // The base above and far above the camera.
  [5, 30, 100],
  [5, 30, 3000]
] as const

/** Draws a fog by both paths. */
async function compareByPaths(
  t: GpuContext,
  atmosphere: Atmosphere,
  mist: HeightFog,
  cases: readonly (readonly [height: number, elevation: number, base: number])[]
): Promise<void> {
  const renderer = await t.createRenderer(size)
  const { scene, camera } = plainScene()
  // Rasterisers place a fragment to a sixteenth of a pixel: of few, that shows in the glow about the sun.
  camera.fov = 20
  camera.updateProjectionMatrix()
  atmosphere.add(distanceFog({ density: 1e-4 }), mist)
  const post = postPath(renderer, scene, camera, atmosphere)
  let worst = 0
  for (const [height, elevation, base] of cases) {
    camera.position.y = height
    atmosphere.setSunAngles(elevation, 40)
    mist.set({ base })
    const forward = await drawForward(renderer, scene, camera, atmosphere)
    const effect = await post.draw()
    const label = `at ${height} m, sun at ${elevation}°, base at ${base} m`
    expectLight(forward, label)
    expectLight(effect, `${label}, post`)
    const differences = relativeDifferences(forward, effect)
    const p95 = differences[Math.floor(0.95 * differences.length)]
    worst = Math.max(worst, p95)
    expectTrue(p95 < 0.01, `${label}: 95th percentile of the difference ${p95}`)
  }
  t.note(`95th percentile at most ${(100 * worst).toFixed(2)} %`)
  post.dispose()
  atmosphere.dispose()
}

gpuTest(
  'is the same in front of things by both paths, at any height and time',
  async t => {
    // Droplets have structure in all directions.
    const mist = heightFog({ base: 0, falloff: 20, density: 0.01, droplets: droplets() })
    await compareByPaths(t, new Atmosphere(), mist, anyCase)
  },
  // *Fog valley* has fog on both.
  { backends: ['webgpu'] }
)

gpuTest(
  'reads its light from a table in post effects as materials compute it',
  async t => {
    const atmosphere = new Atmosphere()
    const luna = moon({ mapSize: 64 })
    atmosphere.add(luna)
    luna.direction = new Vector3(0.3, 0.5, -0.8).normalize()
    const mist = heightFog({ base: 0, falloff: 20, density: 0.01, sources: [luna.source] })
    await compareByPaths(t, atmosphere, mist, anyCase.slice(1, 4))
  },
  { backends: ['webgpu'] }
)

/** Bows: angles from the point opposite the light inside of one, in it, and outside [°]. */
const bows = [
  {
    name: 'droplets in sunlight',
    make: () => droplets({ radius: 10 }),
    isMoonlit: false,
    angles: [
      [28, 32],
      [36, 40],
      [44, 48]
    ]
  },
  {
    name: 'rain in moonlight',
    make: () => raindrops({ rate: 8 }),
    isMoonlit: true,
    angles: [
      [32, 37],
      [39.5, 42.5],
      [44, 49]
    ]
  }
] as const

gpuTest(
  'of droplets has a bow 38° from the point opposite the sun, rain one of 41° by the moon',
  async t => {
    const renderer = await t.createRenderer(size)
    const scene = new Scene()
    const camera = new PerspectiveCamera(90, size.width / size.height, 0.5, 1e5)
    camera.position.y = 30
    camera.rotation.x = 0.3
    camera.updateMatrixWorld()
    for (const { name, make, isMoonlit, angles } of bows) {
      const atmosphere = new Atmosphere().setSunAngles(12, 180)
      const light = atmosphere.sunDirection.clone()
      const luna = moon({ direction: light, phase: 0.5, mapSize: 64 })
      if (isMoonlit) atmosphere.setSunAngles(-40, 0).add(luna)
      const sources = isMoonlit ? [luna.source] : []
      const drops = make()
      const fog = { falloff: 200, density: 2e-3, sources }
      const mist = heightFog({ ...fog, droplets: drops })
      const smooth = heightFog({ ...fog, asymmetry: drops.asymmetry })
      const opposite = light.negate()
      atmosphere.add(mist)
      const drawn = await drawForward(renderer, scene, camera, atmosphere)
      expectLight(drawn, name)
      atmosphere.remove(mist).add(smooth)
      const without = await drawForward(renderer, scene, camera, atmosphere)
      const point = new Vector3()
      /** Light over that of smooth fog, 2 to 25° above the horizon, between angles from the point opposite the light [°]. */
      const mean = ([from, to]: readonly [number, number]): number => {
        let [sum, count] = [0, 0]
        for (let y = 0; y < size.height; y++) {
          for (let x = 0; x < size.width; x++) {
            point.set((2 * x + 1) / size.width - 1, 1 - (2 * y + 1) / size.height, 0.5)
            point.unproject(camera).sub(camera.position).normalize()
            const angle = (point.angleTo(opposite) * 180) / Math.PI
            if (point.y < 0.035 || point.y > 0.42 || angle < from || angle > to) continue
            sum += luminance(drawn.at(x, y)) / luminance(without.at(x, y))
            count++
          }
        }
        expectTrue(count > 5, `${count} pixels from ${from} to ${to}°`)
        return sum / count
      }
      const [inside, bow, outside] = angles.map(mean)
      t.note(
        `${name}: ${inside.toFixed(3)} inside, ${bow.toFixed(3)} in it, ${outside.toFixed(3)} outside`
      )
      expectTrue(bow > 1.03 * inside && bow > 1.1 * outside, `${inside}, ${bow}, ${outside}`)
      drops.dispose()
      atmosphere.dispose()
    }
  },
  // What is read, and the sums with it, other tests hold on both.
  { backends: ['webgpu'] }
)

gpuTest(
  'thickens towards the ground, and hides what is far away in its own light',
  async t => {
    const renderer = await t.createRenderer(size)
    const { scene, camera } = plainScene()
    const atmosphere = new Atmosphere().setSunAngles(40, 90)
    const mist = heightFog({ base: 0, falloff: 20, density: 0 })
    atmosphere.add(mist)
    scene.backgroundNode = skyBackground(atmosphere)
    const clear = await drawForward(renderer, scene, camera, atmosphere)
    mist.set({ density: 0.05 })
    const thick = await drawForward(renderer, scene, camera, atmosphere)
    // What is 500 m away and more, and the sky close above it, are one.
    const [ground, sky] = [luminance(thick.at(4, 14)), luminance(thick.at(4, 12))]
    expectClose(ground, sky, { relative: 0.05 }, 'ground beside sky at the horizon')
    expectTrue(Math.abs(luminance(clear.at(4, 14)) / luminance(clear.at(4, 12)) - 1) > 0.2, 'clear')
    // As bright as white paper in this sun, about: fog absorbs nothing.
    t.note(`fog ${sky.toFixed(3)}, clear sky there ${luminance(clear.at(4, 12)).toFixed(3)}`)
    expectTrue(sky > 0.1 && sky < 0.9, `fog is ${sky}`)
    // From above it, the sky is clear.
    camera.position.y = 400
    mist.set({ density: 0 })
    const without = await drawForward(renderer, scene, camera, atmosphere)
    mist.set({ density: 0.05 })
    const above = await drawForward(renderer, scene, camera, atmosphere)
    expectClose(luminance(above.at(24, 2)), luminance(without.at(24, 2)), { relative: 1e-3 }, 'sky')
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'is not there from orbit',
  async t => {
    const renderer = await t.createRenderer(size)
    const camera = new PerspectiveCamera(60, size.width / size.height, 1000, 1e8)
    camera.position.y = 4e5
    camera.rotation.x = -0.4
    const atmosphere = new Atmosphere()
    const clear = await drawForward(renderer, new Scene(), camera, atmosphere)
    atmosphere.add(heightFog({ density: 0.1 }), distanceFog({ density: 1e-3 }))
    const fog = await drawForward(renderer, new Scene(), camera, atmosphere)
    expectClose(fog.data, clear.data, { absolute: 1e-6, relative: 1e-5 }, 'pixel')
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'by distance gives far things the colour of the sky behind them',
  async t => {
    const renderer = await t.createRenderer(size)
    const { scene, camera } = plainScene()
    // A row of pixels is 0.04°: at dusk the sky changes by 4 % in 0.1° above the horizon. Ground ends 20 km away.
    camera.fov = 1
    camera.updateProjectionMatrix()
    const style = airStyle()
    const atmosphere = new Atmosphere().add(style, distanceFog({ density: 1 / 300 }))
    for (const [elevation, azimuth, saturation] of [
      [30, 0, 1],
      [2, 20, 1],
      [-5, 300, 0.3]
    ] as const) {
      atmosphere.setSunAngles(elevation, azimuth)
      style.twilightSaturation = saturation
      const picture = await drawForward(renderer, scene, camera, atmosphere)
      for (const x of [3, 12, 44]) {
        const [below, above] = [picture.at(x, 15), picture.at(x, 12)].map(([r, g, b]) => [r, g, b])
        const label = `sun at ${elevation}°, column ${x}`
        expectClose(luminance(below), luminance(above), { relative: 0.05 }, label)
        expectClose(below, above, { relative: 0.08 }, label)
      }
    }
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)
