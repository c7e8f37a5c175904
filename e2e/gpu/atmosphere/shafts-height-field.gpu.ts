import { heightFieldShadow, terrainShadow } from '@welkin/atmosphere'
import { DataTexture, FloatType, Matrix4, RedFormat, Vector3 } from 'three'
import type { Node } from 'three/webgpu'
import { inScatter } from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import type { Vec2 } from '../../../packages/atmosphere/src/tsl-types'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { addBox, expectSame, parameters, stage, stageSize as size } from '../harness/shaft-stage'

/** Edge of the field, distance of the ridge to the south of the middle, half its breadth and its height [m]. */
const [edge, ridge, half, height] = [20_000, -300, 20, 700]

/** The field, from west to east and from north to south. */
const fieldMatrix = () =>
  new Matrix4()
    .makeBasis(new Vector3(edge, 0, 0), new Vector3(0, 0, edge), new Vector3(0, 1, 0))
    .setPosition(-edge / 2, 0, -edge / 2)

/** Texels along its edges. */
const texels = 1024

/** Heights of the ridge as a texture, whose rows go from north to south. */
function ridgeTexture(): DataTexture {
  const data = Float32Array.from({ length: texels ** 2 }, (_, i) => {
    const south = ((Math.floor(i / texels) + 0.5) / texels - 0.5) * edge
    return Math.abs(south - ridge) < half ? height : 0
  })
  const texture = new DataTexture(data, texels, texels, RedFormat, FloatType)
  texture.needsUpdate = true
  return texture
}

gpuTest('shades ground behind the ridge of a texture, and no other', async t => {
  const renderer = await t.createRenderer(size)
  const elevation = 12
  const set = stage(renderer, elevation)
  const { camera, draw, scene, light, shafts } = set
  shafts.enabled = false
  addBox(scene, [0, -5, 0], [edge, 10, edge])
  camera.position.y = 8000
  camera.rotation.set(-Math.PI / 2, 0, 0)
  camera.updateMatrixWorld()
  const { shadow } = light as unknown as { shadow: { shadowNode: Node } }
  const map = ridgeTexture()
  const hills = heightFieldShadow(map, fieldMatrix(), { size: texels })
  const node = terrainShadow(hills, light, shadow.shadowNode)
  shadow.shadowNode = node
  const shaded = await draw()
  hills.matrix.setPosition(-edge / 2, -1e4, -edge / 2)
  hills.version++
  const lit = await draw()
  const row = (south: number): number => {
    const { y } = new Vector3(0, 0, south).project(camera)
    return Math.floor(((1 - y) / 2) * size.height)
  }
  const reach = ridge + half + height / Math.tan((elevation * Math.PI) / 180)
  const part = (south: number): number =>
    shaded.at(size.width / 2, row(south))[1] / lit.at(size.width / 2, row(south))[1]
  for (const south of [300, 0.5 * reach, reach - 500]) {
    t.note(`${south.toFixed(0)} m: ${part(south).toFixed(3)}`)
    expectTrue(part(south) < 0.8, `dark ${south} m to the south`)
  }
  for (const south of [-3000, -1000, reach + 500]) {
    expectClose(part(south), 1, { absolute: 1e-6 }, `lit ${south} m to the south`)
  }
  node.dispose()
  map.dispose()
  set.dispose()
})

gpuTest(
  'takes the sunlight from air behind the ridge of a height field',
  async t => {
    const renderer = await t.createRenderer(size)
    const elevation = 12
    const set = stage(renderer, elevation, { quality: 'reference' })
    const { camera, draw, shafts } = set
    const lit = await draw()
    // A ridge 300 m north of the camera, whose shadow passes over it to the south.
    const matrix = fieldMatrix()
    const heightAt = (at: Vec2) =>
      at.y.sub(0.5).mul(edge).sub(ridge).abs().lessThan(half).select(height, 0)
    const field = heightFieldShadow(heightAt, matrix, { size: texels })
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
    const map = ridgeTexture()
    const same = heightFieldShadow(map, matrix, { size: texels })
    shafts.enabled = true
    shafts.remove(field).add(same)
    expectSame(await draw(), dark, 'a texture')
    map.dispose()
    // Flat ground casts none.
    shafts.remove(same).add(heightFieldShadow(at => at.x.mul(0), matrix))
    camera.rotation.set(0, 0, 0)
    camera.fov = 60
    camera.updateProjectionMatrix()
    expectSame(await draw(), lit, 'flat ground')
    set.dispose()
  },
  { backends: ['webgpu'] }
)
