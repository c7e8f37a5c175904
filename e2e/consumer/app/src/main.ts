import { Color, Mesh, MeshBasicMaterial, PerspectiveCamera, Scene, SphereGeometry } from 'three'
import { WebGPURenderer } from 'three/webgpu'
import { CloudLayers } from '@welkin/clouds'
import { Ellipsoid, Geodetic, sunDirectionECEF } from '@welkin/geo'

declare global {
  interface Window {
    /** Draws one frame and answers with it as a PNG data URL. */
    draw: () => string
  }
}

const renderer = new WebGPURenderer({
  forceWebGL: new URLSearchParams(location.search).has('webgl')
})
renderer.setSize(320, 180)
document.body.append(renderer.domElement)
await renderer.init()

// A globe seen from where the sun stands, in units of Earth radii: its middle is the subsolar point.
const ellipsoid = Ellipsoid.WGS84
const date = new Date('2026-06-21T12:00:00Z')
const sun = sunDirectionECEF(date)
const camera = new PerspectiveCamera(40, 320 / 180, 0.1, 10)
camera.up.set(0, 0, 1)
camera.position.copy(sun).multiplyScalar(4)
camera.lookAt(0, 0, 0)

const scene = new Scene()
scene.background = new Color(0x000000)
const globe = new Mesh(new SphereGeometry(1, 64, 32), new MeshBasicMaterial({ color: 0x2255aa }))
const subsolar = ellipsoid.ecefToGeodetic(sun.clone().multiplyScalar(ellipsoid.a), new Geodetic())
if (Math.abs(subsolar.latitude - 23.4) > 0.3) {
  throw new Error(`the sun stands over latitude ${subsolar.latitude}`)
}
if (new CloudLayers().length !== 1) throw new Error('no default cloud layer')
scene.add(globe)

window.draw = () => {
  renderer.render(scene, camera)
  return renderer.domElement.toDataURL('image/png')
}
