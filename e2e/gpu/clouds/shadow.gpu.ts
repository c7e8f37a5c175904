import { Atmosphere, SunDirectionalLight } from '@welkin/atmosphere'
import {
  CloudLayers,
  CloudLightTable,
  CloudNoise,
  cloudPreset,
  cloudShadow,
  clouds,
  precipitationShafts
} from '@welkin/clouds'
import {
  MathUtils,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3
} from 'three'
import { float, vec4 } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { CloudField } from '../../../packages/clouds/src/density/CloudField'
import { CloudShadowMap } from '../../../packages/clouds/src/shadow/CloudShadowMap'
import { sampleShadows } from '../../../packages/clouds/src/shadow/tsl/sampleShadows'
import { loop, type Vec3 } from '../../../packages/clouds/src/tsl-types'
import { fallForm } from '../../../packages/clouds/src/precipitation/fallForm'
import { NoiseTextures } from '../../../packages/clouds/test/twins/noiseTextures'
import { extinctionOf, fallenRank, rateOf } from '../../../packages/clouds/test/twins/precipitation'
import { cloudExtinction } from '../harness/cloud-extinction'
import { cloudScene, offsets } from '../harness/cloud-scene'
import { cloudTransmittance } from '../harness/cloud-transmittance'
import { drawUnseen } from '../harness/cloud-view'
import { drawToFloat, random } from '../harness/atmosphere'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectTrue } from '../harness/expect'
import { gpuTest, takeFineShadows } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'

takeFineShadows('half')

const size = { width: 48, height: 48 }

gpuTest('clouds cast their shadows on the ground', async t => {
  const renderer = await t.createRenderer(size)
  renderer.shadowMap.enabled = true
  const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 }).setSunAngles(50, 130)
  const camera = new PerspectiveCamera(90, 1, 1, 1e5)
  camera.position.set(0, 900, 0)
  camera.rotation.set(-Math.PI / 2, 0, 0)
  camera.updateMatrixWorld()
  const scene = new Scene()
  const ground = new Mesh(new PlaneGeometry(1e4, 1e4), new MeshLambertMaterial())
  ground.rotation.x = -Math.PI / 2
  ground.receiveShadow = true
  const sun = new SunDirectionalLight(atmosphere)
  scene.add(ground, sun)
  const layers = cloudPreset('fairWeather')
  layers.at(0).set({ coverage: 0.55 })
  const [noise, light] = [new CloudNoise(), new CloudLightTable()]
  const node = clouds(vec4(0), float(1), camera, atmosphere, layers, {
    quality: 'low',
    noise,
    light
  })
  node.time = 0
  drawUnseen(node)
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputNode = node
  const draw = () => t.render(renderer, scene, camera, size)

  const open = await draw()
  for (let i = 0; i < 4; i++) {
    await nextFrame()
    await drawToFloat(renderer, () => pipeline.render())
  }
  sun.castShadow = true
  Object.assign(sun.shadow, { shadowNode: cloudShadow(node) })
  const shaded = await draw()

  const places: [number, number, number][] = []
  const got: number[] = []
  for (let y = 0; y < size.height; y++) {
    for (let x = 0; x < size.width; x++) {
      const across = ((2 * x + 1) / size.width - 1) * 900
      const down = ((2 * y + 1) / size.height - 1) * 900
      // Where the camera sees it, in view space.
      places.push([across, -down, -900])
      got.push(shaded.at(x, y)[1] / open.at(x, y)[1])
    }
  }
  const expected = await cloudTransmittance(renderer, node, light, places)
  const mean = (values: readonly number[]): number =>
    values.reduce((sum, value) => sum + value, 0) / values.length
  const apart = mean(got.map((value, i) => Math.abs(value - expected[i])))
  t.note(
    `passing ${mean(got).toFixed(3)}, marched ${mean(expected).toFixed(3)}, apart ${apart.toFixed(3)}`
  )
  const [least, most] = [Math.min(...expected), Math.max(...expected)]
  expectTrue(least < 0.1 && most > 0.9, `there are no shadows to compare: ${least} to ${most}`)
  expectTrue(Math.abs(mean(got) - mean(expected)) < 0.03, `the mean is ${mean(got)}`)
  expectTrue(apart < 0.06, `shadows are off by ${apart} in the mean`)

  layers.at(0).set({ shadow: false })
  // Three cascades, in four strips each.
  for (let i = 0; i < 12; i++) {
    await nextFrame()
    await drawToFloat(renderer, () => pipeline.render())
  }
  const unshaded = await draw()
  const lost = open.data.findIndex((value, i) => unshaded.data[i] < 0.999 * value)
  expectTrue(lost < 0, `a layer without shadow takes light from channel ${lost}`)
  pipeline.dispose()
  node.dispose()
  noise.dispose()
  light.dispose()
  atmosphere.dispose()
})

gpuTest(
  'towers are as deep in their shadow maps as along the sun',
  async t => {
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere()
    const camera = new PerspectiveCamera(60, 1, 1, 1e5)
    camera.position.set(0, 450, 0)
    camera.updateMatrixWorld()
    const field = new CloudField(atmosphere, cloudPreset('cumulonimbus'))
    field.layers.at(0).set({ coverage: 0.6 })
    field.bake(renderer)
    const shadows = new CloudShadowMap(field)
    const next = random(5)
    const places = Array.from({ length: 1500 }, () => {
      const [x, y, z] = [next() - 0.5, next(), next() - 0.5]
      return [30_000 * x, 500 + 9000 * y, 30_000 * z, 0]
    })
    const depths: number[][] = []
    // Storms of two regions: each has its own share of edges.
    for (const longitude of [20, -100]) {
      atmosphere.place({ longitude, latitude: 45 }).setSunAngles(28, 130)
      const view = atmosphere.update(renderer, camera)
      field.view.update({ camera })
      field.update(view, 0)
      shadows.update(renderer, view)
      const found = await evaluateOnGpu(renderer, places, input => {
        const start = field.view.toMapped(input.xyz).toConst() as Vec3
        const marched = float(0).toVar()
        loop('step', 200, index => {
          // Steps grow on the way.
          const [from, to] = [float(index), float(index).add(1)].map(at => at.mul(at).mul(0.5))
          const distance = from.add(to).mul(0.5)
          const offset = start.add(field.view.lightDirection.mul(distance)).toConst() as Vec3
          const sample = {
            offset,
            ...field.view.localCoordinates(offset),
            distance: float(15_000).toConst()
          }
          marched.addAssign(cloudExtinction(field, sample, false).mul(to.sub(from)))
        })
        const { toLight, through, inMap } = sampleShadows(shadows.nodes, start)
        return vec4(toLight, marched, through, inMap)
      })
      places.forEach((_, i) => depths.push([found[4 * i], found[4 * i + 1]]))
    }
    let [apart, lit, wronglyDark, dark, wronglyLit] = [0, 0, 0, 0, 0]
    for (const [got, expected] of depths) {
      apart += Math.abs(Math.log((1 + got) / (1 + expected))) / depths.length
      if (expected < 1) lit++
      if (expected < 1 && got > 10) wronglyDark++
      if (expected > 30) dark++
      if (expected > 30 && got < 3) wronglyLit++
    }
    t.note(`apart ${apart.toFixed(3)}, ${wronglyDark} of ${lit} dark, ${wronglyLit} of ${dark} lit`)
    expectTrue(lit > 200 && dark > 200, `${lit} lit places, ${dark} dark ones`)
    expectTrue(apart < 0.35, `logarithms of depth are off by ${apart} in the mean`)
    expectTrue(wronglyDark < 0.01 * lit, `${wronglyDark} of ${lit} lit places are dark`)
    expectTrue(wronglyLit < 0.02 * dark, `${wronglyLit} of ${dark} dark places are lit`)
    shadows.dispose()
    field.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'what falls shades the ground as deep as float64 says',
  async t => {
    const falls = { rate: 12, share: 0.7, freezingLevel: 600 }
    const [base, top] = [1000, 2000]
    // Clouds so thin that what falls is all.
    const layers = new CloudLayers([
      {
        baseAltitude: base,
        topAltitude: top,
        coverage: 0.8,
        density: 1e-6,
        shapeAmount: 0,
        wind: { east: 12, north: -5 },
        precipitation: falls
      }
    ])
    const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
    const { field, viewpoint, renderer } = scene
    field.atmosphere.setSunAngles(89.9, 0)
    const view = scene.update()
    const medium = precipitationShafts()
    medium.update(field, view)
    const shadows = new CloudShadowMap(field, medium)
    shadows.update(renderer, view)
    const places = offsets(viewpoint, 60, 4000, 21, () => 5)
    const found = await evaluateOnGpu(renderer, places, input => {
      const { toLight, inMap } = sampleShadows(shadows.nodes, input.xyz.toConst())
      return vec4(toLight.mul(field.depthScale), inMap, 0, 0)
    })
    const state = scene.state()
    const noise = new NoiseTextures()
    const ceiling = base + fallForm.onset * (top - base)
    const footprint = (ceiling * 0.03) / field.pixelAngle.value
    const slices = 60
    const depths = places.map(([x, y, z]) => {
      const up = viewpoint
        .clone()
        .add(new Vector3(x, y, z))
        .normalize()
      let depth = 0
      for (let k = 0; k < slices; k++) {
        const altitude = (ceiling * (k + 0.5)) / slices
        const at = up.clone().multiplyScalar(state.bottomRadius + altitude)
        const rank = fallenRank(state, noise, 0, at, footprint)
        const onset = Math.min((ceiling - altitude) / (ceiling - base), 1)
        const rate = rank > 0 ? onset * rateOf(falls.rate, rank, 0, 0) : 0
        const snow = MathUtils.smoothstep(altitude, 600 - fallForm.melting, 600)
        // Half of what is taken is only diffracted, and goes on.
        depth += (0.5 * extinctionOf(rate, snow, 0) * ceiling) / slices
      }
      return depth
    })
    const deepest = Math.max(...depths)
    const worst = Math.max(...depths.map((depth, i) => Math.abs(found[4 * i] - depth)))
    t.note(`deepest ${deepest.toFixed(2)}, off by at most ${worst.toFixed(3)}`)
    expectTrue(depths.filter(depth => depth > 0.05).length > 15, 'rain at most places')
    expectTrue(worst < 0.05 * deepest, `depths are off by ${worst} of ${deepest}`)
    shadows.dispose()
    scene.dispose()
  },
  { backends: ['webgpu'] }
)
