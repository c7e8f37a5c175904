import { Atmosphere, SkyLightProbe } from '@welkin/atmosphere'
import { Mesh, PerspectiveCamera, Scene, SphereGeometry } from 'three'
import { vec3 } from 'three/tsl'
import { SkyLightMap } from '../../../stories/src/valley/SkyLightMap'
import { setMapped, VertexLitMaterial } from '../../../stories/src/valley/VertexLitMaterial'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Places of a ball on the land, in its middle and at the map's edge [m]. */
const PLACES = [
  [300, 500],
  [-12_000, 8000]
] as const

gpuTest(
  "the valley's map of the sky's light has that of the probe, whatever the plane",
  async t => {
    const size = { width: 32, height: 32 }
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere()
    atmosphere.place({ longitude: 10, latitude: 46, height: 600 })
    atmosphere.sunDirection.set(0.8, 0.35, 0.3).normalize()
    const probe = new SkyLightProbe(atmosphere)
    const map = new SkyLightMap([probe], () => 0)
    const camera = new PerspectiveCamera(30, 1, 1, 1000)
    setMapped([probe], map)
    const draw = async (place: readonly [number, number], isMapped: boolean) => {
      const [x, z] = place
      const material = new VertexLitMaterial()
      material.colorNode = isMapped ? vec3(0.5) : null
      material.color.setScalar(0.5)
      const light = isMapped ? probe : new SkyLightProbe(atmosphere)
      const ball = new Mesh(new SphereGeometry(10, 48, 32), material)
      ball.position.set(x, 0, z)
      const scene = new Scene().add(light, ball)
      camera.position.set(x + 25, 25, z + 25)
      camera.lookAt(ball.position)
      camera.updateMatrixWorld()
      map.reset()
      map.update(renderer, camera, atmosphere.luminanceScale)
      const picture = await t.render(renderer, scene, camera, size)
      ball.geometry.dispose()
      material.dispose()
      return picture
    }
    for (const place of PLACES) {
      const [probed, mapped] = [await draw(place, false), await draw(place, true)]
      let [most, brightest] = [0, 0]
      for (let y = 0; y < size.height; y++) {
        for (let x = 0; x < size.width; x++) {
          const [a, b] = [probed.at(x, y), mapped.at(x, y)]
          for (const i of [0, 1, 2]) {
            brightest = Math.max(brightest, a[i])
            most = Math.max(most, Math.abs(a[i] - b[i]))
          }
        }
      }
      t.note(
        `${place.join(', ')}: ${((100 * most) / brightest).toFixed(1)} % of ${brightest.toPrecision(3)}`
      )
      expectTrue(brightest > 0.01, 'there is no light')
      expectTrue(most < 0.06 * brightest, `the map is ${most / brightest} off`)
    }
    map.dispose()
    atmosphere.dispose()
  }
)
