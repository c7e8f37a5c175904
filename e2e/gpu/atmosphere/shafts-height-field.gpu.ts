import { heightFieldShadow } from '@welkin/atmosphere'
import { Matrix4, Vector3 } from 'three'
import { inScatter } from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import { expectClose } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { expectSame, parameters, stage, stageSize as size } from '../harness/shaft-stage'

gpuTest('takes the sunlight from air behind the ridge of a height field', async t => {
  const renderer = await t.createRenderer(size)
  const elevation = 12
  const set = stage(renderer, elevation, { quality: 'reference' })
  const { camera, draw, shafts } = set
  const lit = await draw()
  // A ridge 300 m north of the camera, whose shadow passes over it to the south.
  const [edge, ridge, half, height] = [20_000, -300, 20, 700]
  const matrix = new Matrix4().makeBasis(
    new Vector3(edge, 0, 0),
    new Vector3(0, 0, edge),
    new Vector3(0, 1, 0)
  )
  matrix.setPosition(-edge / 2, 0, -edge / 2)
  const field = heightFieldShadow(
    at => at.y.sub(0.5).mul(edge).sub(ridge).abs().lessThan(half).select(height, 0),
    matrix,
    { size: 1024 }
  )
  shafts.add(field)
  const [view, sun] = [8, elevation].map(angle => (angle * Math.PI) / 180)
  camera.lookAt(new Vector3(0, Math.sin(view), Math.cos(view)).add(camera.position))
  camera.fov = 1
  camera.updateProjectionMatrix()
  const dark = await draw()
  shafts.enabled = false
  const all = await draw()
  shafts.enabled = true

  const air = parameters()
  const radius = air.bottomRadius + 2
  const cosines = { cosView: Math.sin(view), cosLight: Math.sin(sun) }
  const ray = { radius, ...cosines, cosViewLight: -Math.cos(view + sun) }
  const top = height - 2 + (ridge + half) * Math.tan(sun)
  const distance = top / (Math.tan(view) + Math.tan(sun)) / Math.cos(view)
  const expected = inScatter(air, null, ray, distance)
  const [x, y] = [size.width / 2, size.height / 2]
  for (let k = 0; k < 3; k++) {
    const lost =
      (all.at(x, y)[k] - dark.at(x, y)[k]) / shafts.source.irradiance.value.getComponent(k)
    t.note(`${(100 * (lost / expected[k] - 1)).toFixed(2)} %`)
    expectClose(lost, expected[k], { relative: 0.02 }, `channel ${k}`)
  }
  // Flat ground casts none.
  shafts.remove(field).add(heightFieldShadow(at => at.x.mul(0), matrix))
  camera.rotation.set(0, 0, 0)
  camera.fov = 60
  camera.updateProjectionMatrix()
  expectSame(await draw(), lit, 'flat ground')
  set.dispose()
})
