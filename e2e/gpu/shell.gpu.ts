import {
  Atmosphere,
  AtmosphereParameters,
  airlessBody,
  atmosphereShell,
  skyBackground,
  type AtmosphereShellOptions,
  type Spectrum
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import {
  DirectionalLight,
  Mesh,
  MeshBasicMaterial,
  OrthographicCamera,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  SphereGeometry,
  Vector3,
  type Camera
} from 'three'
import { fitGlobeCamera } from '@welkin/geo'
import { vec4 } from 'three/tsl'
import type { Node, WebGPURenderer } from 'three/webgpu'
import { AtmosphereUniforms } from '../../packages/atmosphere/src/air/AtmosphereUniforms'
import {
  distanceToGround as distanceToGround64,
  distanceToTop as distanceToTop64,
  hitsGround
} from '../../packages/atmosphere/src/air/cpu/boundary'
import { inScatter } from '../../packages/atmosphere/src/scattering/cpu/scattering'
import { opticalDepth } from '../../packages/atmosphere/src/transmittance/cpu/transmittance'
import {
  ProfileUniforms,
  columnsToSpace,
  profileAt
} from '../../packages/atmosphere/src/shell/tsl/chapman'
import {
  distanceToGround,
  distanceToTop,
  groundDiscriminant
} from '../../packages/atmosphere/src/air/tsl/boundary'
import type { Air } from '../../packages/atmosphere/src/scattering/tsl/scattering'
import type { ShellRay } from '../../packages/atmosphere/src/shell/tsl/shellMarch'
import { singleScatteringShell } from '../../packages/atmosphere/src/shell/tsl/singleScattering'
import {
  drawForward,
  drawToFloat,
  expectLight,
  random,
  relativeDifferences
} from './harness/atmosphere'
import { expectClose, expectTrue } from './harness/expect'
import { gpuTest } from './harness/gpu-test'
import type { Picture } from './harness/picture'

const size = { width: 64, height: 36 }
const RADIUS = new AtmosphereParameters().bottomRadius
const luminance = ([r, g, b]: readonly number[]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b

/** An Earth of some size with a shell, and nothing else. */
function body(radius: number, options: AtmosphereShellOptions, color = 0x203040) {
  const scene = new Scene()
  const globe = new Mesh(new SphereGeometry(1, 256, 128), new MeshBasicMaterial({ color }))
  globe.scale.setScalar(radius)
  scene.add(globe)
  const shell = atmosphereShell(new AtmosphereParameters(), 1, options)
  if (shell === null) throw new Error('the Earth has air')
  globe.add(shell)
  return {
    scene,
    globe,
    shell,
    dispose: () => {
      shell.dispose()
      globe.geometry.dispose()
      globe.material.dispose()
    }
  }
}

const draw = (renderer: WebGPURenderer, scene: Scene, camera: Camera): Promise<Picture> =>
  drawToFloat(renderer, () => renderer.render(scene, camera))

/** A camera some radii from the centre. */
function cameraAt(distance: number, radius: number, pitch: number, fov = 50): PerspectiveCamera {
  const camera = new PerspectiveCamera(fov, 64 / 36)
  camera.position.set(0, distance * radius, 0)
  camera.rotation.x = pitch
  camera.near = Math.max((distance - 1) * 0.3, 1e-7) * radius
  camera.far = 2 * distance * radius
  camera.updateProjectionMatrix()
  camera.updateMatrixWorld()
  return camera
}

/** [distance from the centre in radii, pitch] */
const VIEWS = [
  [3, -Math.PI / 2],
  [1.06, -0.4],
  [1.0005, -0.02]
] as const

/** From so far that the air is marched, with a telescope [°]. */
const FAR_VIEW = [25, -Math.PI / 2, 6] as const

gpuTest('looks the same for bodies of any size, on any world scale', async t => {
  const renderer = await t.createRenderer({ ...size, reversedDepthBuffer: true })
  const sun = new Vector3(1, 0.6, 0.4)
  const first: Picture[] = []
  const { scene, globe, dispose } = body(1, { sun })
  for (const scale of [1, 1e-3, 1e-6]) {
    globe.scale.setScalar(RADIUS * scale)
    for (const [i, [distance, pitch]] of VIEWS.entries()) {
      const picture = await draw(renderer, scene, cameraAt(distance, RADIUS * scale, pitch))
      expectLight(picture, `scale ${scale}`)
      expectTrue(Math.max(...picture.data) > 0.05, `${distance} radii: nothing to be seen`)
      first[i] ??= picture
      const differences = relativeDifferences(first[i], picture)
      // The last pixels are the silhouette's.
      const most = differences[Math.floor(0.98 * differences.length)]
      t.note(`${distance} radii, ${scale}: ${most.toExponential(1)}`)
      expectTrue(most < 5e-3, `${distance} radii, scale ${scale}: pixels differ by ${most}`)
    }
  }
  dispose()
})

gpuTest('is the same sky as the background, inside and outside the air', async t => {
  const renderer = await t.createRenderer(size)
  // Black ground: what is left is the air alone, as a shell without a body has it.
  const parameters = new AtmosphereParameters({ groundAlbedo: [0, 0, 0, 0] })
  const atmosphere = new Atmosphere({ parameters, ellipsoid: new Ellipsoid(RADIUS, RADIUS) })
  atmosphere.worldToECEF.identity()
  for (const sun of [
    new Vector3(1, 0.6, 0.4),
    new Vector3(1, 0.02, -0.5),
    new Vector3(1, -0.1, -1)
  ]) {
    atmosphere.sunDirection = sun
    for (const [distance, pitch, fov] of [...VIEWS, FAR_VIEW]) {
      const camera = cameraAt(distance, RADIUS, pitch, fov)
      const scene = new Scene()
      const background = skyBackground(atmosphere)
      background.showSun = false
      scene.backgroundNode = background
      const expected = await drawForward(renderer, scene, camera, atmosphere)
      const shell = atmosphereShell(parameters, RADIUS, { sun: atmosphere })!
      const alone = new Scene().add(shell)
      const picture = await draw(renderer, alone, camera)
      // Where there is light: a hundredth of the brightest is dusk, which eight steps only sketch.
      const brightest = Math.max(...expected.data.filter((_, i) => i % 4 === 1))
      const errors: number[] = []
      for (let i = 0; i < expected.data.length; i += 4) {
        const [want, got] = [expected, picture].map(({ data }) =>
          luminance(Array.from(data.slice(i, i + 3)))
        )
        if (want > 0.01 * brightest) errors.push(Math.abs(got / want - 1))
      }
      errors.sort((x, y) => x - y)
      const [middle, most] = [0.5, 0.95].map(part => errors[Math.floor(part * errors.length)])
      t.note(`${distance} radii: median ${middle.toExponential(1)}, p95 ${most.toExponential(1)}`)
      expectTrue(errors.length > 100, `${distance} radii: only ${errors.length} pixels have light`)
      const [likely, worst] = fov === undefined ? [0.001, 0.002] : [0.005, 0.02]
      expectTrue(
        middle < likely && most < worst,
        `${distance} radii, sun ${sun.y}: ${middle}, ${most}`
      )
      shell.dispose()
    }
  }
  atmosphere.dispose()
})

gpuTest(
  'scatters once without tables about as the tables say, and on the night side not',
  async t => {
    const renderer = await t.createRenderer(size)
    const sun = new Vector3(0.3, 1, 0.2)
    const lightIn = async (model: 'tables' | 'single-scattering'): Promise<number[]> => {
      const { scene, globe, dispose } = body(1, { sun, model })
      globe.material.visible = false
      const sums: number[] = []
      for (const [distance, pitch] of VIEWS) {
        const { data } = await draw(renderer, scene, cameraAt(distance, 1, pitch))
        sums.push(data.reduce((sum, value, i) => (i % 4 === 1 ? sum + value : sum), 0))
      }
      dispose()
      return sums
    }
    const [all, once] = [await lightIn('tables'), await lightIn('single-scattering')]
    VIEWS.forEach(([distance], i) => {
      const part = once[i] / all[i]
      t.note(`${distance} radii: ${part.toFixed(2)} of all light`)
      expectTrue(
        part > 0.4 && part < 0.95,
        `${distance} radii: single scattering is ${part} of all`
      )
    })
    const { scene, dispose } = body(1, { sun: new Vector3(0, -1, 0), model: 'single-scattering' })
    const night = await draw(renderer, scene, cameraAt(1.0005, 1, 0.5))
    expectTrue(
      Math.max(...night.data.filter((_, i) => i % 4 < 3)) < 1e-6,
      'the night sky is not dark'
    )
    dispose()
  }
)

gpuTest('knows how much air is between a point and the sun without a table', async t => {
  // A wavelength per constituent, so that depths are columns; and air that ends where none is left.
  const one = (k: number): Spectrum => [0, 1, 2, 3].map(i => (i === k ? 1e-5 : 0)) as never
  const parameters = new AtmosphereParameters({
    topRadius: RADIUS + 120_000,
    rayleighScattering: one(0),
    mieScattering: [0, 0, 0, 0],
    mieExtinction: one(1),
    absorptionExtinction: one(2)
  })
  const uniforms = new AtmosphereUniforms()
  uniforms.update(parameters, 1)
  const constants = new ProfileUniforms()
  constants.update(parameters)
  const { bottomRadius, topRadius } = parameters
  const inputs = Array.from({ length: 600 }, (_, i) => {
    const altitude = 3e4 * ((i * 0.6180339887) % 1) ** 2
    const horizon = -Math.sqrt(altitude * (2 * bottomRadius + altitude)) / (bottomRadius + altitude)
    return [altitude, horizon + (1 - horizon) * ((i * 0.7548776662) % 1) ** 2].map(Math.fround)
  })
  const results = await t.evaluate(inputs, input => {
    const profile = profileAt(uniforms, constants, input.x)
    return vec4(columnsToSpace(uniforms, constants, input.x, input.y, profile), 1)
  })
  const worst = [0, 0, 0]
  inputs.forEach(([altitude, cosView], i) => {
    const radius = bottomRadius + altitude
    const length = distanceToTop64(radius, cosView, topRadius)
    const expected = opticalDepth(parameters, radius, cosView, length)
    worst.forEach((most, k) => {
      // Less than a hundredth of the vertical column is no air to speak of.
      const least = [80, 12, 150][k]
      const error = Math.abs(results[4 * i + k] - expected[k] * 1e5) / (expected[k] * 1e5 + least)
      worst[k] = Math.max(most, error)
    })
  })
  t.note(`worst: ${worst.map(error => error.toFixed(3)).join(', ')}`)
  const [molecules, aerosols, absorber] = worst
  expectTrue(molecules < 0.015, `molecules are off by ${molecules}`)
  expectTrue(aerosols < 0.015, `aerosols are off by ${aerosols}`)
  expectTrue(absorber < 0.3, `the absorber is off by ${absorber}`)
})

/** The way of a ray of altitude, μ, μ_s and ν, from within the air. */
function wayOf({ bottomRadius, thickness }: AtmosphereUniforms, ray: Node<'vec4'>): ShellRay {
  const { x: altitude, y: cosView, z: cosSun, w: cosViewSun } = ray
  const radius = bottomRadius.add(altitude).toConst()
  const discriminant = groundDiscriminant(altitude, cosView, bottomRadius).toConst()
  const meetsGround = discriminant.greaterThanEqual(0).and(cosView.lessThan(0)).toConst()
  const nearest = cosView.mul(cosView).oneMinus().sqrt().mul(radius).sub(bottomRadius).max(0)
  return {
    altitude,
    radius,
    radial: radius.mul(cosView).toConst(),
    sunward: radius.mul(cosSun).toConst(),
    cosViewSun,
    lowest: meetsGround.select(0, cosView.lessThan(0).select(nearest, altitude)).toConst(),
    hitsGround: meetsGround,
    length: meetsGround
      .select(
        distanceToGround(altitude, cosView, discriminant, bottomRadius),
        distanceToTop(altitude, cosView, bottomRadius, thickness)
      )
      .toConst()
  }
}

gpuTest('scatters once as float64 has it, with few points', async t => {
  const parameters = new AtmosphereParameters()
  const uniforms = new AtmosphereUniforms()
  uniforms.update(parameters, 1)
  const constants = new ProfileUniforms()
  constants.update(parameters)
  const { bottomRadius, topRadius } = parameters
  const next = random(7)
  for (const [name, sunRange, most] of [
    ['by day', [0.2, 1], [0.003, 0.02]],
    ['at dusk', [-0.05, 0.15], [0.015, 0.12]]
  ] as const) {
    const rays = Array.from({ length: 400 }, (_, i) => {
      // From the ground, from within the air, and from its top, where rays from space come in.
      const altitude = [2, 2 + 2e4 * next() ** 2, topRadius - bottomRadius][i % 3]
      const cosView = i % 3 === 2 ? -0.2 - 0.8 * next() : (i % 2 ? 1 : -1) * (0.01 + 0.99 * next())
      const cosSun = sunRange[0] + (sunRange[1] - sunRange[0]) * next()
      const [sinView, sinSun] = [cosView, cosSun].map(x => Math.sqrt(1 - x * x))
      const cosViewSun = cosView * cosSun + sinView * sinSun * Math.cos(Math.PI * next())
      return [altitude, i % 3 === 0 ? Math.abs(cosView) : cosView, cosSun, cosViewSun].map(
        Math.fround
      )
    })
    const results = await t.evaluate(rays, input => {
      const ray = input.toVar()
      return singleScatteringShell({ uniforms } as Air, constants, wayOf(uniforms, ray)).radiance
    })
    const errors: number[] = []
    rays.forEach(([altitude, cosView, cosSun, cosViewSun], i) => {
      const radius = bottomRadius + altitude
      const length = hitsGround(radius, cosView, bottomRadius)
        ? distanceToGround64(radius, cosView, bottomRadius)
        : distanceToTop64(radius, cosView, topRadius)
      const ray = { radius, cosView, cosSun, cosViewSun }
      const [, green] = inScatter(parameters, null, ray, length)
      if (green > 1e-5) errors.push(Math.abs(results[4 * i + 1] / green - 1))
    })
    errors.sort((x, y) => x - y)
    const [middle, high] = [0.5, 0.95].map(part => errors[Math.floor(part * errors.length)])
    t.note(`${name}: median ${(100 * middle).toFixed(2)} %, p95 ${(100 * high).toFixed(1)} %`)
    expectTrue(errors.length > 300, `${name}: only ${errors.length} rays have light`)
    expectTrue(middle < most[0] && high < most[1], `${name}: off by ${middle}, ${high}`)
  }
})

gpuTest('follows body, camera and light, as bright as the light', async t => {
  const renderer = await t.createRenderer(size)
  const light = new DirectionalLight(0xffffff, 5)
  light.position.set(1, 0.6, 0.4)
  const { scene, globe, shell, dispose } = body(1, { sun: light })
  scene.add(light, light.target)
  const camera = cameraAt(3, 1, -Math.PI / 2)
  const before = await draw(renderer, scene, camera)
  const shift = new Vector3(40, -3, 7)
  globe.position.add(shift)
  camera.position.add(shift)
  camera.updateMatrixWorld()
  const moved = await draw(renderer, scene, camera)
  const change = relativeDifferences(before, moved)
  expectTrue(change[Math.floor(0.99 * change.length)] < 1e-3, 'moving all changes the picture')
  globe.material.visible = false
  const one = await draw(renderer, scene, camera)
  light.intensity = 10
  const two = await draw(renderer, scene, camera)
  expectClose(
    two.data.filter((_, i) => i % 4 < 3),
    one.data.filter((_, i) => i % 4 < 3).map(value => 2 * value),
    { relative: 1e-3, absolute: 1e-6 },
    'twice the light'
  )
  // White light of 10 lux is scattered into no more than 10/π on a whole day side.
  expectTrue(Math.max(...two.data) < 10 / Math.PI, `air shines as ${Math.max(...two.data)}`)
  light.position.negate()
  const behind = await draw(renderer, scene, camera)
  expectTrue(relativeDifferences(two, behind).at(-1)! > 0.5, 'the light was not followed')
  expectTrue(shell.sun === light, 'the light is not its sun')
  dispose()
})

function depthRenderer(kind: string) {
  return {
    ...size,
    reversedDepthBuffer: kind === 'reversed',
    logarithmicDepthBuffer: kind === 'logarithmic'
  }
}

for (const depth of ['standard', 'reversed', 'logarithmic'] as const) {
  gpuTest(`hides behind what is near and hazes what is far, with ${depth} depth`, async t => {
    const renderer = await t.createRenderer(depthRenderer(depth))
    const { scene, dispose } = body(RADIUS, { sun: new Vector3(0, 1, 0.3) }, 0x000000)
    // A ship between the eye and the air, before the globe's left half.
    const ship = new Mesh(
      new PlaneGeometry(2 * RADIUS, 4 * RADIUS).rotateX(-Math.PI / 2),
      new MeshBasicMaterial({ color: 0x808080 })
    )
    ship.position.set(-RADIUS, 1.2 * RADIUS, 0)
    scene.add(ship)
    for (const isOrthographic of [false, true]) {
      const camera = isOrthographic
        ? new OrthographicCamera(-9e6, 9e6, 5e6, -5e6)
        : new PerspectiveCamera(50, 64 / 36)
      camera.position.set(0, 3 * RADIUS, 0)
      camera.up.set(0, 0, -1)
      camera.lookAt(0, 0, 0)
      camera.updateMatrixWorld()
      fitGlobeCamera(camera, {
        depth: isOrthographic && depth === 'logarithmic' ? 'standard' : depth
      })
      if (isOrthographic) Object.assign(camera, { near: 0.1 * RADIUS, far: 4 * RADIUS })
      camera.updateProjectionMatrix()
      const picture = await draw(renderer, scene, camera)
      const bare = luminance([0.2159, 0.2159, 0.2159])
      const [onShip, onGlobe] = [luminance(picture.at(28, 18)), luminance(picture.at(36, 18))]
      const kind = isOrthographic ? 'orthographic' : 'perspective'
      t.note(`${kind}: ship ${onShip.toFixed(3)}, globe ${onGlobe.toFixed(3)}`)
      expectClose(onShip, bare, { relative: 0.01 }, `${kind}, the ship`)
      expectTrue(onGlobe > 0.02, `${kind}: the globe has no haze, ${onGlobe}`)
    }
    ship.geometry.dispose()
    ship.material.dispose()
    dispose()
  })
}

gpuTest('is not there for a body without air, and frees what it took', async t => {
  expectTrue(atmosphereShell(airlessBody(), 1) === null, 'the Moon has a shell')
  const renderer = await t.createRenderer(size)
  const { scene, globe, shell } = body(1, {})
  const camera = cameraAt(3, 1, -1.5)
  globe.remove(shell)
  await draw(renderer, scene, camera)
  const before = { ...renderer.info.memory }
  globe.add(shell)
  await draw(renderer, scene, camera)
  expectTrue(renderer.info.memory.textures > before.textures, 'the shell has no tables')
  globe.remove(shell)
  shell.dispose()
  await draw(renderer, scene, camera)
  const { textures, geometries } = renderer.info.memory
  expectTrue(textures <= before.textures, `${textures} textures, before ${before.textures}`)
  expectTrue(geometries <= before.geometries + 1, `${geometries}, before ${before.geometries}`)
})

/** How often a renderer was told to draw into targets whose names start so. */
function countPasses(renderer: WebGPURenderer, name: string): () => number {
  let count = 0
  const setRenderTarget = renderer.setRenderTarget.bind(renderer)
  renderer.setRenderTarget = (target, ...rest) => {
    if (target?.texture.name.startsWith(name) === true) count++
    setRenderTarget(target, ...rest)
  }
  return () => count
}

gpuTest('bakes once for all shells of the same parameters', async t => {
  const [renderer, other] = [await t.createRenderer(size), await t.createRenderer(size)]
  const baked = countPasses(renderer, 'Transmittance')
  const camera = cameraAt(3, 1, -Math.PI / 2)
  const parameters = new AtmosphereParameters()
  const sun = new Vector3(0.3, 1, 0.2)
  const make = (shared = parameters) => {
    const shell = atmosphereShell(shared, 1, { sun })
    if (shell === null) throw new Error('the Earth has air')
    return shell
  }
  const textures = (): number => renderer.info.memory.textures
  const scene = new Scene()
  const first = make()
  scene.add(first)
  const before = await draw(renderer, new Scene(), camera).then(textures)
  const alone = await draw(renderer, scene, camera)
  expectLight(alone, 'one shell')
  const withOne = textures()
  expectTrue(baked() === 1, `${baked()} bakes for the first`)

  // Each with another part of its body towards the camera: they share no volume.
  const others = [1.5, 2, 3].map((radius, i) => {
    const shell = make()
    shell.scale.setScalar(radius)
    shell.position.set(0, -1e3 * (i + 1), 0)
    return shell
  })
  const cameras = others.map(({ position, scale }) => {
    const eye = cameraAt(3, scale.x, -Math.PI / 2)
    eye.position.add(position)
    eye.updateMatrixWorld()
    return eye
  })
  scene.add(...others)
  const drawn: Picture[] = []
  for (const eye of [camera, ...cameras]) drawn.push(await draw(renderer, scene, eye))
  expectTrue(baked() === 1, `${baked()} bakes for four`)
  const each = (textures() - withOne) / 3
  t.note(`the first takes ${withOne - before} textures, each other ${each}`)
  expectTrue(each <= 3, `each other shell takes ${each} textures`)
  const expectSame = (picture: Picture, what: string): void => {
    const differences = relativeDifferences(alone, picture)
    // The last pixels are the silhouette's.
    const most = differences[Math.floor(0.98 * differences.length)]
    expectTrue(most < 5e-3, `${what} differs from one alone by ${most}`)
  }
  drawn.forEach((picture, i) => expectSame(picture, `shell ${i}`))
  expectSame(await draw(other, scene, camera), 'one on another renderer')
  await draw(renderer, scene, camera)
  expectTrue(baked() === 1, `${baked()} bakes for two renderers in turn`)

  for (const shell of [first, others[0], others[2]]) {
    scene.remove(shell)
    shell.dispose()
    shell.dispose()
  }
  const left = await draw(renderer, scene, cameras[1])
  const change = relativeDifferences(drawn[2], left)
  expectTrue(change.at(-1)! < 1e-6, 'the last shell suffers from what others dispose of')
  expectTrue(baked() === 1, `${baked()} bakes with one left`)
  parameters.set({ mieScaleHeight: 2400 })
  const hazier = await draw(renderer, scene, cameras[1])
  expectTrue(baked() === 2, `${baked()} bakes after a change`)
  expectTrue(relativeDifferences(left, hazier).at(-1)! > 0.01, 'a change is not to be seen')

  scene.remove(others[1])
  others[1].dispose()
  await draw(renderer, scene, camera)
  expectTrue(textures() <= before, `${textures()} textures left, before ${before}`)
  const next = make()
  scene.add(next)
  await draw(renderer, scene, camera)
  expectTrue(baked() === 3, `${baked()} bakes after all were disposed of`)
  next.dispose()
})

gpuTest('names what is wrong with its arguments', () => {
  const parameters = new AtmosphereParameters()
  const right = atmosphereShell(parameters, 1)!
  const wrong = [null, 'noon', 3, {}, [], new Vector3(NaN, 1, 0), new Vector3()] as never[]
  for (const [make, message] of [
    [() => atmosphereShell(parameters, 0), /AtmosphereShell: bodyRadius must be positive.*got 0/],
    [
      () => atmosphereShell(null as never, 1),
      /parameters must be AtmosphereParameters, got object/
    ],
    [() => atmosphereShell(parameters, 1, { model: 'none' as never }), /model must be .*got none/],
    [() => atmosphereShell(parameters, 1, { luminanceScale: NaN }), /luminanceScale .*NaN/],
    [() => (right.luminanceScale = -1), /AtmosphereShell: luminanceScale must be positive.*got -1/],
    ...wrong.flatMap(sun => [
      [() => atmosphereShell(parameters, 1, { sun }), /AtmosphereShell: sun must be an.*, got ./],
      [() => (right.sun = sun), /AtmosphereShell: sun must be an.*, got ./]
    ])
  ] as [() => unknown, RegExp][]) {
    let said = ''
    try {
      make()
    } catch (error) {
      said = String(error)
    }
    expectTrue(message.test(said), `${message} expected, got '${said}'`)
  }
})
