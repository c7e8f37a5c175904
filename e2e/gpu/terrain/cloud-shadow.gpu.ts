import { Atmosphere, SunDirectionalLight } from '@welkin/atmosphere'
import { CloudLayers, CloudLightTable, cloudShadow, clouds } from '@welkin/clouds'
import { Terrain, type HeightSource } from '@welkin/terrain'
import { PerspectiveCamera, Scene } from 'three'
import { float, smoothstep, vec4 } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { drawToFloat } from '../harness/atmosphere'
import { cloudTransmittance } from '../harness/cloud-transmittance'
import { mean } from '../harness/cloud-scene'
import { coarse, drawUnseen, fog, SparseNoise } from '../harness/cloud-view'
import { gpuTest, takeFineShadows } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import { levelGround } from '../harness/ground'

takeFineShadows('half')

const SIZE = { width: 32, height: 32 }

/** Height of the ground, and of the camera over it [m]. */
const GROUND = 300
const ABOVE = 900

const plateau: HeightSource = {
  ...levelGround,
  lowest: GROUND,
  highest: GROUND,
  sampleAt: (position, target) =>
    Object.assign(levelGround.sampleAt(position, target), { height: GROUND }),
  sample: () => vec4(0, 0, 0, GROUND)
}

gpuTest(
  'the ground is as dark under clouds as these let light through',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    renderer.shadowMap.enabled = true
    const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 }).setSunAngles(50, 130)
    const camera = new PerspectiveCamera(90, 1, 1, 1e7)
    camera.position.y = GROUND + ABOVE
    camera.rotation.x = -Math.PI / 2
    camera.updateMatrixWorld()
    const terrain = new Terrain(atmosphere, plateau, { pageMemory: 8, seaLevel: -Infinity })
    terrain.receiveShadow = true
    const sun = new SunDirectionalLight(atmosphere)
    const scene = new Scene().add(terrain, sun, sun.target)
    const [noise, light] = [new SparseNoise(), new CloudLightTable()]
    const layers = new CloudLayers([{ ...fog, baseAltitude: 1500, topAltitude: 2500 }])
    const node = clouds(vec4(0), float(1), camera, atmosphere, layers, {
      quality: coarse,
      noise,
      light,
      // Heaps with soft edges, without noise: half a minute less in software.
      extinction: ({ offset: { x, y, z } }) =>
        smoothstep(-0.2, 0.2, x.div(230).sin().add(y.div(310).sin()).add(z.div(270).sin())).mul(
          0.01
        )
    })
    node.time = 0
    drawUnseen(node)
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputNode = node
    terrain.update(renderer, camera, Infinity)
    const open = await t.render(renderer, scene, camera, SIZE)
    for (let frame = 0; frame < 4; frame++) {
      await nextFrame()
      await drawToFloat(renderer, () => pipeline.render())
    }
    sun.castShadow = true
    Object.assign(sun.shadow, { shadowNode: cloudShadow(node) })
    await t.render(renderer, scene, camera, SIZE)
    const shaded = await t.render(renderer, scene, camera, SIZE)

    const places: [number, number, number][] = []
    const shares: number[] = []
    for (let y = 0; y < SIZE.height; y++) {
      for (let x = 0; x < SIZE.width; x++) {
        const [across, down] = [x, y].map(n => ((2 * n + 1) / SIZE.width - 1) * ABOVE)
        places.push([across, -down, -ABOVE])
        shares.push(shaded.at(x, y)[1] / open.at(x, y)[1])
      }
    }
    const marched = await cloudTransmittance(renderer, node, light, places)
    const apart = mean(shares.map((share, i) => Math.abs(share - marched[i])))
    const dark = marched.filter(share => share < 0.3).length
    const bright = marched.filter(share => share > 0.9).length
    t.note(
      `passing ${mean(shares).toFixed(3)}, marched ${mean(marched).toFixed(3)}, apart ${apart.toFixed(3)}; ${dark} pixels dark, ${bright} bright`
    )
    pipeline.dispose()
    terrain.dispose()
    for (const made of [node, noise, light]) made.dispose()
    if (dark < 50 || bright < 50) throw new Error('there is no shadow, or nothing else')
    if (!(apart < 0.06)) throw new Error(`shadows of clouds are ${apart} off`)
  },
  // WebGL has shadows of clouds in `clouds/shadow`.
  { backends: ['webgpu'] }
)
