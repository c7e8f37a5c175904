import { Mesh, PerspectiveCamera, PlaneGeometry, Scene } from 'three'
import { Fn, float, positionWorld, screenCoordinate, vec3, vec4 } from 'three/tsl'
import { NodeMaterial } from 'three/webgpu'
import { heightMet, lineOfSight } from '../../../packages/terrain/src/surface/tsl/lineOfSight'
import { gpuTest } from '../harness/gpu-test'

const SIZE = { width: 32, height: 16 }

gpuTest(
  'what stands above the ground is met where the line of sight passes over it',
  async t => {
    const renderer = await t.createRenderer(SIZE)
    const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, 0.1, 100)
    camera.position.set(0.3, 1.7, 0.8)
    camera.rotation.set(-0.9, 0.4, 0, 'YXZ')
    camera.updateMatrixWorld()
    const frame = { tangent: vec3(1, 0, 0), bitangent: vec3(0, 0, 1) }
    const sight = lineOfSight(vec3(0, 1, 0), frame, float(0.005))
    const material = new NodeMaterial()
    material.fragmentNode = vec4(sight.slope, sight.share, 1)
    const ground = new Mesh(new PlaneGeometry(60, 60).rotateX(-Math.PI / 2), material)
    const scene = new Scene()
    scene.add(ground)
    const slopes = await t.render(renderer, scene, camera, SIZE)
    material.fragmentNode = vec4(positionWorld, 1)
    material.needsUpdate = true
    const places = await t.render(renderer, scene, camera, SIZE)
    let worst = 0
    let count = 0
    for (let y = 0; y < SIZE.height; y++) {
      for (let x = 0; x < SIZE.width; x++) {
        const [placeX, , placeZ] = places.at(x, y)
        // The line of sight from there to the camera, where it is 1 m above the ground.
        const [stepX, stepZ] = [camera.position.x - placeX, camera.position.z - placeZ].map(
          way => way / camera.position.y
        )
        if (Math.hypot(stepX, stepZ) > 3.8) continue
        const [slopeX, slopeZ, share] = slopes.at(x, y)
        worst = Math.max(worst, Math.hypot(slopeX - stepX, slopeZ - stepZ))
        if (share !== 1) throw new Error(`${share} of depth is left at the feet`)
        count++
      }
    }
    t.note(`${count} pixels, within ${worst.toExponential(1)}`)
    if (count < 300) throw new Error(`only ${count} pixels`)
    if (!(worst < 1e-3)) throw new Error(`lines of sight differ by ${worst}`)
  },
  { backends: ['webgpu'] }
)

/** Ground as a plane along the line of sight: its height where that is at 0, and its slope against it. The last is far too steep for a fixed point. */
const PLANES = [
  [0.5, 0],
  [0.2, 0.5],
  [0.9, -2],
  [1, -6]
] as const

gpuTest(
  'a line of sight meets planes where it crosses them, however steep they are',
  async t => {
    const renderer = await t.createRenderer(SIZE)
    const camera = new PerspectiveCamera()
    const material = new NodeMaterial()
    const column = screenCoordinate.x.floor()
    const parameters = PLANES.map(([base, slope], i) =>
      vec3(base, slope, 0).mul(column.equal(i).select(1, 0))
    )
    const plane = parameters.reduce((sum, each) => sum.add(each) as never)
    const ground = new Mesh(new PlaneGeometry(4, 4), material)
    ground.position.z = -1
    material.fragmentNode = Fn(() => {
      const met = heightMet(height => height.mul(plane.y).add(plane.x).clamp(0, 1))
      return vec4(met, 0, 0, 1)
    })()
    const found = await t.render(renderer, new Scene().add(ground), camera, SIZE)
    PLANES.forEach(([base, slope], i) => {
      const met = found.at(i, 8)[0]
      const truth = base / (1 - slope)
      // Where the plane is cut off at 0, it is a plane no longer between two steps.
      const error = Math.abs(met - truth)
      t.note(`${met.toFixed(4)} for ${truth.toFixed(4)}`)
      if (!(error < 0.03)) throw new Error(`meets at ${met}, not at ${truth}`)
    })
  },
  { backends: ['webgpu'] }
)
