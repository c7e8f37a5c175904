import { Atmosphere } from '@welkin/atmosphere'
import { Ellipsoid, geodesicDestination } from '@welkin/geo'
import { CloudField, CloudLayers, CloudLightTable, cloudPreset } from '@welkin/clouds'
import { DataTexture, FloatType, PerspectiveCamera, RenderTarget } from 'three'
import { float, Fn, screenCoordinate, texture, uniform, vec4 } from 'three/tsl'
import { NodeMaterial, QuadMesh, type Node, type NodeFrame } from 'three/webgpu'
import type { CloudShadows } from '../../../packages/clouds/src/shadow/tsl/sampleShadows'
import { QualityUniforms, cloudQualities } from '../../../packages/clouds/src/march/quality'
import { litClouds } from '../../../packages/clouds/src/march/tsl/shadePoints'
import { number } from '../../../packages/clouds/src/uniforms'
import { mean } from '../harness/cloud-scene'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { readPicture } from '../harness/picture'

/** Half the width of the view, as a slope. */
const SPREAD = 0.125

/** Height of the camera [m]. */
const HEIGHT = 4e5

/** Places that are looked at, which together have about as many clouds as the planet has. */
const PLACES = [
  { longitude: 20, latitude: 45 },
  { longitude: -100, latitude: -35 },
  { longitude: 150, latitude: 50 },
  { longitude: 110, latitude: -5 }
]

/** Direction to the sun, clockwise from north [°]; the camera looks away from it. */
const SUN_AZIMUTH = 150

/** Distance over the ground from the camera's subpoint to what it looks at, tilted [rad] [m]. */
function groundDistance(tilt: number): number {
  const radius = Ellipsoid.WGS84.radii.x
  return radius * (Math.asin((1 + HEIGHT / radius) * Math.sin(tilt)) - tilt)
}

gpuTest(
  'clouds are as bright, resolved one by one or not',
  async t => {
    const renderer = await t.createRenderer()
    const atmosphere = new Atmosphere().place({ ...PLACES[0], height: HEIGHT })
    const camera = new PerspectiveCamera()
    camera.updateMatrixWorld()
    const layers = new CloudLayers([{}])
    const field = new CloudField(atmosphere, layers)
    const light = new CloudLightTable()
    light.bake()
    field.depthScale.value = light.nodes.depthScale.value
    const quality = new QualityUniforms()
    const { high } = cloudQualities
    /** Steps about as long as single clouds need, from 400 km. */
    const resolved = { ...high, steps: 1024, stepGrowth: 4e-4 }
    const update = (): void => {
      const view = atmosphere.update(renderer, camera)
      field.view.update({ renderer, camera } as unknown as NodeFrame)
      field.update(view, 0)
    }
    field.bake(renderer)

    const size = 32
    /** Angle of the view against straight down, away from the sun [rad]. */
    const tilt = uniform(0)
    const map = texture(new DataTexture(new Uint8Array(4), 1, 1))
    const shadows = { map, cascades: [], count: 1, isMoonlit: number() } as unknown as CloudShadows
    const material = new NodeMaterial()
    material.fragmentNode = Fn(() => {
      const { up, lightDirection } = field.view
      const across = up.cross(lightDirection).normalize().toConst()
      const ahead = up.cross(across).toConst()
      const middle = ahead.mul(tilt.sin()).sub(up.mul(tilt.cos())).toConst()
      const at = screenCoordinate.xy
        .div(size / 2)
        .sub(1)
        .mul(SPREAD)
        .toConst()
      const aside = across.mul(at.x).add(middle.cross(across).mul(at.y))
      const direction = middle.add(aside).normalize().toConst() as unknown as Node<'vec3'>
      const pixel = screenCoordinate.xy.floor()
      const jitter = pixel.x.mul(0.754877666).add(pixel.y.mul(0.569840296)).fract()
      const ray = { direction, end: float(3e6), jitter }
      const marched = litClouds({ field, light: light.nodes, shadows, quality }, ray)
      return vec4(marched.radiance.y, marched.transmittance, 0, 0)
    })() as never
    const quad = new QuadMesh(material)
    const target = new RenderTarget(size, size, { type: FloatType, depthBuffer: false })
    /** Mean light and opacity over all places. */
    const meanLight = async (pixelAngle: number): Promise<[number, number]> => {
      field.pixelAngle.value = pixelAngle
      const [radiances, through] = [[] as number[], [] as number[]]
      for (const place of PLACES) {
        const below = geodesicDestination(place, SUN_AZIMUTH, groundDistance(tilt.value))
        atmosphere.place({ longitude: below.longitude, latitude: below.latitude, height: HEIGHT })
        update()
        renderer.setRenderTarget(target)
        quad.render(renderer)
        renderer.setRenderTarget(null)
        const { data } = await readPicture(renderer, target)
        for (let i = 0; i < data.length; i += 4) {
          radiances.push(data[i])
          through.push(data[i + 1])
        }
      }
      return [mean(radiances), 1 - mean(through)]
    }

    const misses: string[] = []
    for (const [name, coverage] of [
      ['fairWeather', 0.3],
      ['cumulonimbus', 0.3]
    ] as const) {
      layers.at(0).set({ ...cloudPreset(name).at(0).parameters, coverage })
      for (const [elevation, tiltDegrees] of [
        [60, 0],
        [10, 50]
      ]) {
        atmosphere.setSunAngles(elevation, SUN_AZIMUTH)
        tilt.value = (tiltDegrees * Math.PI) / 180
        quality.set(resolved)
        const [near, nearOpacity] = await meanLight(3e-4)
        quality.set(high)
        const found: string[] = []
        // From 400 km: 120 m, then 4 and 16 km.
        for (const pixelAngle of [1e-2, 4e-2]) {
          const [far, opacity] = await meanLight(pixelAngle)
          found.push(`${(far / near).toFixed(2)} (opacity ${opacity.toFixed(2)})`)
          if (Math.abs(far / near - 1) > 0.2) misses.push(`${name}: ${far / near} of the light`)
        }
        const label = `${name}, sun at ${elevation}°, view ${tiltDegrees}° aslant`
        t.note(`${label}: opacity ${nearOpacity.toFixed(2)}, light × ${found.join(', ')}`)
      }
    }
    expectTrue(misses.length === 0, misses.join(', '))
    target.dispose()
    material.dispose()
    field.dispose()
    light.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)
