import {
  Airglow,
  Atmosphere,
  brightStars,
  heightFog,
  milkyWay,
  NightLightProbe,
  skyBackground,
  Stars,
  stars,
  starsOverlay,
  distanceToTop,
  opticalDepth
} from '@welkin/atmosphere'
import type { Star } from '@welkin/atmosphere'
import {
  FloatType,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  Vector3
} from 'three'
import { float, pass, vec4 } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { vanRhijnFactor } from '../../../packages/atmosphere/test/twins/night/airglow'
import { starDirection } from '../../../packages/atmosphere/src/stars/starCells'
import { luminanceOf } from '../../../packages/atmosphere/src/parameters/photometry'
import { starIrradiance } from '../../../packages/atmosphere/src/stars/starBrightness'
import {
  layerInPixel,
  vanRhijnFactors,
  thinLayerVanRhijnFactor
} from '../../../packages/atmosphere/src/night/tsl/airglow'
import { milkyWayMap } from '../../../packages/atmosphere/src/night/tsl/milkyWay'
import { drawToFloat, expectLight, relativeDifferences } from '../harness/atmosphere'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const luminance = ([r, g, b]: readonly number[]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b

/** Illuminance by a star of magnitude 0 [lx]. */
const VEGA = 2.54e-6

/** Atmosphere without a date, so that the frame of the stars is ECEF; its light is in cd/m². */
function stellarAtmosphere(): Atmosphere {
  const atmosphere = new Atmosphere()
  atmosphere.frame = 'ecef'
  atmosphere.luminanceScale = 1
  return atmosphere
}

/** A camera far above the air, planet and sun behind it. */
function inSpace(atmosphere: Atmosphere, fov: number, towards: Star): PerspectiveCamera {
  const camera = new PerspectiveCamera(fov, 64 / 36, 1, 1e9)
  const direction = new Vector3(...starDirection(towards))
  atmosphere.sunDirection = direction.clone().negate()
  camera.position.copy(direction).multiplyScalar(1e8)
  camera.up.set(0.3, 0.5, 0.8).normalize()
  camera.lookAt(direction.clone().multiplyScalar(2e8))
  camera.updateMatrixWorld()
  return camera
}

/** Illuminance of a plane that faces the middle of a picture, by all that is in it [lx]. */
function illuminance({ width, height, data }: Picture, fov: number): number {
  const side = (2 * Math.tan((fov * Math.PI) / 360)) / height
  let sum = 0
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const [u, v] = [(x + 0.5 - width / 2) * side, (y + 0.5 - height / 2) * side]
      const solidAngle = (side * side) / (1 + u * u + v * v) ** 1.5
      const i = 4 * (y * width + x)
      sum += luminance([data[i], data[i + 1], data[i + 2]]) * solidAngle
    }
  }
  return sum
}

/** Centre of the light in a picture, from the top left [pixels]. */
function centroid({ width, data }: Picture): [number, number] {
  let [sum, sumX, sumY] = [0, 0, 0]
  for (let i = 0; i < data.length; i += 4) {
    const weight = luminance([data[i], data[i + 1], data[i + 2]])
    sum += weight
    sumX += weight * (((i / 4) % width) + 0.5)
    sumY += weight * (Math.floor(i / 4 / width) + 0.5)
  }
  return [sumX / sum, sumY / sum]
}

gpuTest(
  'gives each star its illuminance and place, whatever the picture’s size and field',
  async t => {
    const vega = brightStars().find(({ ascension }) => Math.abs(ascension - 4.87356) < 1e-3) as Star
    const renderer = await t.createRenderer()
    const atmosphere = stellarAtmosphere().add(
      new Stars({ catalogue: [{ ...vega, colorIndex: 0 }] })
    )
    const scene = new Scene()
    scene.backgroundNode = skyBackground(atmosphere)
    for (const [width, height, fov] of [
      [64, 36, 20],
      [160, 90, 20],
      [128, 72, 1],
      [96, 54, 5]
    ]) {
      renderer.setSize(width, height)
      const camera = inSpace(atmosphere, fov, vega)
      camera.setViewOffset(width, height, 0.31, -0.22, width, height)
      const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
      expectLight(picture, `${width}×${height}`)
      const ratio = illuminance(picture, fov) / (VEGA * 10 ** (-0.4 * vega.magnitude))
      const [x, y] = centroid(picture)
      t.note(
        `${width}×${height} over ${fov}°: ${ratio.toFixed(3)}, at ${x.toFixed(2)}, ${y.toFixed(2)}`
      )
      expectTrue(Math.abs(ratio - 1) < 0.02, `illuminance is ${ratio} of what it should be`)
      const off = Math.hypot(x - width / 2 + 0.31, y - height / 2 - 0.22)
      expectTrue(off < 0.05, `it is ${off} pixels from its place`)
    }
    atmosphere.dispose()
  }
)

gpuTest('has the light of the whole catalogue', async t => {
  const renderer = await t.createRenderer({ width: 128, height: 128 })
  const atmosphere = stellarAtmosphere().add(stars())
  const scene = new Scene()
  scene.backgroundNode = skyBackground(atmosphere)
  // 90° square, six of them: the whole sky.
  let sum = 0
  const size = 90
  for (const [x, y, z] of [
    [1, 0, 0],
    [-1, 0, 0],
    [0, 1, 0],
    [0, -1, 0],
    [0, 0, 1],
    [0, 0, -1]
  ]) {
    const ascension = Math.atan2(y, x)
    const towards = { ascension, declination: (z * Math.PI) / 2, magnitude: 0, colorIndex: 0 }
    const camera = inSpace(atmosphere, size, towards)
    camera.aspect = 1
    camera.up.set(0, z === 0 ? 0 : 1, z === 0 ? 1 : 0)
    camera.lookAt(camera.position.clone().multiplyScalar(2))
    camera.updateProjectionMatrix()
    const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
    // On a plane that faces each star, not the face's middle.
    const side = 2 / picture.height
    for (let i = 0; i < picture.data.length; i += 4) {
      const u = (((i / 4) % 128) + 0.5) * side - 1
      const v = (Math.floor(i / 4 / 128) + 0.5) * side - 1
      const [r, g, b] = picture.data.subarray(i, i + 3)
      sum += (luminance([r, g, b]) * side * side) / (1 + u * u + v * v) ** 1.5
    }
  }
  atmosphere.dispose()
  const expected = brightStars().reduce(
    (total, star) => total + VEGA * 10 ** (-0.4 * star.magnitude),
    0
  )
  t.note(`${sum.toExponential(3)} of ${expected.toExponential(3)} lx`)
  expectTrue(Math.abs(sum / expected - 1) < 0.05, `${sum} lx of ${expected}`)
})

/** Draws a scene by a post effect. @param overlay - Air whose stars are drawn last; false for none. */
async function drawScene(
  renderer: WebGPURenderer,
  scene: Scene,
  camera: PerspectiveCamera,
  overlay: Atmosphere | false
): Promise<Picture> {
  const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  const color = scenePass.getTextureNode()
  const depth = scenePass.getTextureNode('depth')
  pipeline.outputNode = overlay ? starsOverlay(color, depth, camera, overlay) : color
  const picture = await drawToFloat(renderer, () => pipeline.render())
  scenePass.dispose()
  pipeline.dispose()
  return picture
}

gpuTest(
  'draws the same stars after post-processing, behind what was drawn',
  async t => {
    const [width, height, fov] = [96, 54, 40]
    const renderer = await t.createRenderer({ width, height })
    const orion = { ascension: 1.46, declination: 0, magnitude: 0, colorIndex: 0 }
    const draw = async (overlay: boolean): Promise<Picture> => {
      const atmosphere = stellarAtmosphere()
      const camera = inSpace(atmosphere, fov, orion)
      atmosphere.add(milkyWay(), stars({ overlay }))
      const scene = new Scene()
      scene.backgroundNode = skyBackground(atmosphere)
      // Hides the left half.
      const card = new Mesh(new PlaneGeometry(2e6, 2e6), new MeshLambertMaterial({ color: 0 }))
      card.position.set(-1e6, 0, -1e6)
      camera.add(card)
      scene.add(camera)
      const picture = await drawScene(renderer, scene, camera, overlay && atmosphere)
      card.geometry.dispose()
      card.material.dispose()
      atmosphere.dispose()
      return picture
    }
    const inSky = await draw(false)
    const onTop = await draw(true)
    let [worst, most] = [0, 0]
    for (let i = 0; i < inSky.data.length; i++) {
      most = Math.max(most, inSky.data[i])
      worst = Math.max(worst, Math.abs(inSky.data[i] - onTop.data[i]))
    }
    t.note(`off by ${(worst / most).toExponential(1)} of the brightest`)
    expectTrue(most > 0, 'there are no stars')
    expectTrue(worst < 1e-4 * most, `off by ${worst} of ${most}`)
    expectTrue(Math.max(...onTop.at(20, 27).slice(0, 3)) === 0, 'there are stars before the card')
  },
  // *Night sky* has stars on both.
  { backends: ['webgpu'] }
)

gpuTest(
  'dims stars by fog before them, drawn last or in the sky',
  async t => {
    const [width, height] = [96, 54]
    const renderer = await t.createRenderer({ width, height })
    const draw = async (overlay: boolean, density: number): Promise<number> => {
      const atmosphere = new Atmosphere().setSunAngles(-60, 270)
      atmosphere.luminanceScale = 1
      atmosphere.add(stars({ overlay }), heightFog({ density, falloff: 300 }))
      const camera = new PerspectiveCamera(40, width / height, 1, 1e6)
      camera.position.y = 2
      camera.rotation.x = 0.6
      const scene = new Scene()
      scene.backgroundNode = skyBackground(atmosphere)
      const picture = await drawScene(renderer, scene, camera, overlay && atmosphere)
      atmosphere.dispose()
      return illuminance(picture, 40)
    }
    for (const density of [1e-3, 0.1]) {
      const [inSky, onTop] = [await draw(false, density), await draw(true, density)]
      t.note(`${density}/m: ${inSky.toExponential(2)} lx, drawn last ${onTop.toExponential(2)} lx`)
      if (density < 0.1) expectTrue(inSky > 1e-6, `${inSky} lx of stars in thin fog`)
      expectTrue(Math.abs(onTop - inSky) < 1e-3 * inSky + 1e-12, `${onTop}, not ${inSky} lx`)
    }
  },
  { backends: ['webgpu'] }
)

gpuTest('has airglow at a far limb as a pixel sees it at once', async t => {
  const [altitude, width, bottomRadius] = [96_000, 4000, 6_378_137]
  const radius = bottomRadius + 2e7
  const cosOf = (lowest: number): number => -Math.sqrt(1 - ((bottomRadius + lowest) / radius) ** 2)
  const distance = Math.abs(radius * cosOf(altitude))
  /** Mean over a pixel of a width, which is square and stands upright [m]. */
  const meanOver = (lowest: number, side: number): number => {
    const places = Array.from({ length: 12 }, (_, i) => lowest + ((i + 0.5) / 12 - 0.5) * side)
    const factors = places.map(place =>
      vanRhijnFactor({ altitude, width }, radius, cosOf(place), bottomRadius, 2 * radius)
    )
    return factors.reduce((sum, factor) => sum + factor, 0) / 12
  }
  const side = 40_000
  const pixel = (Math.SQRT2 * side) / distance
  const lowest = [70_000, 80_000, 90_000, 100_000]
  const gpu = await t.evaluate(
    lowest.map(place => [radius - bottomRadius, cosOf(place), pixel, 0]),
    input => {
      const nodes = { altitude: float(altitude), width: float(width) }
      const wide = layerInPixel(nodes, input.x, input.y, float(bottomRadius), input.z)
      const gains = vanRhijnFactors(wide, input.x, input.y, float(bottomRadius), null)
      return gains.down.add(gains.up)
    }
  )
  const found = lowest.map((_, i) => gpu[4 * i])
  const exact = lowest.map(place => meanOver(place, side))
  t.note(`${found.map(each => each.toFixed(1))} for ${exact.map(each => each.toFixed(1))}`)
  found.forEach((value, i) => {
    const label = `${lowest[i]} m: ${value}, not ${exact[i]}`
    expectTrue(Math.abs(value / exact[i] - 1) < 0.3, label)
  })
})

gpuTest('has airglow as bright as its layer is long', async t => {
  const [altitude, width, bottomRadius] = [96_000, 4000, 6_378_137]
  const layer = { altitude, width }
  const cases: { name: string; height: number; cosView: number }[] = []
  for (const height of [0, 1e4]) {
    for (const cosView of [1, 0.7, 0.3, 0.05, 0]) cases.push({ name: 'below', height, cosView })
  }
  for (const height of [4e5, 3.6e7]) {
    for (const tangent of [60_000, 85_000, 92_000, 95_000, 96_000, 98_000, 102_000, 108_000]) {
      const sine = (bottomRadius + tangent) / (bottomRadius + height)
      cases.push({ name: 'limb', height, cosView: -Math.sqrt(1 - sine * sine) })
    }
  }
  const gpu = await t.evaluate(
    cases.map(({ height, cosView }) => [height, cosView, 0, 0]),
    input => {
      const nodes = { altitude: float(altitude), width: float(width) }
      const gains = vanRhijnFactors(nodes, input.x, input.y, float(bottomRadius), null)
      return gains.down.add(gains.up)
    }
  )
  let worst = 0
  cases.forEach(({ name, height, cosView }, i) => {
    const radius = bottomRadius + height
    const away = 2 * Math.abs(radius * cosView) + 2e6
    const exact = vanRhijnFactor(layer, radius, cosView, bottomRadius, away)
    const off = Math.abs(gpu[4 * i] - exact) / Math.max(exact, 0.5)
    worst = Math.max(worst, off)
    const label = `${name}, ${height} m, cos ${cosView}`
    expectTrue(off < 0.02, `${label}: ${gpu[4 * i]}, not ${exact}`)
  })
  const below = cases.filter(({ name }) => name === 'below')
  const thin = await t.evaluate(
    below.map(({ height, cosView }) => [height, cosView, 0, 0]),
    input => {
      const nodes = { altitude: float(altitude), width: float(width) }
      return thinLayerVanRhijnFactor(nodes, input.x, input.y, float(bottomRadius))
    }
  )
  below.forEach(({ height, cosView }, i) => {
    const exact = vanRhijnFactor(layer, bottomRadius + height, cosView, bottomRadius, 3e6)
    const off = Math.abs(thin[4 * i] / exact - 1)
    worst = Math.max(worst, off)
    expectTrue(off < 0.01, `shell, ${height} m, cos ${cosView}: ${thin[4 * i]}, not ${exact}`)
  })
  t.note(`off by ${(100 * worst).toFixed(2)} % at most`)
})

gpuTest(
  'dims stars by the air in a night that no day came before',
  async t => {
    const [width, height, fov] = [96, 54, 5]
    const renderer = await t.createRenderer({ width, height })
    for (const elevation of [60, 10, 2]) {
      const angle = (elevation * Math.PI) / 180
      // At longitude and latitude 0: the zenith is X of ECEF, which is the stars' frame without a date.
      const star: Star = {
        ascension: Math.PI / 2 - angle,
        declination: 0,
        magnitude: 1,
        colorIndex: 0
      }
      const atmosphere = new Atmosphere().setSunAngles(-60, 270)
      atmosphere.luminanceScale = 1
      atmosphere.add(new Stars({ catalogue: [star] }))
      const camera = new PerspectiveCamera(fov, width / height, 1, 1e6)
      camera.position.y = 2
      camera.lookAt(new Vector3(Math.cos(angle), Math.sin(angle), 0).add(camera.position))
      camera.updateMatrixWorld()
      const scene = new Scene()
      scene.backgroundNode = skyBackground(atmosphere)
      const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
      const { parameters } = atmosphere
      const radius = parameters.bottomRadius + 2
      const length = distanceToTop(radius, Math.sin(angle), parameters.topRadius)
      const depth = opticalDepth(parameters, radius, Math.sin(angle), length)
      const light = starIrradiance(parameters, 0, VEGA * 10 ** -0.4)
      const dimmed = light.map((value, i) => value * Math.exp(-depth[i]))
      const ratio = illuminance(picture, fov) / luminanceOf(parameters, dimmed)
      const part = luminanceOf(parameters, dimmed) / luminanceOf(parameters, light)
      t.note(
        `${elevation}° high: ${(100 * part).toFixed(1)} % is left, ${ratio.toFixed(3)} of that`
      )
      expectTrue(Math.abs(ratio - 1) < 0.03, `${elevation}° high: ${ratio} of what it should be`)
      atmosphere.dispose()
    }
  },
  { backends: ['webgpu'] }
)

gpuTest('lights a level plane at night as much as told', async t => {
  const renderer = await t.createRenderer({ width: 32, height: 32 })
  const atmosphere = new Atmosphere()
  atmosphere.luminanceScale = 1
  const scene = new Scene()
  const plane = new Mesh(
    new PlaneGeometry(100, 100).rotateX(-Math.PI / 2),
    new MeshLambertMaterial()
  )
  scene.add(plane, new NightLightProbe(atmosphere, 1e-3))
  const camera = new PerspectiveCamera(40, 1, 0.1, 100)
  camera.position.set(0, 5, 0)
  camera.lookAt(0, 0, 0)
  const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
  const got = luminance(picture.at(16, 16))
  t.note(`${got.toExponential(3)} cd/m²`)
  expectTrue(Math.abs((got * Math.PI) / 1e-3 - 1) < 0.01, `${got} cd/m²`)
  plane.geometry.dispose()
  plane.material.dispose()
  atmosphere.dispose()
})

gpuTest(
  'dims what is beyond the air deep in the night as at dusk',
  async t => {
    const renderer = await t.createRenderer({ width: 32, height: 32 })
    const atmosphere = new Atmosphere()
    atmosphere.add({ background: (_, farther) => farther.add(vec4(1)) })
    const camera = new PerspectiveCamera(60, 1, 0.1, 100)
    camera.position.y = 100
    camera.rotation.x = 0.55
    const scene = new Scene()
    scene.backgroundNode = skyBackground(atmosphere)
    const draw = (): Promise<Picture> => drawToFloat(renderer, () => renderer.render(scene, camera))
    await atmosphere.bake(renderer)
    // Night first: no hour before it has left anything behind.
    atmosphere.setSunAngles(-60, 180)
    const night = await draw()
    atmosphere.setSunAngles(-20, 180)
    const dusk = await draw()
    const [zenith, horizon] = [night.at(16, 0), night.at(16, 31)].map(luminance)
    t.note(`towards the horizon ${(horizon / zenith).toFixed(3)} of what comes from above`)
    expectTrue(horizon < 0.7 * zenith, `${horizon} at the horizon, ${zenith} above`)
    expectClose(Math.max(...relativeDifferences(night, dusk)), 0, { absolute: 1e-3 }, 'difference')
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'wants sensible airglow',
  () => {
    const fails = (options: object, message: string): void => {
      try {
        const made = new Airglow(options)
        expectTrue(false, `made ${made.luminance}`)
      } catch (error) {
        expectTrue(String(error).includes(message), `says ${String(error)}`)
      }
    }
    fails({ luminance: -1 }, 'Airglow: luminance must be in [0, 1000000000], got -1')
    fails({ altitude: NaN }, 'Airglow: altitude must be in')
    fails({ spectrum: [1, 1, 1] }, 'Airglow: spectrum must be an array of 4 values, got [1, 1, 1]')
  },
  { backends: ['webgpu'] }
)

gpuTest('folds the map of the Milky Way without a seam', async t => {
  const renderer = await t.createRenderer({ width: 4, height: 4 })
  const along = Array.from({ length: 31 }, (_, i) => (i + 1) / 32)
  // Where an edge is folded its halves are the same directions.
  const halves = [1, -1].map(half =>
    along.flatMap(x => [
      [1, half * x, 0, 0],
      [-1, half * x, 0, 0],
      [half * x, 1, 0, 0],
      [half * x, -1, 0, 0]
    ])
  )
  const [first, second] = await Promise.all(
    halves.map(points => evaluateOnGpu(renderer, points, point => milkyWayMap(point.xy)))
  )
  expectTrue(Math.max(...first) > 1, 'the band is not on the edge')
  expectClose(first, second, { relative: 1e-3 }, 'halves of the edges')
})
