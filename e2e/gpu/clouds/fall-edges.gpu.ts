import { CloudLayers, CloudLightTable, CloudNoise, precipitationShafts } from '@welkin/clouds'
import { BoxGeometry, Mesh, MeshBasicMaterial, Vector3 } from 'three'
import { float, vec4 } from 'three/tsl'
import { rayWeights } from '../../../packages/clouds/src/march/tsl/rayWeights'
import { sharing } from '../../../packages/clouds/src/march/FallPass'
import { sharedWeights } from '../../../packages/clouds/test/twins/rayWeights'
import { CloudView, coarse, fog, onGround, viewSize } from '../harness/cloud-view'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

/** A layer over the camera that is seen through, and from which it rains everywhere: 700 m on, one sees next to nothing else. */
const layer = {
  ...fog,
  baseAltitude: 1500,
  topAltitude: 1800,
  density: 1e-7,
  precipitation: { rate: 50, share: 1, freezingLevel: 9000 }
}

/** Distance of a black wall, whose end parts pixels that share a ray: next to no rain is before it [m]. */
const WALL = 8

/** Column of pixels in which it ends. */
const EDGE = 15

/** Frames in which each of the pixels that share a ray has had its own. */
const FRAMES = 20

gpuTest(
  'rain whose rays pixels share ends where a wall before it does',
  async t => {
    const renderer = await t.createRenderer(viewSize)
    const places = [-0.4375, -0.25, 0, 0.25, 0.4375].flatMap(x =>
      [-0.25, 0.375].map(y => [x, y] as const)
    )
    const steps = [-1, 0, 1].flatMap(x => [-1, 0, 1].map(y => [x, y] as const))
    const cases = places.flatMap(([x, y]) => steps.map(([right, up]) => [x, y, right, up] as const))
    const weights = await evaluateOnGpu(renderer, cases, input =>
      vec4(
        rayWeights(input.xy, input.zw, float(2)),
        rayWeights(input.xy.mul(0), input.zw, float(1))
      )
    )
    cases.forEach(([x, y, right, up], i) => {
      const own = [right, up].map(step => (step === 0 ? 1 : 0))
      const shared = [sharedWeights(x).get(right) ?? 0, sharedWeights(y).get(up) ?? 0]
      const found = weights.subarray(4 * i, 4 * i + 4)
      expectClose(found, [...shared, ...own], { absolute: 1e-6 }, `${x}, ${y}, ${right}, ${up}`)
    })
    const [light, atmosphere] = [new CloudLightTable(), onGround()]
    const even = () => vec4(0.5)
    // Columns that are stronger than most: it rains.
    const noise = new CloudNoise({ weather: () => vec4(0.7), shape: even, detail: even })
    noise.update(renderer)
    // Next to no air: the sky behind is as dark as the wall.
    const next = [1e-12, 1e-12, 1e-12, 1e-12] as const
    atmosphere.parameters.set({
      rayleighScattering: next,
      mieScattering: [0, 0, 0, 0],
      mieExtinction: next,
      groundAlbedo: [0, 0, 0, 0]
    })
    /** Green in the picture: with rays of its own for each pixel, and shared by four marched ones of sixteen. */
    const draw = async (block: 1 | 2): Promise<Picture> => {
      const precipitation = precipitationShafts()
      const shared = { noise, light, precipitation }
      const quality = { ...coarse, layerSteps: 32, block }
      const view = new CloudView(renderer, atmosphere, new CloudLayers([layer]), shared, quality)
      const wall = new Mesh(new BoxGeometry(100, 200, 1), new MeshBasicMaterial({ color: 0 }))
      wall.position.set(-48, 0, -WALL - 0.5)
      view.scene.add(wall)
      view.camera.position.y = 10
      view.camera.lookAt(new Vector3(0, 0.4, -1).add(view.camera.position))
      const picture = await view.draw(FRAMES)
      view.dispose()
      wall.geometry.dispose()
      wall.material.dispose()
      return picture
    }
    // Else, pixels of so small a picture share none.
    const { from } = sharing
    sharing.from = 0
    const [own, shared] = [await draw(1), await draw(2)]
    sharing.from = from
    const { width, height } = viewSize
    const row = height / 2
    const bright = own.at(width - 2, row)[1]
    const dark = own.at(1, row)[1]
    expectTrue(bright > 5 * dark, `rain ${bright}, before the wall ${dark}`)
    let [most, where] = [0, '']
    for (let y = 0; y < height; y++) {
      for (let x = 0; x < width; x++) {
        // Clouds' own picture is soft at edges, by a pixel.
        if (x === EDGE) continue
        const apart = Math.abs(shared.at(x, y)[1] - own.at(x, y)[1]) / bright
        if (apart > most) [most, where] = [apart, `${x}, ${y}`]
      }
    }
    t.note(`apart by at most ${(100 * most).toFixed(1)} % of rain's light, at ${where}`)
    expectTrue(most < 0.2, `apart by ${most} at ${where}`)
    for (const owned of [light, noise, atmosphere]) owned.dispose()
  },
  // WebGL draws rain's rays in `clouds/precipitation`.
  { backends: ['webgpu'] }
)
