import {
  Atmosphere,
  exposureFor,
  exposureOfIlluminance,
  NightLightProbe,
  NIGHT_ILLUMINANCE,
  skyIlluminanceAt,
  SkyLightProbe,
  sunIlluminanceAt,
  horizontalIrradiance,
  moon
} from '@welkin/atmosphere'
import {
  CloudCover,
  CloudField,
  CloudLayers,
  CloudLightTable,
  cloudPreset,
  clouds,
  cloudSkyLight,
  precipitationShafts
} from '@welkin/clouds'
import { Mesh, MeshLambertMaterial, PerspectiveCamera, PlaneGeometry, Scene, Vector3 } from 'three'
import { float, vec4 } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { skyIrradiance } from '../../../packages/atmosphere/src/diffuseLight/cpu/skyIrradiance'
import { lightTransmittance } from '../../../packages/atmosphere/src/transmittance/cpu/transmittance'
import { decksAround } from '../../../packages/clouds/src/environment/tsl/decks'
import { overcastIrradiance } from '../../../packages/clouds/src/environment/tsl/overcast'
import type { Vec3 } from '../../../packages/clouds/src/tsl-types'
import { drawToFloat, random } from '../harness/atmosphere'
import { CloudView, coarse, drawUnseen, fog, SparseNoise, viewSize } from '../harness/cloud-view'
import { luminance } from '../harness/environment'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import { setShadowSize } from '../harness/shadow-size'

const size = { width: 8, height: 8 }

// Against the CPU on one backend: `clouds/density` and `clouds/light` hold the shaders to their twins on both.
gpuTest(
  'answers on the CPU what probes under, in and above an overcast show',
  async t => {
    setShadowSize('least')
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 })
    const camera = new PerspectiveCamera(40, 1, 0.1, 100)
    const layers = cloudPreset('overcast')
    const light = new CloudLightTable({ forwardAsymmetry: 0.75 })
    const node = clouds(vec4(0), float(1), camera, atmosphere, layers, {
      quality: { ...coarse, block: 1 },
      noise: new SparseNoise(),
      light
    })
    node.time = 0
    drawUnseen(node)
    await node.bake(renderer)
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputNode = node
    const [sky, night] = [new SkyLightProbe(atmosphere), new NightLightProbe(atmosphere)]
    for (const probe of [sky, night]) cloudSkyLight(probe, node)
    const plane = new Mesh(new PlaneGeometry(20, 20), new MeshLambertMaterial())
    const scene = new Scene().add(plane, sky, night)
    const cover = new CloudCover(layers, { light })

    const look = async (altitude: number, normal: Vector3): Promise<number> => {
      plane.position.y = altitude
      plane.lookAt(plane.position.clone().add(normal))
      camera.position.copy(plane.position).addScaledVector(normal, 5)
      camera.lookAt(plane.position)
      camera.updateMatrixWorld()
      await nextFrame()
      await drawToFloat(renderer, () => pipeline.render())
      const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
      return (luminance(picture.at(4, 4)) * Math.PI) / atmosphere.luminanceScale
    }

    const normals = [new Vector3(0, 1, 0), new Vector3(0, -1, 0), new Vector3(0.6, 0.8, 0)]
    for (const elevation of [60, 15, 2]) {
      atmosphere.setSunAngles(elevation, 100)
      night.visible = false
      for (const altitude of [2, 1050, 4000]) {
        for (const normal of normals) {
          const got = await look(altitude, normal)
          const expected = luminance(
            skyIlluminanceAt(atmosphere, plane.position, normal, { clouds: cover })
          )
          const where = `sun ${elevation}°, ${altitude} m, ${normal.toArray().join(' ')}`
          expectClose(got, expected, { relative: 0.03 }, where)
        }
      }
      // All light of level ground, as the exposure has it.
      const place = new Vector3()
      const up = normals[0]
      const [sun, diffuse] = [
        luminance(sunIlluminanceAt(atmosphere, place, { clouds: cover })),
        luminance(skyIlluminanceAt(atmosphere, place, up, { clouds: cover }))
      ]
      camera.position.set(0, 2, 0)
      camera.updateMatrixWorld()
      const exposure = exposureFor(atmosphere, camera, { clouds: cover })
      const expected = exposureOfIlluminance(diffuse + sun * atmosphere.sunDirection.y)
      expectClose(exposure, expected, { relative: 0.01 }, `exposure, sun ${elevation}°`)
    }

    // The night sky's light passes as any even light.
    atmosphere.setSunAngles(-60, 100)
    sky.visible = false
    night.visible = true
    const { groundAlbedo } = atmosphere.parameters
    for (const altitude of [2, 1050, 4000]) {
      for (const normal of normals) {
        const got = await look(altitude, normal)
        const [up, down] = [(1 + normal.y) / 2, (1 - normal.y) / 2]
        const place = {
          position: plane.position,
          altitude,
          cosLight: 1,
          groundAlbedo,
          direct: () => [0, 0, 0, 0],
          diffuse: () => ({ up: [1, 1, 1, 1], down: groundAlbedo })
        }
        const clear = groundAlbedo.map(albedo => up + albedo * down)
        // The Earth's ground is grey here.
        const [part] = cover.irradiance(place, normal.y, clear)
        const where = `night, ${altitude} m, ${normal.toArray().join(' ')}`
        expectClose(got, part * NIGHT_ILLUMINANCE, { relative: 0.03 }, where)
      }
    }
    t.note(`night under clouds ${((await look(2, normals[0])) / NIGHT_ILLUMINANCE).toFixed(3)}`)
    pipeline.dispose()
    node.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'clouds near the moon are as bright by an exposure for the night, times it',
  async t => {
    const renderer = await t.createRenderer(viewSize)
    const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 }).setSunAngles(-40, 20)
    const luna = moon()
    atmosphere.add(luna)
    luna.set({ direction: new Vector3(0, 0.5, -Math.sqrt(0.75)), phase: 0.5 })
    // Thin: the forward peak of its droplets is seen.
    const layers = new CloudLayers([{ ...fog, density: 5e-4 }])
    const view = new CloudView(renderer, atmosphere, layers, { noise: new SparseNoise() })
    view.camera.position.y = 2
    view.camera.lookAt(0, 200, -350)
    const exposure = exposureFor(atmosphere, view.camera, { sources: [luna.source] })
    const dark = await view.draw(6)
    atmosphere.luminanceScale *= exposure
    const bright = await view.draw(6)
    const apart = [...dark.data]
      .flatMap((value, i) => (i % 4 === 3 ? [] : [Math.abs(bright.data[i] / exposure / value - 1)]))
      .toSorted((a, b) => a - b)
    const [median, most] = [apart[apart.length >> 1], apart[apart.length - 1]]
    t.note(
      `exposure ${exposure.toFixed(0)}, ${median.toFixed(4)} apart, at most ${most.toFixed(3)}`
    )
    expectTrue(exposure > 5000, `an exposure of ${exposure} is not for a night`)
    expectTrue(median < 0.01 && most < 0.3, `${median} apart, at most ${most}`)
    view.dispose()
    atmosphere.dispose()
  },
  // Scales are numbers of the CPU.
  { backends: ['webgpu'] }
)

gpuTest(
  'answers for broken clouds what the GPU has in the mean over the planet',
  async t => {
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere()
    await atmosphere.bake(renderer)
    const { parameters, tables } = atmosphere
    const camera = new PerspectiveCamera(60, 1, 1, 1e5)
    camera.updateMatrixWorld()
    const light = new CloudLightTable()
    const next = random(11)
    const places = Array.from({ length: 2000 }, () => {
      const z = 2 * next() - 1
      const angle = 2 * Math.PI * next()
      const across = Math.sqrt(1 - z * z)
      return [across * Math.cos(angle), across * Math.sin(angle), z, 0]
    })
    for (const [name, mu] of [
      ['fairWeather', 0.8],
      ['stratocumulus', 0.5],
      ['mixed', 0.3],
      ['nimbostratus', 0.6],
      ['snowShower', 0.6]
    ] as const) {
      const field = new CloudField(atmosphere, cloudPreset(name))
      field.bake(renderer)
      field.pixelAngle.value = 1e-4
      field.depthScale.value = light.nodes.depthScale.value
      field.view.update({ camera })
      const seen = atmosphere.update(renderer, camera)
      field.update(seen, 0)
      const rains = field.layers.at(0).precipitation !== null
      const falling = rains ? precipitationShafts() : undefined
      falling?.update(field, seen)
      const lights = await evaluateOnGpu(renderer, places, ({ xyz }) => {
        const { view } = field
        const { air } = view
        const [altitude, cosLight] = [float(100).toConst(), float(mu).toConst()]
        const here = view.up.mul(field.radius.add(view.height))
        const up = xyz.toConst() as Vec3
        const offset = up.mul(field.radius.add(altitude)).sub(here).toConst() as Vec3
        const plane = { view, offset, altitude, up, cosLight, cosNormal: float(1) }
        const clear = horizontalIrradiance(air.uniforms, air.diffuse!, altitude, cosLight)
        const sky = overcastIrradiance(field, light.nodes, plane, offset, clear.up, falling)
        const { above } = decksAround(field, light.nodes, offset, altitude, up, cosLight, falling)
        return vec4(sky.y, above.beam, 0, 0)
      })
      const mean = (channel: number): number =>
        places.reduce((sum, _, i) => sum + lights[4 * i + channel] / places.length, 0)
      const cover = new CloudCover(field.layers, { light })
      const facing = (altitude: number, cosNormal: 1 | -1): number[] =>
        skyIrradiance(parameters, tables.data!, altitude, cosNormal, mu, cosNormal * mu)
      const place = {
        position: new Vector3(),
        altitude: 100,
        cosLight: mu,
        groundAlbedo: parameters.groundAlbedo,
        direct: (altitude: number) =>
          lightTransmittance(parameters, parameters.bottomRadius + altitude, mu).map(
            value => value * mu
          ),
        diffuse: (altitude: number) => ({ up: facing(altitude, 1), down: facing(altitude, -1) })
      }
      const [sky, beam] = [cover.irradiance(place, 1, facing(100, 1))[1], cover.beam(place)]
      const direct = place.direct(100)[1]
      const [got, expected] = [sky + beam * direct, mean(0) + mean(1) * direct]
      t.note(
        `\n${name}: sky ${sky.toFixed(4)} for ${mean(0).toFixed(4)}, beam ${beam.toFixed(3)} for ${mean(1).toFixed(3)}, ` +
          `all ${(got / expected).toFixed(3)}`
      )
      expectTrue(Math.abs(beam - mean(1)) < 0.04, `${name}: beam ${beam} for ${mean(1)}`)
      expectClose(got, expected, { relative: 0.03 }, `${name}: all light`)
      field.dispose()
    }
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)
