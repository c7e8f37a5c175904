import {
  Atmosphere,
  moon,
  skyEnvironment,
  SkyLightProbe,
  SunDirectionalLight,
  viewNodes
} from '@welkin/atmosphere'
import {
  CloudLightTable,
  CloudNoise,
  cloudEnvironment,
  cloudPreset,
  clouds,
  cloudShadow,
  cloudSkyLight,
  type CloudLayers,
  type CloudQuality,
  type CloudsNode,
  cloudWorldMap
} from '@welkin/clouds'
import {
  DataTexture,
  LinearFilter,
  Mesh,
  MeshLambertMaterial,
  MeshStandardMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  RepeatWrapping,
  Scene,
  SphereGeometry,
  Vector3
} from 'three'
import { float, vec4 } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { stackDecks, type CloudDeck } from '../../../packages/clouds/src/environment/cpu/decks'
import * as twin from '../../../packages/clouds/test/twins/overcast'
import { eddington } from '../../../packages/clouds/src/environment/tsl/decks'
import { cloudyIrradiance } from '../../../packages/clouds/src/environment/tsl/overcast'
import { drawToFloat, random } from '../harness/atmosphere'
import { coarse } from '../harness/cloud-view'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { filterLeast } from '../harness/filter-samples'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { setShadowSize } from '../harness/shadow-size'

const size = { width: 24, height: 16 }
/** Shorter steps than `coarse` has: with those an overcast lets 3 % less light through. */
const quality: CloudQuality = {
  ...coarse,
  steps: 128,
  stepGrowth: 0.005,
  depthStep: 0.1,
  layerSteps: 24,
  block: 1
}

const mean = ({ data }: Picture, channel: number): number => {
  let sum = 0
  for (let i = channel; i < data.length; i += 4) sum += data[i]
  return (4 * sum) / data.length
}

/** Pearson's coefficient. */
function correlation(a: readonly number[], b: readonly number[]): number {
  const centered = [a, b].map(values => {
    const average = values.reduce((sum, value) => sum + value, 0) / values.length
    return values.map(value => value - average)
  })
  const product = (i: number, j: number): number =>
    centered[i].reduce((sum, value, k) => sum + value * centered[j][k], 0)
  return product(0, 1) / Math.sqrt(product(0, 0) * product(1, 1))
}

gpuTest('an overcast gives surfaces light as its float64 twin does', async t => {
  const renderer = await t.createRenderer()
  const next = random(3)
  const rows = Array.from({ length: 128 }, () =>
    [20 * next() ** 2, 0.05 + 0.95 * next(), 20 * next() ** 2, 2 * next() - 1].map(Math.fround)
  )
  const oneMinusAsymmetry = 0.52
  const [direct, sky, albedo] = [0.7, 0.2, 0.25]
  const found = await evaluateOnGpu(renderer, rows, ({ x, y, z, w }) => {
    const above = eddington(x, y, float(oneMinusAsymmetry))
    const below = eddington(z, y, float(oneMinusAsymmetry))
    const light = cloudyIrradiance(
      {
        direct: { above: vec4(direct).mul(y), below: vec4(direct * 0.9).mul(y) },
        sky: { here: vec4(sky), below: vec4(sky * 1.1) },
        ground: vec4(albedo).mul(y.mul(direct).add(sky)),
        plane: vec4(sky / 2),
        albedo: vec4(albedo)
      },
      above,
      below,
      w
    )
    return vec4(above.diffuse, above.direct, light.x, 0)
  })
  const expected = rows.flatMap(([over, mu, under, cosNormal]) => {
    const deck = (thickness: number): CloudDeck =>
      stackDecks([[{ thickness, coverage: 1 }]], mu, oneMinusAsymmetry)
    const light = twin.cloudyIrradiance(
      {
        direct: { above: direct * mu, below: 0.9 * direct * mu },
        sky: { here: sky, below: 1.1 * sky },
        ground: albedo * (direct * mu + sky),
        plane: sky / 2,
        albedo
      },
      deck(over),
      deck(under),
      cosNormal
    )
    return [deck(over).diffuse, deck(over).direct, light, 0]
  })
  expectClose(found, expected, { relative: 1e-4, absolute: 1e-5 })
})

/** Clouds alone, before black. */
function cloudsOf(
  camera: PerspectiveCamera,
  atmosphere: Atmosphere,
  layers: CloudLayers,
  shared: { noise: CloudNoise; light: CloudLightTable }
): { node: CloudsNode; pipeline: (renderer: WebGPURenderer) => RenderPipeline } {
  const node = clouds(vec4(0), float(1), camera, atmosphere, layers, { quality, ...shared })
  node.time = 0
  node.accumulates = false
  return {
    node,
    pipeline: renderer => {
      const pipeline = new RenderPipeline(renderer)
      pipeline.outputColorTransform = false
      pipeline.outputNode = node
      return pipeline
    }
  }
}

/** Direction from angles [°]. */
function towards(elevation: number, azimuth: number): Vector3 {
  const [e, a] = [elevation, azimuth].map(angle => (angle * Math.PI) / 180)
  return new Vector3(Math.cos(e) * Math.sin(a), Math.sin(e), -Math.cos(e) * Math.cos(a))
}

/** Checks that far from the shadow maps a world map that covers the western half shades that half. */
async function shadesTheGlobe(
  renderer: WebGPURenderer,
  atmosphere: Atmosphere,
  shared: { noise: CloudNoise; light: CloudLightTable }
): Promise<void> {
  const [width, height] = [64, 32]
  const texels = new Uint8Array(4 * width * height)
  for (let i = 0; i < width * height; i++)
    texels.fill(i % width < width / 2 ? 255 : 0, 4 * i, 4 * i + 4)
  const worldMap = new DataTexture(texels, width, height)
  worldMap.wrapS = RepeatWrapping
  worldMap.minFilter = worldMap.magFilter = LinearFilter
  worldMap.needsUpdate = true
  atmosphere.frame = 'ecef'
  atmosphere.sunDirection = new Vector3(1, 0.1, 0.2)
  const camera = new PerspectiveCamera(40, size.width / size.height, 1e6, 1e8)
  camera.position.set(2.5e7, 0, 0)
  camera.up.set(0, 0, 1)
  camera.lookAt(0, 0, 0)
  camera.updateMatrixWorld()
  const layers = cloudPreset('overcast')
  layers.at(0).set({ coverage: 0.5 })
  const node = clouds(vec4(0), float(1), camera, atmosphere, layers, {
    ...shared,
    worldMap: cloudWorldMap(worldMap)
  })
  const sun = new SunDirectionalLight(atmosphere)
  const globe = new Mesh(new SphereGeometry(6.378e6, 64, 32), new MeshLambertMaterial())
  globe.receiveShadow = true
  const scene = new Scene().add(globe, sun)
  // As the node does before it is drawn.
  const view = atmosphere.update(renderer, camera)
  node.field.view.update({ camera })
  node.field.update(view, 0)
  node.shadows.update(renderer, view)
  const draw = (): Promise<Picture> => drawToFloat(renderer, () => renderer.render(scene, camera))
  const open = await draw()
  sun.castShadow = true
  Object.assign(sun.shadow, { shadowNode: cloudShadow(node) })
  const shaded = await draw()
  const [west, east] = [8, 15].map(x => shaded.at(x, 8)[1] / open.at(x, 8)[1])
  expectTrue(west < 0.3, `the west has ${west} of its light`)
  expectTrue(east > 0.95, `the east has ${east} of its light`)
  node.dispose()
  worldMap.dispose()
}

gpuTest(
  'clouds are lit by the moon, light the ground below, and are mirrored',
  async t => {
    setShadowSize('least')
    filterLeast()
    const renderer = await t.createRenderer(size)
    renderer.shadowMap.enabled = true
    const shared = { noise: new CloudNoise(), light: new CloudLightTable() }
    const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 })
    const luna = moon({ lightsAir: false })
    luna.direction = towards(40, 100)
    atmosphere.add(luna)
    const camera = new PerspectiveCamera(50, size.width / size.height, 0.1, 1e4)
    camera.position.y = 2
    camera.lookAt(towards(35, 20).add(camera.position))
    camera.updateMatrixWorld()
    const layers = cloudPreset('overcast')
    // As thick here as in the mean over the planet, which is what surfaces are lit by.
    layers.at(0).set({ profileExponent: 8, edgeSoftness: 0 })
    const { node, pipeline: make } = cloudsOf(camera, atmosphere, layers, shared)
    const pipeline = make(renderer)
    const draw = async (): Promise<Picture> => {
      await nextFrame()
      const picture = await drawToFloat(renderer, () => pipeline.render())
      const wrong = picture.data.findIndex(value => !(value >= 0 && value < 1e3))
      expectTrue(wrong < 0, `${picture.data[wrong]} at ${wrong}`)
      return picture
    }

    // Any height of the sun, with the moon up and down.
    for (const [elevation, moonElevation] of [
      [-90, 30],
      [-25, -30],
      [-12, -3],
      [0, 5],
      [25, 60],
      [90, 60]
    ]) {
      atmosphere.setSunAngles(elevation, 250)
      luna.direction = towards(moonElevation, 100)
      await draw()
    }

    // Dusk has no step where moonlight sets in.
    luna.phase = 0.5
    luna.direction = towards(40, 100)
    let [brighter, steepest] = [Infinity, 1]
    for (let depression = 5; depression <= 9; depression++) {
      atmosphere.setSunAngles(-depression, 250)
      const light = mean(await draw(), 1)
      expectTrue(light < brighter, `brighter with the sun ${depression}° down`)
      if (brighter < Infinity) steepest = Math.max(steepest, brighter / light)
      brighter = light
    }
    expectTrue(steepest < 4, `a degree of dusk dims clouds ${steepest} times`)

    // Night: full moon, new moon, and the night sky for all the world.
    atmosphere.setSunAngles(-40, 250)
    const moonlit = mean(await draw(), 1)
    luna.phase = 0
    const starlit = mean(await draw(), 1)
    node.nightIlluminance = 0
    const dark = mean(await draw(), 1)
    const sky = (8.5e-4 / Math.PI) * atmosphere.luminanceScale
    expectTrue(moonlit > 20 * starlit, `by moon ${moonlit}, by stars ${starlit}`)
    expectTrue(
      starlit > 0.1 * sky && starlit < 1.2 * sky,
      `by stars ${starlit}, the sky has ${sky}`
    )
    expectTrue(dark < 0.02 * starlit, `with neither ${dark}`)
    t.note(
      `dusk ${steepest.toFixed(2)}, moon ${moonlit.toExponential(2)}, stars ${starlit.toExponential(2)}`
    )

    // A white plane, up and down, under and over the clouds, by day.
    atmosphere.setSunAngles(60, 100)
    for (let i = 0; i < 4; i++) await draw()
    const scene = new Scene()
    const white = new MeshLambertMaterial()
    const plane = new Mesh(new PlaneGeometry(9, 9), white)
    const sun = new SunDirectionalLight(atmosphere)
    const probe = new SkyLightProbe(atmosphere)
    const cloudy = cloudSkyLight(probe, node)
    scene.add(plane, probe, sun)
    const planeCamera = new PerspectiveCamera(50, 1, 0.1, 100)
    const look = async (altitude: number, facing: 1 | -1): Promise<Picture> => {
      plane.position.y = altitude
      plane.rotation.x = (-facing * Math.PI) / 2
      planeCamera.position.y = altitude + 2 * facing
      planeCamera.lookAt(plane.position)
      planeCamera.updateMatrixWorld()
      return drawToFloat(renderer, () => renderer.render(scene, planeCamera))
    }
    const green = async (altitude: number, facing: 1 | -1): Promise<number> =>
      (await look(altitude, facing)).at(12, 8)[1]
    cloudy.strength = 0
    const day = await green(2, 1)
    sun.visible = false
    const blue = await green(2, 1)
    const [clearAbove, clearBelow] = [await green(4000, 1), await green(4000, -1)]
    cloudy.strength = 1
    const overcast = await look(2, 1)
    const grey = overcast.at(12, 8)[1]
    const [above, below] = [await green(4000, 1), await green(4000, -1)]
    t.note(`day ${day.toFixed(3)}, sky ${blue.toFixed(3)}, overcast ${grey.toFixed(3)}`)
    expectTrue(grey < 0.4 * day && grey > 0.1 * day, `an overcast leaves ${grey} of ${day}`)
    expectTrue(grey > blue, `an overcast has ${grey}, the blue sky ${blue}`)
    const [red, , violet] = overcast.at(12, 8)
    expectTrue(violet < 1.2 * red, `an overcast is blue: ${overcast.at(12, 8).join(' ')}`)
    expectClose(above, clearAbove, { relative: 1e-3 }, 'above the clouds')
    expectTrue(below > 1.5 * clearBelow, `from below ${below}, without clouds ${clearBelow}`)

    // The same clouds in a mirror, and as the light that they send down.
    const overlay = cloudEnvironment(node, { size: 48, quality })
    const environment = skyEnvironment(atmosphere, { overlay, diffuse: false })
    plane.material = new MeshStandardMaterial({ metalness: 1, roughness: 0 }) as never
    scene.environmentNode = environment
    probe.visible = false
    const mirrored = (await look(2, 1)).at(12, 8)
    expectTrue(environment.redraws === 1, `drawn ${environment.redraws} times`)
    const next = random(7)
    const rays = Array.from({ length: 256 }, (_, i) => {
      const [sine, angle] = [Math.sqrt((i + next()) / 256), 2 * Math.PI * next()]
      const up = Math.sqrt(1 - sine * sine)
      const world = new Vector3(sine * Math.cos(angle), up, sine * Math.sin(angle))
      return atmosphere.space.direction(world, new Vector3()).toArray()
    })
    const sentDown = await evaluateOnGpu(renderer, rays, ({ xyz }) =>
      vec4(overlay.over(viewNodes(atmosphere, camera), xyz, vec4(0).xyz), 1)
    )
    const marched = rays.reduce((total, _, i) => total + sentDown[4 * i + 1], 0) / rays.length
    t.note(`marched ${marched.toFixed(3)}, mirrored ${mirrored[1].toFixed(3)}`)
    expectClose(grey, marched, { relative: 0.15 }, 'light from marched clouds')
    expectTrue(mirrored[2] < 1.2 * mirrored[0], `clouds are mirrored blue: ${mirrored.join(' ')}`)

    const redraw = async (coverage: number): Promise<void> => {
      const { redraws } = environment
      layers.at(0).set({ coverage })
      await draw()
      let frames = 0
      while (environment.redraws === redraws && frames++ < 40) renderer.render(scene, planeCamera)
      expectTrue(frames === overlay.steps + 15, `drawn again after ${frames} frames`)
    }

    // Broken clouds are where the camera sees them.
    await redraw(0.5)
    const picture = await draw()
    const viewDirection = new Vector3()
    const directions = Array.from({ length: size.width * size.height }, (_, i) => {
      const [x, y] = [i % size.width, Math.floor(i / size.width)]
      viewDirection.set((2 * x + 1) / size.width - 1, 1 - (2 * y + 1) / size.height, 0.5)
      viewDirection.unproject(camera).sub(camera.position).normalize()
      return atmosphere.space.direction(viewDirection, new Vector3()).toArray()
    })
    /** Green light of the clouds in the environment map, where the camera's pixels look. */
    const overlaid = async (): Promise<number[]> => {
      const found = await evaluateOnGpu(renderer, directions, ({ xyz }) =>
        vec4(overlay.over(viewNodes(atmosphere, camera), xyz, vec4(0).xyz), 1)
      )
      return directions.map((_, i) => found[4 * i + 1])
    }
    const greens = ({ data }: Picture): number[] => directions.map((_, i) => data[4 * i + 1])
    const likeness = correlation(await overlaid(), greens(picture))
    t.note(`alike by ${likeness.toFixed(2)}`)
    expectTrue(likeness > 0.5, `overlay and picture are alike by ${likeness}`)

    await redraw(0)
    const cleared = (await look(2, 1)).at(12, 8)
    expectTrue(cleared[2] > 2 * cleared[0], `the sky is mirrored grey: ${cleared.join(' ')}`)
    for (let i = 0; i < 30; i++) renderer.render(scene, planeCamera)
    expectTrue(environment.redraws === 3, 'nothing changes, and it is drawn again')

    // The moon counts by night only.
    const { version } = overlay
    luna.direction = towards(50, 60)
    await draw()
    expectTrue(overlay.version === version, 'by day the moon counts')
    atmosphere.setSunAngles(-40, 250)
    luna.phase = 0.5
    await draw()
    for (let i = 0; i < 30; i++) renderer.render(scene, planeCamera)
    const drawn = overlay.version
    await draw()
    expectTrue(overlay.version === drawn, 'a moon that stands still counts')
    luna.direction = towards(50, 62)
    await draw()
    expectTrue(overlay.version > drawn, 'a moon that moves by night does not count')

    // By moonlight, too, clouds are mirrored, where the camera sees them; without the moon there are none.
    const mirrorAnew = async (): Promise<{ map: number[]; mirror: number[]; seen: Picture }> => {
      await draw()
      for (let i = 0; i < overlay.steps + 15; i++) renderer.render(scene, planeCamera)
      const mirror = (await look(2, 1)).at(12, 8)
      return { map: await overlaid(), mirror, seen: await draw() }
    }
    const sum = (values: readonly number[]): number => values.reduce((a, b) => a + b)
    // Half floats of the map hold a night at its exposure.
    atmosphere.luminanceScale = 1
    const clear = await mirrorAnew()
    layers.at(0).set({ coverage: 0.5 })
    const broken = await mirrorAnew()
    const alike = correlation(broken.map, greens(broken.seen))
    // No gap in the zenith, which the mirror shows.
    layers.at(0).set({ coverage: 1 })
    const byMoon = await mirrorAnew()
    luna.phase = 0
    const without = await mirrorAnew()
    const lights = [clear, byMoon, without]
    const [, inMap, inDark] = lights.map(({ map }) => sum(map))
    const [none, inMirror, mirroredDark] = lights.map(({ mirror }) => mirror[1])
    t.note(
      `moonlit: alike by ${alike.toFixed(2)}, ${(inDark / inMap).toExponential(1)} without moon`
    )
    expectTrue(sum(clear.map) === 0, `a clear sky has clouds of ${sum(clear.map)}`)
    expectTrue(alike > 0.5, `by moonlight overlay and picture are alike by ${alike}`)
    // A new moon has no light, and the night sky was switched off above.
    expectTrue(inMap > 0 && inDark < 0.02 * inMap, `${inMap} by moonlight, ${inDark} without`)
    expectTrue(
      inMirror > 2 * none,
      `a mirror has ${inMirror} of clouds by moonlight, ${none} of none`
    )
    expectTrue(mirroredDark < 0.1 * inMirror, `${inMirror} by moonlight, ${mirroredDark} without`)

    cloudy.dispose()
    expectTrue(probe.overcast === null, 'the probe keeps its clouds')
    environment.dispose()
    overlay.dispose()
    pipeline.dispose()
    node.dispose()
    await shadesTheGlobe(renderer, atmosphere, shared)
    shared.noise.dispose()
    shared.light.dispose()
    atmosphere.dispose()
  },
  // On WebGL the material with six maps, in `everything`, has clouds' shadows, environment and moonlight.
  { backends: ['webgpu'] }
)
