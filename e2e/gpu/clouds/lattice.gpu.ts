import { Atmosphere } from '@welkin/atmosphere'
import { CloudLayers, CloudNoise, cloudPreset, cloudQualities, clouds } from '@welkin/clouds'
import { PerspectiveCamera, Vector3, type Quaternion } from 'three'
import { float, vec4 } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { latticeRotations } from '../../../packages/clouds/src/density/lattice'
import { drawToFloat } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest, takeFineShadows } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import { alignment, contrasts, placeIn, straighten, type SkySquare } from '../harness/sky-plane'

takeFineShadows('half')

const canvas = { width: 168, height: 140 }
/** Edge of the straightened picture [pixels]. */
const size = 112
/** Altitude that decks are raised to, so that there are many clouds in a picture [m]. */
const BASE = 4000
/** Distance between their billows: four in a period of the shape [m]. */
const BILLOWS = 650
/** Half of the width that contrasts are against the mean of [pixels]. */
const ABOUT = 10

interface View {
  readonly name: string
  readonly fov: number
  readonly pitch: number
  readonly square: SkySquare
  /** Least number of waves to an edge of the square. */
  readonly longest: number
}

const views: readonly View[] = [
  {
    name: 'straight up',
    fov: 132,
    pitch: 90,
    square: { altitude: BASE, x: 0, z: 0, width: 17_000 },
    longest: 8
  },
  {
    name: 'towards the sun',
    fov: 66,
    pitch: 34,
    square: { altitude: BASE, x: 0, z: -8000, width: 8000 },
    longest: 5
  }
]

const degrees = Math.PI / 180

/** Directions in the sky, from x towards z, in which the axes of the noise's lattices lie [rad]. */
function axesOf(atmosphere: Atmosphere, turn: Quaternion): Map<string, number> {
  const inMapped = (x: number, z: number): Vector3 =>
    atmosphere.space.direction(new Vector3(x, 0, z), new Vector3())
  const [right, back] = [inMapped(1, 0), inMapped(0, 1)]
  const axes = new Map<string, number>()
  for (const [name, rotation] of Object.entries(latticeRotations)) {
    for (const axis of [0, 1, 2]) {
      const normal = new Vector3()
        .setComponent(axis, 1)
        .applyQuaternion(rotation.clone().invert())
        .applyQuaternion(turn.clone().invert())
      axes.set(`${name} ${'xyz'[axis]}`, Math.atan2(normal.dot(back), normal.dot(right)))
    }
  }
  return axes
}

gpuTest(
  'shows no rows of clouds in marched skies, from below and towards the sun',
  async t => {
    const renderer = await t.createRenderer(canvas)
    const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 })
    // A lower sun draws the shadows of their tops out into streaks along its azimuth, which are no rows.
    atmosphere.setSunAngles(40, 0)
    const camera = new PerspectiveCamera(60, canvas.width / canvas.height, 1, 1e5)
    camera.position.y = 2
    const layers = new CloudLayers()
    const noise = new CloudNoise()
    // Rows of the clouds are looked for, not those of the noise of long steps.
    const quality = { ...cloudQualities.high, lightSteps: 1, block: 1 }
    const node = clouds(vec4(0), float(1), camera, atmosphere, layers, {
      quality,
      noise
    })
    node.time = 0
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = node
    const misses: string[] = []
    // Each view by the clouds that fill it: a deck towards the sun, patches straight up.
    for (const [i, name] of (['stratocumulus', 'overcast'] as const).entries()) {
      const { parameters } = cloudPreset(name).at(0)
      const topAltitude = BASE + parameters.topAltitude - parameters.baseAltitude
      layers.at(0).set({ ...parameters, baseAltitude: BASE, topAltitude })
      for (const { name: view, fov, pitch, square, longest } of [views[i]]) {
        camera.fov = fov
        camera.rotation.x = pitch * degrees
        camera.updateProjectionMatrix()
        camera.updateMatrixWorld()
        for (let i = 0; i < 2; i++) {
          await nextFrame()
          pipeline.render()
        }
        await nextFrame()
        const picture = await drawToFloat(renderer, () => pipeline.render())
        const light = straighten(picture, camera, square, size)
        const axes = axesOf(atmosphere, node.field.rotations[0])
        const seen = contrasts(light, size, ABOUT)
        const sky = alignment(seen.values, size, longest)
        const along = [...axes].map(([axis, angle]) => ({ axis, power: sky.along(angle) }))
        const worst = along.reduce((a, b) => (a.power > b.power ? a : b))
        const any = Math.max(...Array.from({ length: 60 }, (_, i) => sky.along(3 * i * degrees)))

        // For comparison: with rows along an axis of the shape, no stronger than what is seen.
        const angle = axes.get('shape x') ?? 0
        const [dx, dz] = [Math.cos(angle), Math.sin(angle)]
        const rowsOf = (value: number, i: number): number => {
          const [x, z] = placeIn(square, size, i)
          return (
            value * (1 + seen.deviation * Math.sin((2 * Math.PI * (x * dx + z * dz)) / BILLOWS))
          )
        }
        const rows = alignment(contrasts(light.map(rowsOf), size, ABOUT).values, size, longest)
        const { ratio, wave } = sky.peak
        t.note(
          `${name} ${view}: contrast ${seen.deviation.toFixed(3)}, peak ${ratio.toFixed(1)}, along ${worst.axis} ${worst.power.toFixed(2)}, along any line ${any.toFixed(2)}; with rows ${rows.peak.ratio.toFixed(0)}, ${rows.along(angle).toFixed(1)}`
        )
        // Of noise without a lattice, the highest of 1,500 powers is 8 to 14, of lines about 2.
        if (!(ratio < 18)) misses.push(`${name} ${view}: a peak of ${ratio} at ${wave.join(', ')}`)
        if (!(any < 3)) misses.push(`${name} ${view}: a line has ${any} times the noise floor`)
        if (!(worst.power < 2.5)) misses.push(`${name} ${view}: ${worst.axis} has ${worst.power}`)
        if (!(rows.peak.ratio > 36)) misses.push(`${name} ${view}: rows would pass as no peak`)
        if (!(rows.along(angle) > 5)) misses.push(`${name} ${view}: rows would pass as no line`)
      }
    }
    expectTrue(misses.length === 0, misses.join('; '))
    pipeline.dispose()
    node.dispose()
    noise.dispose()
    atmosphere.dispose()
  },
  // How the clouds look is the same where their density is: see `clouds/density`.
  { backends: ['webgpu'] }
)
