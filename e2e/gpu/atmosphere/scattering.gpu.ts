import {
  aerialPerspectiveFog,
  Atmosphere,
  AtmosphereNode,
  inScatter,
  linearSRGB,
  pointAlong,
  scatteredRadiance,
  scattering,
  solveDiffuseLight,
  spectralToLinearSRGB,
  type Spectrum
} from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import { Mesh, PerspectiveCamera, PlaneGeometry, Scene } from 'three'
import { Fn, positionView, vec4 } from 'three/tsl'
import { MeshBasicNodeMaterial, type Node } from 'three/webgpu'
import { expectClose } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Light scattered between the camera and a fragment, as an app of its own would march it. */
class MarchedHazeNode extends AtmosphereNode {
  static get type(): string {
    return 'MarchedHazeNode'
  }

  override setup(): Node {
    return Fn(() => {
      const { air, viewpoint, up, lightDirection } = this.view
      const offset = this.view.toMapped(positionView).toConst()
      const distance = offset.length().toConst()
      const direction = offset.div(distance).toConst()
      const ray = {
        altitude: viewpoint.altitude,
        cosView: direction.dot(up),
        cosLight: viewpoint.cosLight,
        cosViewLight: direction.dot(lightDirection)
      }
      const rise = pointAlong(air, ray, distance).altitude.sub(ray.altitude)
      const light = scattering(air, ray, distance, rise, 12)
      const radiance = scatteredRadiance(air.uniforms, light, ray.cosViewLight)
      return vec4(linearSRGB(air.uniforms, radiance), 1)
    })()
  }
}

gpuTest(
  'scatters in a shader of the app as float64 does without a GPU',
  async t => {
    const size = { width: 16, height: 16 }
    const renderer = await t.createRenderer(size)
    const ellipsoid = new Ellipsoid(6_378_137)
    const atmosphere = new Atmosphere({ ellipsoid }).setSunAngles(20, 60)
    const { parameters } = atmosphere
    const scene = new Scene()
    const material = new MeshBasicNodeMaterial()
    material.colorNode = new MarchedHazeNode(atmosphere)
    const wall = new Mesh(new PlaneGeometry(1e5, 1e5), material)
    wall.position.z = -40_000
    scene.add(wall)
    const camera = new PerspectiveCamera(30, 1, 10, 1e6)
    camera.position.y = 3000
    const picture = await t.render(renderer, scene, camera, size)
    const data = solveDiffuseLight(parameters, { orders: 3 })
    const sun = atmosphere.sunDirection
    for (const [x, y] of [
      [8, 8],
      [2, 5],
      [14, 3]
    ] as const) {
      const edge = Math.tan(Math.PI / 12)
      const [dx, dy] = [((2 * x + 1) / 16 - 1) * edge, (1 - (2 * y + 1) / 16) * edge]
      const length = Math.hypot(dx, dy, 1)
      const ray = {
        radius: parameters.bottomRadius + 3000,
        cosView: dy / length,
        cosLight: sun.y,
        cosViewLight: (dx * sun.x + dy * sun.y - sun.z) / length
      }
      const perIrradiance = inScatter(parameters, data, ray, 40_000 * length)
      const radiance = perIrradiance.map((value, i) => value * parameters.solarIrradiance[i])
      const expected = spectralToLinearSRGB(parameters, radiance as unknown as Spectrum)
      expectClose(
        picture.at(x, y).slice(0, 3),
        expected.map(value => value * atmosphere.luminanceScale),
        { relative: 0.01 },
        `${x}, ${y}`
      )
    }
    material.dispose()
    atmosphere.dispose()
  },
  // The same numbers on both.
  { backends: ['webgpu'] }
)

gpuTest(
  'has the same haze before things near by, above the horizon and below it',
  async t => {
    // Eyes of a walker: rays just below the horizon end after kilometres, a little lower after tens of metres.
    const size = { width: 2, height: 48 }
    const renderer = await t.createRenderer(size)
    const camera = new PerspectiveCamera(1.6, size.width / size.height, 1, 1e5)
    camera.position.y = 2
    for (const distance of [30, 100, 400]) {
      const atmosphere = new Atmosphere({ ellipsoid: new Ellipsoid(6_378_137) }).setSunAngles(
        20,
        60
      )
      const wall = new PlaneGeometry(1e4, 1e4)
      const marched = new MeshBasicNodeMaterial()
      marched.colorNode = new MarchedHazeNode(atmosphere)
      const pictures = []
      for (const material of [new MeshBasicNodeMaterial({ color: 'black' }), marched]) {
        const scene = new Scene()
        if (material !== marched) scene.fogNode = aerialPerspectiveFog(atmosphere)
        const mesh = new Mesh(wall, material)
        mesh.position.z = -distance
        scene.add(mesh)
        pictures.push(await t.render(renderer, scene, camera, size))
        material.dispose()
      }
      const [haze, expected] = pictures
      const edge = Math.tan((0.8 * Math.PI) / 180)
      for (let y = 0; y < size.height; y++) {
        const below = ((2 * y + 1) / size.height - 1) * edge * distance
        if (below > 1.9) break
        expectClose(
          haze.at(0, y).slice(0, 3),
          expected.at(0, y).slice(0, 3),
          { relative: 0.02 },
          `at ${distance} m, row ${y}`
        )
      }
      wall.dispose()
      atmosphere.dispose()
    }
  },
  { backends: ['webgpu'] }
)
