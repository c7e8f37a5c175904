import {
  aerialPerspectiveFog,
  Atmosphere,
  AtmosphereParameters,
  airlessParameters,
  AtmosphereShell,
  skyBackground
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
  Vector3
} from 'three'
import { fitGlobeCamera } from '@welkin/geo'
import { drawForward, expectLight, relativeDifferences } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'
import {
  body,
  cameraAt,
  draw,
  FAR_VIEW,
  LIMB_VIEW,
  luminance,
  RADIUS,
  size,
  VIEWS
} from '../harness/shell'

gpuTest(
  'looks the same for bodies of any size, on any world scale',
  async t => {
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
  },
  { backends: ['webgpu'] }
)

/** True if the lower edge of a pixel sees the ground of a body about the origin. */
function seesGround(camera: PerspectiveCamera, pixel: number): boolean {
  const [x, y] = [pixel % size.width, Math.floor(pixel / size.width)]
  const point = new Vector3(((x + 0.5) / size.width) * 2 - 1, 1 - ((y + 1) / size.height) * 2, 0.5)
  const ray = point.unproject(camera).sub(camera.position).normalize()
  const along = ray.dot(camera.position)
  return along < 0 && along ** 2 > camera.position.lengthSq() - RADIUS ** 2
}

gpuTest('is the same sky as the background, inside and outside the air', async t => {
  const renderer = await t.createRenderer(size)
  const isAll = t.backend === 'webgpu'
  // Black ground: what is left is the air alone, as a shell without a body has it. WebGL, for which that would be a bake of
  // its own, looks past the ground.
  const parameters = new AtmosphereParameters(isAll ? { groundAlbedo: [0, 0, 0, 0] } : {})
  const atmosphere = new Atmosphere({ parameters, ellipsoid: new Ellipsoid(RADIUS, RADIUS) })
  atmosphere.worldToECEF.identity()
  const scene = new Scene()
  scene.backgroundNode = skyBackground(atmosphere, { showSun: false })
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  const shell = new AtmosphereShell(parameters, RADIUS, { sun: atmosphere })
  const alone = new Scene().add(shell)
  const suns = [new Vector3(1, 0.02, -0.5), new Vector3(1, 0.6, 0.4), new Vector3(1, -0.1, -1)]
  // Where the sun is is decided by shaders that both backends share.
  for (const sun of isAll ? suns : suns.slice(0, 1)) {
    atmosphere.sunDirection = sun
    for (const [distance, pitch, fov] of isAll ? [...VIEWS, FAR_VIEW] : [LIMB_VIEW, VIEWS[2]]) {
      const camera = cameraAt(distance, RADIUS, pitch, fov)
      const expected = await drawForward(renderer, scene, camera, atmosphere)
      const picture = await draw(renderer, alone, camera)
      // Where there is light: a hundredth of the brightest is dusk, which eight steps only sketch.
      const brightest = Math.max(...expected.data.filter((_, i) => i % 4 === 1))
      const errors: number[] = []
      for (let i = 0; i < expected.data.length; i += 4) {
        if (!isAll && seesGround(camera, i / 4)) continue
        const [want, got] = [expected, picture].map(({ data }) =>
          luminance(Array.from(data.slice(i, i + 3)))
        )
        if (want > 0.01 * brightest) errors.push(Math.abs(got / want - 1))
      }
      errors.sort((x, y) => x - y)
      const [middle, most] = [0.5, 0.95].map(part => errors[Math.floor(part * errors.length)])
      t.note(`${distance} radii: median ${middle.toExponential(1)}, p95 ${most.toExponential(1)}`)
      expectTrue(errors.length > 100, `${distance} radii: only ${errors.length} pixels have light`)
      // The shell interpolates light per length between elevations, the sky all of the light.
      const [likely, worst] = distance < 10 ? [0.0025, 0.005] : [0.005, 0.02]
      expectTrue(
        middle < likely && most < worst,
        `${distance} radii, sun ${sun.y}: ${middle}, ${most}`
      )
    }
  }
  shell.dispose()
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
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'follows body, camera and light, as bright as the light',
  async t => {
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
  },
  { backends: ['webgpu'] }
)

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

gpuTest(
  'is not there for a body without air, and frees what it took',
  async t => {
    expectTrue(!new AtmosphereShell(airlessParameters(), 1).visible, 'the Moon has a shell')
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
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'names what is wrong with its arguments',
  () => {
    const parameters = new AtmosphereParameters()
    const right = new AtmosphereShell(parameters, 1)
    const wrong = [null, 'noon', 3, {}, [], new Vector3(NaN, 1, 0), new Vector3()] as never[]
    for (const [make, message] of [
      [
        () => new AtmosphereShell(parameters, 0),
        /AtmosphereShell: bodyRadius must be positive.*got 0/
      ],
      [
        () => new AtmosphereShell(null as never, 1),
        /parameters must be AtmosphereParameters, got null/
      ],
      [
        () => new AtmosphereShell(parameters, 1, { model: 'none' as never }),
        /model must be .*got 'none'/
      ],
      [() => new AtmosphereShell(parameters, 1, { luminanceScale: NaN }), /luminanceScale .*NaN/],
      [
        () => (right.luminanceScale = -1),
        /AtmosphereShell: luminanceScale must be positive.*got -1/
      ],
      ...wrong.flatMap(sun => [
        [
          () => new AtmosphereShell(parameters, 1, { sun }),
          /AtmosphereShell: sun must be an.*, got ./
        ],
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
  },
  { backends: ['webgpu'] }
)
