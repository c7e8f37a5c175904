import { Atmosphere, aerialPerspective } from '@welkin/atmosphere'
import {
  CloudLightTable,
  CloudNoise,
  cloudPreset,
  clouds,
  type CloudPresetName,
  type CloudQuality
} from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import { PerspectiveCamera, Scene, Vector3 } from 'three'
import { pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { drawToFloat, random } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const [width, height] = [32, 18]
/** Coarse: what is tested here does not depend on steps. */
const quality: CloudQuality = {
  steps: 48,
  stepGrowth: 0.06,
  shortestStep: 40,
  layerSteps: 6,
  lightSteps: 2,
  block: 2
}
const presets: CloudPresetName[] = ['fairWeather', 'overcast', 'cumulonimbus', 'mixed']

gpuTest(
  'clouds give finite light from any camera at any time',
  async t => {
    const renderer = await t.createRenderer({ width, height })
    const [noise, light] = [new CloudNoise(), new CloudLightTable()]
    const next = random(11)
    let changed = 0
    for (const preset of presets) {
      const atmosphere = new Atmosphere()
      atmosphere.frame = 'ecef'
      const camera = new PerspectiveCamera(60, width / height, 1, 1e9)
      const scenePass = pass(new Scene(), camera, { samples: 0 })
      const depth = scenePass.getTextureNode('depth')
      const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
      const layers = cloudPreset(preset)
      const node = clouds(air, depth, camera, atmosphere, layers, { quality, noise, light })
      const pipeline = new RenderPipeline(renderer)
      pipeline.outputColorTransform = false
      pipeline.outputNode = node
      for (let round = 0; round < 4; round++) {
        // Below, among and above the clouds, and from space.
        const altitude = [2, 1500, 12_000, 4e5 + 3e7 * next()][round]
        const direction = new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).normalize()
        camera.position.copy(direction).multiplyScalar(Ellipsoid.WGS84.a + altitude)
        camera.up.set(next() - 0.5, next() - 0.5, next() - 0.5)
        const target = new Vector3(next() - 0.5, next() - 0.5, next() - 0.5).multiplyScalar(1e7)
        camera.lookAt(target)
        camera.updateMatrixWorld()
        atmosphere.date = new Date(Date.UTC(2026, 0, 1) + next() * 3.15e10)
        node.time = 1e5 * next()
        const pictures = []
        for (const coverage of [0, next()]) {
          for (const layer of layers) layer.set({ coverage })
          const { data } = await drawToFloat(renderer, () => pipeline.render())
          const wrong = data.findIndex(value => !(value >= 0 && value < 1e6))
          expectTrue(wrong < 0, `${preset}, ${altitude} m: ${data[wrong]} at ${wrong}`)
          pictures.push(data)
        }
        const [clear, cloudy] = pictures
        if (cloudy.some((value, i) => Math.abs(value - clear[i]) > 1e-3)) changed++
      }
      pipeline.dispose()
      node.dispose()
      atmosphere.dispose()
    }
    expectTrue(changed >= 6, `clouds change only ${changed} of 16 pictures`)
    noise.dispose()
    light.dispose()
  },
  { timeoutSeconds: 300 }
)
