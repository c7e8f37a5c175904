import { CloudLayers } from '@welkin/clouds'
import { Ellipsoid, Geodetic, sunDirectionECEF } from '@welkin/geo'
import { Color, Mesh, MeshBasicMaterial, PerspectiveCamera, Scene, SphereGeometry } from 'three'
import { WebGPURenderer } from 'three/webgpu'

// A globe of radius 1 seen from where the sun stands: its middle is the subsolar point.
const ellipsoid = Ellipsoid.WGS84
const sun = sunDirectionECEF(new Date('2026-06-21T12:00:00Z'))
const camera = new PerspectiveCamera(40, innerWidth / innerHeight, 0.1, 10)
camera.up.set(0, 0, 1)
camera.position.copy(sun).multiplyScalar(4)
camera.lookAt(0, 0, 0)

const subsolar = ellipsoid.ecefToGeodetic(sun.clone().multiplyScalar(ellipsoid.a), new Geodetic())
if (Math.abs(subsolar.latitude - 23.4) > 0.3) {
  throw new Error(`the sun stands over latitude ${subsolar.latitude}`)
}
if (new CloudLayers().length !== 1) throw new Error('no default cloud layer')

const scene = new Scene()
scene.background = new Color(0x000000)
scene.add(new Mesh(new SphereGeometry(1, 64, 32), new MeshBasicMaterial({ color: 0x2255aa })))

const renderer = new WebGPURenderer()
renderer.setSize(innerWidth, innerHeight)
document.body.replaceChildren(renderer.domElement)
void renderer.setAnimationLoop(() => renderer.render(scene, camera))
