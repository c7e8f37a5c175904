import {
  Atmosphere,
  moon,
  MoonDirectionalLight,
  precipitationOverlay,
  PrecipitationShelter,
  rainfall,
  SkyLightProbe,
  snowfall,
  SunDirectionalLight,
  SurfaceWater,
  wetSurface,
  type Precipitation
} from '@welkin/atmosphere'
import {
  AmbientLight,
  DirectionalLight,
  MathUtils,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  PointLight,
  Scene,
  SpotLight,
  Vector3
} from 'three'
import { float, positionWorld, sin, vec3, vec4 } from 'three/tsl'
import { MeshBasicNodeMaterial, MeshStandardNodeMaterial, RenderPipeline } from 'three/webgpu'
import { LampUniforms } from '../../../packages/atmosphere/src/precipitation/LampUniforms'
import { rain, snow } from '../../../packages/atmosphere/src/precipitation/ParticleKind'
import { rippleSlope } from '../../../packages/atmosphere/src/precipitation/tsl/rippleSlope'
import {
  drawnDepth,
  flakeWidth
} from '../../../packages/atmosphere/test/twins/precipitation/meanDepth'
import { drawToFloat, expectLight, random } from '../harness/atmosphere'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'

const size = { width: 160, height: 90 }

/** Mean of a channel over columns of a picture. */
function mean({ width, height, data }: Picture, channel: number, from = 0, to = width): number {
  let sum = 0
  for (let y = 0; y < height; y++)
    for (let x = from; x < to; x++) sum += data[4 * (y * width + x) + channel]
  return sum / height / (to - from)
}

function view(): { scene: Scene; camera: PerspectiveCamera; atmosphere: Atmosphere } {
  const camera = new PerspectiveCamera(50, size.width / size.height, 0.05, 1000)
  camera.position.set(120, 30, -80)
  camera.rotation.y = 0.4
  camera.updateMatrixWorld()
  return { scene: new Scene(), camera, atmosphere: new Atmosphere() }
}

gpuTest(
  'rain and snow dim a view as much as their sizes say',
  async t => {
    const renderer = await t.createRenderer({ ...size, alpha: true })
    const { scene, camera, atmosphere } = view()
    renderer.setClearColor(0, 0)
    const widths = { rain: (d: number) => d / 1000, snow: flakeWidth }
    for (const [falling, kind, rate, widthOf] of [
      [rainfall(atmosphere, { rate: 25, time: 30 }), rain, 25, widths.rain],
      [snowfall(atmosphere, { rate: 2, time: 30 }), snow, 2, widths.snow]
    ] as const) {
      scene.clear()
      scene.add(falling)
      // At one time alone the few large drops nearby count too much.
      const times = [30, 31.7, 33.1, 36.5, 39.8, 42.2]
      const opacities: number[] = []
      for (const time of times) {
        falling.time = time
        opacities.push(mean(await t.render(renderer, scene, camera, size), 3))
      }
      const opacity = opacities.reduce((a, b) => a + b) / times.length
      const expected = 1 - Math.exp(-drawnDepth(kind, rate, widthOf))
      t.note(`${kind.name}: ${opacity.toExponential(3)} of ${expected.toExponential(3)}`)
      expectClose(opacity, expected, { relative: 0.03 }, kind.name)
      if (kind === rain) {
        // The longer the shutter is open, the longer streaks are, each as much fainter.
        const seen = async (shutter: number): Promise<{ touched: number; opacity: number }> => {
          falling.shutter = shutter
          const picture = await t.render(renderer, scene, camera, size)
          const touched = picture.data.filter((alpha, i) => i % 4 === 3 && alpha > 1e-6).length
          return { touched, opacity: mean(picture, 3) }
        }
        const [brief, long] = [await seen(1 / 500), await seen(1 / 60)]
        const longer = long.touched / brief.touched
        t.note(`at 1/60 s ${longer.toFixed(2)} times as many pixels as at 1/500 s`)
        expectTrue(longer > 1.5, `${longer} times as many pixels`)
        expectClose(long.opacity, brief.opacity, { relative: 0.05 }, 'opacity at 1/60 s')
      }
      falling.rate = 0
      const none = await t.render(renderer, scene, camera, size)
      expectTrue(mean(none, 3) === 0, `${kind.name} at rate 0`)
      falling.dispose()
    }
  },
  // WebGL draws rain and snow in `everything`.
  { backends: ['webgpu'] }
)

gpuTest(
  'rain is lit, hidden by depth and roofs, and frees its memory',
  async t => {
    const renderer = await t.createRenderer({ ...size, reversedDepthBuffer: true })
    const { scene, camera, atmosphere } = view()
    const sun = new SunDirectionalLight(atmosphere)
    const lamp = new PointLight('#ffffff', 5)
    const spot = new SpotLight('#ffffff', 5)
    const ambient = new AmbientLight('#ffffff', 1)
    scene.add(sun, sun.target, lamp, spot, spot.target, ambient, new SkyLightProbe(atmosphere))
    for (const light of [lamp, spot, spot.target]) light.position.copy(camera.position)
    lamp.position.y += 2
    const draw = async (): Promise<Picture> => {
      await nextFrame()
      return drawToFloat(renderer, () => renderer.render(scene, camera))
    }
    scene.updateMatrixWorld(true)
    renderer.setClearColor(0, 1)
    const shelter = new PrecipitationShelter(scene, { size: 64 })
    const lights = scene.children.filter(child => 'isLight' in child) as never[]
    const options = { rate: 40, lights, shelter, time: 10, maxParticles: 20_000 }
    const falling: Precipitation = rainfall(atmosphere, options)
    scene.add(falling)
    const open = await draw()
    expectLight(open, 'rain')
    const light = mean(open, 1)
    expectTrue(light > 0, `rain has light ${light}`)

    // Lamps add up: four spots at a place are one of four times its light.
    const lampOptions = { rate: 40, time: 10, maxParticles: 20_000 }
    const litBy = async (intensity: number, count: number): Promise<number> => {
      const lamps = Array.from({ length: count }, () => new SpotLight('#ffffff', intensity))
      for (const one of lamps) {
        one.position.copy(camera.position).y += 1
        one.updateMatrixWorld()
      }
      const own = rainfall(atmosphere, { ...lampOptions, lights: lamps })
      scene.remove(falling).add(own)
      const drawn = mean(await draw(), 1)
      scene.remove(own).add(falling)
      own.dispose()
      return drawn
    }
    const [four, one] = [await litBy(5, 4), await litBy(20, 1)]
    expectTrue(one > 0, 'a spot lights rain')
    expectClose(four, one, { relative: 1e-3 }, 'four spots')

    // A wall before the left half, nearer than the first drops.
    const black = new MeshBasicMaterial({ color: 0, side: 2 })
    const wall = new Mesh(new PlaneGeometry(1, 1), black)
    camera.add(wall)
    scene.add(camera)
    wall.position.set(-0.5, 0, -0.1)
    const walled = await draw()
    expectTrue(mean(walled, 1, 0, 79) === 0, 'nothing is drawn behind the wall')
    expectTrue(mean(walled, 1, 82) > 0, 'there is rain beside the wall')
    camera.remove(wall)

    // A roof over all of the map, which the shelter knows of after its next drawing.
    const roof = new Mesh(new PlaneGeometry(80, 80), black)
    roof.rotation.x = Math.PI / 2
    roof.position.copy(camera.position)
    roof.position.y += 20
    scene.add(roof)
    shelter.needsUpdate = true
    await draw()
    const sheltered = await draw()
    t.note(`light of rain ${light.toExponential(2)}, under a roof ${mean(sheltered, 1)}`)
    expectTrue(mean(sheltered, 1) < 1e-6, 'it does not rain under the roof')
    scene.remove(roof)
    // Tables of the air stay; a second rain frees as much as it takes.
    const before = renderer.info.memory.textures
    const again = rainfall(atmosphere, { lights, rate: 1, time: 10 })
    scene.add(again)
    await draw()
    const most = renderer.info.memory.textures
    again.dispose()
    expectTrue(most > before, `a second rain takes ${most - before} textures`)
    expectTrue(renderer.info.memory.textures === before, 'and frees them')
    falling.dispose()
    shelter.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'rain has as much of the moon’s light as a wall has, which another light gives as well',
  async t => {
    const renderer = await t.createRenderer(size)
    const { scene, camera, atmosphere } = view()
    atmosphere.setSunAngles(-30, 0)
    const luna = moon({
      mapSize: 64,
      phase: 0.5,
      direction: new Vector3(0.5, 0.6, 0.7).normalize()
    })
    const moonlight = new MoonDirectionalLight(atmosphere, luna)
    const lamp = new DirectionalLight('#ffffff', 2)
    lamp.position.copy(luna.direction!)
    const wall = new Mesh(new PlaneGeometry(100, 100), new MeshLambertMaterial({ color: 0xffffff }))
    wall.position.copy(camera.position)
    wall.quaternion.copy(camera.quaternion)
    wall.translateZ(-20)
    const drawn = async (light: DirectionalLight): Promise<number[]> => {
      const falling = rainfall(atmosphere, {
        rate: 40,
        time: 10,
        maxParticles: 5000,
        lights: [light]
      })
      scene.clear()
      // The light follows the camera where it stands in the scene, as the wall does.
      scene.add(light, light.target, falling)
      light.target.position.copy(camera.position)
      if (light === lamp) light.position.copy(luna.direction!).add(camera.position)
      await nextFrame()
      const rained = await drawToFloat(renderer, () => renderer.render(scene, camera))
      scene.remove(falling).add(wall)
      await nextFrame()
      const bare = await drawToFloat(renderer, () => renderer.render(scene, camera))
      falling.dispose()
      return [0, 1, 2].map(channel => mean(rained, channel) / mean(bare, channel))
    }
    renderer.setClearColor(0, 1)
    const [byMoon, byLamp] = [await drawn(moonlight), await drawn(lamp)]
    const say = (parts: readonly number[]): string => parts.map(x => x.toExponential(3)).join(', ')
    t.note(`by the moon ${say(byMoon)}, by the other ${say(byLamp)} of the wall's light`)
    expectTrue(byLamp[1] > 0, 'there is rain')
    expectClose(byMoon, byLamp, { relative: 0.01 }, 'moonlit rain')
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'four lamps light what falls around them as three lights surfaces, by distance and cone',
  async t => {
    const renderer = await t.createRenderer(size)
    const camera = new PerspectiveCamera()
    camera.position.set(40, -7, 12)
    camera.rotation.set(0.2, 1.1, 0)
    camera.updateMatrixWorld()
    const draw = random(5)
    const near = (spread: number): Vector3 =>
      new Vector3(draw(), draw(), draw()).subScalar(0.5).multiplyScalar(spread).add(camera.position)
    const lamps = [
      new PointLight('#ffffff', 8),
      new PointLight('#ffffff', 3, 12, 1),
      new SpotLight('#ffffff', 20, 0, 0.9, 0.5),
      new SpotLight('#ffffff', 9, 25, 0.6, 0)
    ]
    for (const lamp of lamps) {
      lamp.position.copy(near(16))
      lamp.updateMatrixWorld()
      if (!(lamp instanceof SpotLight)) continue
      lamp.target.position.copy(camera.position)
      lamp.target.updateMatrixWorld()
    }
    const uniforms = lamps.map(lamp => new LampUniforms(lamp))
    for (const one of uniforms) one.update(camera)
    const places = Array.from({ length: 200 }, () => near(14))
    const inputs = places.map(place => place.clone().applyMatrix4(camera.matrixWorldInverse))
    const found = await evaluateOnGpu(
      renderer,
      inputs.map(place => place.toArray()),
      input => {
        const light = uniforms.map(one => one.at(input.xyz as never).illuminance.x)
        return vec4(light[0], light[1], light[2], light[3])
      }
    )
    const lit = [0, 0, 0, 0]
    places.forEach((place, i) =>
      lamps.forEach((lamp, k) => {
        const way = lamp.position.clone().sub(place)
        const distance = way.length()
        const { decay, intensity, distance: end } = lamp
        // Candela by the distance's power, let out towards the lamp's end (Karis 2013), and the cone's edge.
        const window = end > 0 ? Math.max(1 - (distance / end) ** 4, 0) ** 2 : 1
        let expected = (intensity * window) / distance ** decay
        if (lamp instanceof SpotLight) {
          const axis = lamp.position.clone().sub(lamp.target.position).normalize()
          const [edge, inside] = [Math.cos(lamp.angle), Math.cos(lamp.angle * (1 - lamp.penumbra))]
          const cosine = way.dot(axis) / distance
          if (lamp.penumbra === 0 && Math.abs(cosine - edge) < 1e-3) return
          expected *= MathUtils.smoothstep(cosine, edge, inside)
        }
        if (expected > 0) lit[k]++
        const told = `lamp ${k} at ${distance.toFixed(2)} m`
        expectClose([found[4 * i + k]], [expected], { relative: 2e-4, absolute: 1e-6 }, told)
      })
    )
    t.note(`${lit.join(', ')} of ${places.length} places lit`)
    expectTrue(lit[0] === 200 && lit.every(count => count > 20), 'lamps light places')
    expectTrue(lit[2] < 190 && lit[3] < 190, 'cones end')
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'precipitationOverlay draws in front of the depth that it is given',
  async t => {
    const renderer = await t.createRenderer(size)
    const { camera, atmosphere } = view()
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    const lights = [new AmbientLight('#ffffff', 3)]
    const drawn: number[] = []
    for (const depth of [1, 0.5]) {
      // Far, and at twice the near plane: before all drops.
      const falling = snowfall(atmosphere, {
        lights,
        rate: 3,
        time: 5,
        depth: float(depth),
        depthCamera: camera,
        maxParticles: 20_000
      })
      const overlay = precipitationOverlay(vec4(0.5, 0.5, 0.5, 1), camera, [falling])
      pipeline.outputNode = overlay
      pipeline.needsUpdate = true
      await nextFrame()
      const picture = await drawToFloat(renderer, () => pipeline.render())
      expectLight(picture, 'overlay')
      drawn.push(
        picture.data.filter((value, i) => i % 4 < 3 && Math.abs(value - 0.5) > 1e-4).length
      )
      overlay.dispose()
      falling.dispose()
    }
    expectTrue(drawn[0] > 1000 && drawn[1] === 0, `${drawn.join(' and ')} values changed`)
    pipeline.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'a surface darkens, puddles and whitens as its water and snow say',
  async t => {
    const small = { width: 32, height: 32 }
    const renderer = await t.createRenderer(small)
    const camera = new PerspectiveCamera(50, 1, 0.1, 100)
    camera.position.set(0, 2, 0)
    camera.rotation.x = -Math.PI / 2
    const water = new SurfaceWater()
    const options = { color: vec3(0.3), roughness: float(0.9), hollows: float(0.5), time: float(7) }
    const nodes = wetSurface(water, options)
    const shown = new MeshBasicNodeMaterial()
    const ground = new Mesh(new PlaneGeometry(8, 8), shown)
    ground.rotation.x = -Math.PI / 2
    const scene = new Scene()
    scene.add(ground)
    const values = async (color: typeof shown.colorNode): Promise<Picture> => {
      shown.colorNode = color
      shown.needsUpdate = true
      return t.render(renderer, scene, camera, small)
    }
    const look = async (): Promise<number[]> => [
      mean(await values(nodes.colorNode), 0),
      mean(await values(vec3(nodes.roughnessNode)), 0)
    ]
    const expectLook = async (albedo: number, roughness: number, what: string): Promise<void> => {
      const [a, r] = await look()
      expectClose(a, albedo, { absolute: 1e-3 }, `albedo, ${what}`)
      expectClose(r, roughness, { absolute: 1e-3 }, `roughness, ${what}`)
    }
    await expectLook(0.3, 0.9, 'dry')
    // A share 1 − 1/n² of what is scattered is reflected back, again and again: A/n² Σ (A(1 − 1/n²))ᵏ.
    const back = 1 - 1 / 1.333 ** 2
    const wet = (0.3 * (1 - back)) / (1 - 0.3 * back)
    water.water = water.filmCapacity
    await expectLook(wet, 0.15, 'wet')
    water.water = 2.5
    await expectLook(wet, 0.04, 'puddle')
    // Hollows as small as pixels: full ones are under water, dry ones are not.
    const uneven = wetSurface(water, {
      ...options,
      hollows: sin(positionWorld.x.mul(40)).mul(0.5).add(0.5)
    })
    const roughness = async (): Promise<number> => mean(await values(vec3(uneven.roughnessNode)), 0)
    expectClose(await roughness(), 0.04, { absolute: 1e-3 }, 'full hollows')
    water.water = 0
    expectClose(await roughness(), 0.9, { absolute: 1e-3 }, 'dry hollows')
    water.water = 2.5
    const still = await values(nodes.normalNode)
    expectClose(mean(still, 2), 1, { absolute: 1e-3 }, 'a still puddle is level')
    water.update(0, { rain: 25 })
    const tilted = async (): Promise<number> =>
      (await values(nodes.normalNode)).data.filter((x, i) => i % 4 === 0 && Math.abs(x) > 0.01)
        .length
    // Waves of 17 mm are lost in pixels of 58 mm: they are roughness, by the variance of slopes at random places and times.
    expectTrue((await tilted()) === 0, 'no ring is seen from afar')
    const draw = random(5)
    const places = Array.from({ length: 8192 }, () => [50, 50, 90].map(to => to * draw()))
    const slopes = await evaluateOnGpu(renderer, places, ({ xy, z }) =>
      rippleSlope(xy, z, water.ringRateNode)
    )
    const variance =
      places.reduce((sum, _, i) => sum + slopes[4 * i] ** 2 + slopes[4 * i + 1] ** 2, 0) /
      (2 * places.length)
    const rough = (0.04 ** 4 + 2 * variance) ** 0.25
    t.note(`deviation of slopes ${Math.sqrt(variance).toFixed(4)}`)
    expectClose((await look())[1], rough, { relative: 0.03 }, 'roughness, rings from afar')
    camera.position.y = 0.35
    const spread = await tilted()
    expectTrue(spread > 10, `rings tilt ${spread} of ${32 * 32} pixels`)
    water.snow = 40
    await expectLook(0.93, 0.9, 'snow')

    const lit = new MeshStandardNodeMaterial({ color: 0x808080 })
    Object.assign(lit, wetSurface(water))
    water.snow = 1
    ground.material = lit as never
    scene.add(new AmbientLight('#ffffff', 3))
    expectLight(await t.render(renderer, scene, camera, small), 'a lit surface')
  },
  { backends: ['webgpu'] }
)
