import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import {
  Box3,
  BoxGeometry,
  Mesh,
  MeshLambertMaterial,
  PerspectiveCamera,
  Plane,
  PlaneGeometry,
  Ray,
  Scene,
  Vector3
} from 'three'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const size = { width: 128, height: 72 }
/** Ends of the near cascade, where the far one begins, and of the far one [m from the camera]. */
const cascadeEnds = [60, 300]
/** A shadow's edge is blurred, and as coarse as the cascade's texels [m]. */
const edges = [0.7, 2.5]

gpuTest("casts shadows in each cascade of three's CSM", async t => {
  const renderer = await t.createRenderer(size)
  renderer.shadowMap.enabled = true
  const atmosphere = new Atmosphere().setSunAngles(40, 110)
  const scene = new Scene()
  const ground = new Mesh(new PlaneGeometry(2000, 2000), new MeshLambertMaterial())
  ground.rotation.x = -Math.PI / 2
  ground.receiveShadow = true
  const boxes = [
    [6, 0, -30],
    [30, -20, -150]
  ].map(([side, x, z]) => {
    const box = new Mesh(new BoxGeometry(side, side, side), new MeshLambertMaterial())
    box.position.set(x, side / 2, z)
    box.castShadow = true
    return box
  })
  const sun = new SunDirectionalLight(atmosphere, 100)
  const probe = new SkyLightProbe(atmosphere)
  scene.add(ground, ...boxes, sun, probe)
  const camera = new PerspectiveCamera(40, size.width / size.height, 1, cascadeEnds[1])
  camera.position.set(0, 25, 10)
  camera.lookAt(0, 0, -60)
  camera.updateMatrixWorld()
  const draw = () => t.render(renderer, scene, camera, size)

  const open = await draw()
  sun.visible = false
  const skyOnly = await draw()
  sun.visible = true
  sun.castShadow = true
  sun.shadow.mapSize.setScalar(512)
  sun.shadow.camera.far = 2000
  const cascades = new CSMShadowNode(sun, {
    cascades: 2,
    maxFar: cascadeEnds[1],
    mode: 'custom',
    customSplitsCallback: (_count: number, _near: number, far: number, target: number[]) => {
      target.push(...cascadeEnds.map(end => end / far))
    }
  })
  Object.assign(sun.shadow, { shadowNode: cascades })
  // Cascades are placed for the next frame.
  await draw()
  const shaded = await draw()

  const solids = boxes.map(box => new Box3().setFromObject(box))
  const grown = (by: number): Box3[] => solids.map(solid => solid.clone().expandByScalar(by))
  const meets = (ray: Ray, targets: Box3[]): boolean =>
    targets.some(target => ray.intersectsBox(target))
  const level = new Plane(new Vector3(0, 1, 0), 0)
  const counts = { shadow: [0, 0], sun: [0, 0] }
  for (let y = 0; y < size.height; y++) {
    for (let x = 0; x < size.width; x++) {
      const through = new Vector3((2 * x + 1) / size.width - 1, 1 - (2 * y + 1) / size.height, 0.5)
      const direction = through.unproject(camera).sub(camera.position).normalize()
      const eye = new Ray(camera.position, direction)
      const point = eye.intersectPlane(level, new Vector3())
      if (point === null || meets(eye, grown(0.5))) continue
      const distance = -point.clone().applyMatrix4(camera.matrixWorldInverse).z
      // Between cascades, and beyond the last, either answer is right.
      const cascade = cascadeEnds.findIndex(end => distance < end)
      if (cascade < 0 || cascadeEnds.some(end => Math.abs(distance - end) < 1)) continue
      const toSun = new Ray(point, atmosphere.sunDirection)
      const label = `pixel (${x}, ${y}), ${distance.toFixed(0)} m away`
      const got = shaded.at(x, y).slice(0, 3)
      if (meets(toSun, grown(-edges[cascade]))) {
        counts.shadow[cascade]++
        expectClose(got, skyOnly.at(x, y).slice(0, 3), { relative: 1e-4 }, `${label}, in shadow`)
        expectTrue(got[0] < 0.5 * open.at(x, y)[0], `${label}: the shadow is no darker`)
      } else if (!meets(toSun, grown(edges[cascade]))) {
        counts.sun[cascade]++
        expectClose(got, open.at(x, y).slice(0, 3), { relative: 1e-4 }, `${label}, in the sun`)
      }
    }
  }
  t.note(`pixels near and far: in shadow ${counts.shadow}, in the sun ${counts.sun}`)
  for (const count of [...counts.shadow, ...counts.sun]) {
    expectTrue(count >= 20, `too few pixels: ${JSON.stringify(counts)}`)
  }
  atmosphere.dispose()
})
