import { Atmosphere } from '@welkin/atmosphere'
import {
  CloudLayers,
  CloudLightTable,
  CloudNoise,
  cloudPreset,
  cloudsDebug,
  precipitationShafts
} from '@welkin/clouds'
import type {
  CloudLayerParameters,
  CloudPresetName,
  CloudsDebug,
  PrecipitationShafts
} from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import { Vector3 } from 'three'
import { expectLight, random } from '../harness/atmosphere'
import { CloudView, fog, viewSize } from '../harness/cloud-view'
import type { GpuContext } from '../harness/context'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { setShadowSize } from '../harness/shadow-size'

/** Random scenes, of which each draws shadow maps anew, and the least of them in which clouds are in view. */
const ROUNDS = 5
const CLOUDY = 2

const sizes = [
  [24, 14, 1],
  [1, 1, 1],
  [7, 3, 1],
  [7, 3, 2],
  [24, 14, 1]
] as const
const debugViews: (CloudsDebug | null)[] = ['density', 'steps', 'depth', 'history', null]

/** A layer of any kind, extremes more often than not. */
function randomLayer(next: () => number): Partial<CloudLayerParameters> {
  const extreme = (): number => [0, 1, next(), next()][Math.floor(4 * next())]
  const baseAltitude = next() < 0.3 ? 0 : 12_000 * next()
  const weights = [extreme(), extreme(), extreme(), extreme()] as const
  return {
    baseAltitude,
    topAltitude: baseAltitude + [0.01, 300, 12_000][Math.floor(3 * next())],
    coverage: extreme(),
    density: extreme() ** 3,
    profileExponent: [0.05, 1, 8][Math.floor(3 * next())],
    baseRelief: extreme(),
    shapeAmount: extreme(),
    detailAmount: extreme(),
    weatherScale: [0.1, 1, 10][Math.floor(3 * next())],
    shapeScale: [0.1, 1, 10][Math.floor(3 * next())],
    detailScale: [0.1, 1, 10][Math.floor(3 * next())],
    edgeSoftness: extreme(),
    turbulence: 2 * extreme(),
    shear: 5 * (extreme() - extreme()),
    anvil: extreme(),
    openCells: extreme(),
    densityGrowth: 4 * extreme(),
    weatherWeights: weights,
    wind: { east: 200 * (next() - 0.5), north: 200 * (next() - 0.5) },
    shadow: next() < 0.5
  }
}

/** A view of layers about the globe, in coordinates of its centre. */
async function cloudsOfGlobe(
  t: GpuContext,
  layers: CloudLayers,
  precipitation?: PrecipitationShafts
) {
  setShadowSize('least')
  const renderer = await t.createRenderer(viewSize)
  const atmosphere = new Atmosphere()
  atmosphere.frame = 'ecef'
  const shared = { noise: new CloudNoise(), light: new CloudLightTable() }
  const view = new CloudView(renderer, atmosphere, layers, { ...shared, precipitation })
  const dispose = (): void => {
    for (const made of [view, shared.noise, shared.light, atmosphere]) made.dispose()
  }
  return { renderer, atmosphere, view, dispose }
}

gpuTest(
  'any camera, layers, size and debug view give finite light, and clouds where there are some',
  async t => {
    const layers = new CloudLayers([fog, fog, fog, fog])
    const { renderer, atmosphere, view, dispose } = await cloudsOfGlobe(t, layers)
    const { camera, node } = view
    const debug = cloudsDebug(node, null)
    view.show(debug)
    const seed = 20_261_121
    const next = random(seed)
    let cloudy = 0
    for (let round = 0; round < ROUNDS; round++) {
      const [width, height, ratio] = sizes[round % sizes.length]
      renderer.setPixelRatio(ratio)
      renderer.setSize(width, height, false)
      camera.aspect = width / height
      const altitude = 10 ** (8 * next())
      const up = new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).normalize()
      camera.position.copy(up).multiplyScalar(Ellipsoid.WGS84.a + altitude)
      camera.up.set(next() - 0.5, next() - 0.5, next() - 0.5)
      camera.lookAt((next() - 0.5) * 1e7, (next() - 0.5) * 1e7, (next() - 0.5) * 1e7)
      camera.near = Math.max(altitude / 10, 0.5)
      camera.far = 1e9
      camera.updateProjectionMatrix()
      atmosphere.sunDirection = new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).normalize()
      for (const layer of layers) layer.set(randomLayer(next))
      const label = `seed ${seed}, round ${round}, ${altitude.toFixed(0)} m`
      node.time = 1000 * next()
      debug.view = debugViews[(round + Math.floor(round / 5)) % debugViews.length]
      expectLight(await view.draw(), `${label}, ${debug.view}`)
      debug.view = 'density'
      const { data } = await view.draw()
      expectTrue(
        data.every(value => value >= 0 && value <= 1),
        `${label}: opacities beyond 0 and 1`
      )
      if (data.some((value, i) => i % 4 < 3 && value > 0.01)) cloudy++
      if (round % 4 > 0) continue
      for (const layer of layers) layer.set({ coverage: 0 })
      node.accumulates = false
      const clear = await view.draw()
      node.accumulates = true
      const most = Math.max(...clear.data.filter((_, i) => i % 4 < 3))
      expectTrue(most === 0, `${label}: without clouds the opacity is ${most}`)
    }
    t.note(`clouds in ${cloudy} of ${ROUNDS} pictures`)
    expectTrue(cloudy >= CLOUDY, `clouds in only ${cloudy} of ${ROUNDS} pictures`)
    dispose()
  },
  { backends: ['webgpu'] }
)

/** Rain, snow and hail under towers, a deck and storms; and clouds of three kinds. */
const presets: CloudPresetName[] = ['snowShower', 'nimbostratus', 'hailstorm', 'mixed']

gpuTest(
  'clouds of a preset give finite light from any camera at any time',
  async t => {
    const layers = new CloudLayers([{}, {}, {}])
    const medium = precipitationShafts()
    const { renderer, atmosphere, view, dispose } = await cloudsOfGlobe(t, layers, medium)
    const { camera, node } = view
    camera.far = 1e9
    camera.updateProjectionMatrix()
    node.accumulates = false
    await node.bake(renderer)
    const { shadows } = node
    const update = shadows.update.bind(shadows)
    const next = random(11)
    let changed = 0
    for (const [i, preset] of presets.entries()) {
      const own = cloudPreset(preset)
      // Below, among and above the clouds, and from space.
      const altitude = [2, 1500, 12_000, 4e5 + 3e7 * next()][i]
      const direction = new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).normalize()
      camera.position.copy(direction).multiplyScalar(Ellipsoid.WGS84.a + altitude)
      camera.up.set(next() - 0.5, next() - 0.5, next() - 0.5)
      camera.lookAt(new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).multiplyScalar(1e7))
      atmosphere.date = new Date(Date.UTC(2026, 0, 1) + next() * 3.15e10)
      node.time = 1e5 * next()
      const pictures = []
      for (const coverage of [0, next()]) {
        for (let k = 0; k < layers.length; k++) {
          const { parameters } = own.at(Math.min(k, own.length - 1))
          layers.at(k).set({ ...parameters, coverage: k < own.length ? coverage : 0 })
        }
        // No cloud casts a shadow in the picture without.
        shadows.update = coverage > 0 ? update : () => undefined
        const picture = await view.draw()
        expectLight(picture, `${preset}, ${altitude} m`)
        pictures.push(picture.data)
      }
      const [clear, cloudy] = pictures
      if (cloudy.some((value, i) => Math.abs(value - clear[i]) > 1e-3)) changed++
    }
    t.note(`clouds change ${changed} of ${presets.length} pictures`)
    expectTrue(changed >= 2, `clouds change only ${changed} of ${presets.length} pictures`)
    dispose()
  },
  { backends: ['webgpu'] }
)
