import { Atmosphere } from '@welkin/atmosphere'
import {
  GroundMask,
  GroundMaps,
  Terrain,
  type GroundKind,
  type TerrainOptions
} from '@welkin/terrain'
import {
  Color,
  DataTexture,
  Matrix4,
  Mesh,
  PerspectiveCamera,
  PlaneGeometry,
  RepeatWrapping,
  Scene,
  SRGBColorSpace,
  Vector3
} from 'three'
import { texture, uv, vec4 } from 'three/tsl'
import { NodeMaterial, type Node, type WebGPURenderer } from 'three/webgpu'
import { geographicPlace } from '../../../packages/terrain/src/data/geographic'
import { GROUND_KINDS, ofKinds } from '../../../packages/terrain/src/surface/maps/groundKinds'
import { paintedLayers, sharesOf } from '../../../packages/terrain/src/surface/tsl/groundShares'
import { placeOnMask } from '../../../packages/terrain/src/surface/tsl/maskShares'
import { figureOf } from '../../../packages/terrain/src/tiles/cpu/figure'
import type { GpuContext } from '../harness/context'
import { gpuTest } from '../harness/gpu-test'
import { levelGround } from '../harness/ground'

type Bytes = readonly [number, number, number, number]

/** Picture of so many texels in a row, in rows from the south. */
function picture(width: number, texels: readonly Bytes[]): DataTexture {
  const made = new DataTexture(Uint8Array.from(texels.flat()), width, texels.length / width)
  made.wrapS = made.wrapT = RepeatWrapping
  made.needsUpdate = true
  return made
}

/** Picture of one colour, sRGB. */
function albedo(...[red, green, blue]: [number, number, number]): DataTexture {
  const made = picture(1, [[red, green, blue, 255]])
  made.colorSpace = SRGBColorSpace
  return made
}

/** Linear light of a byte of sRGB. */
const linear = (byte: number): number => ((byte / 255 + 0.055) / 1.055) ** 2.4

const SIZE = { width: 32, height: 32 }

/** Terrain seen from straight above, 1 km over a place, and how a node of its material is drawn. */
async function fromAbove(t: GpuContext, options: TerrainOptions) {
  const renderer: WebGPURenderer = await t.createPlanetRenderer(SIZE)
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const terrain = new Terrain(atmosphere, levelGround, {
    resolution: 8,
    seaLevel: -Infinity,
    pageMemory: 5,
    ...options
  })
  const { colorNode, roughnessNode, aoNode, normalNode } = terrain.material
  const scene = new Scene()
  scene.background = new Color(0, 0, 0)
  scene.add(terrain)
  const camera = new PerspectiveCamera(53.13, 1, 10, 1e9)
  const place = { longitude: 10, latitude: 45 }
  atmosphere.ellipsoid.geodeticToECEF({ ...place, height: 1000 }, camera.position)
  const frame = atmosphere.ellipsoid.localYUpFrame(camera.position, new Matrix4())
  camera.quaternion.setFromRotationMatrix(frame)
  camera.rotateX(-Math.PI / 2)
  camera.updateMatrixWorld()
  const draw = async (node: Node | null): Promise<(x: number, y: number) => number[]> => {
    terrain.material.fragmentNode = node as never
    terrain.material.needsUpdate = true
    terrain.update(renderer, camera, Infinity)
    const drawn = await t.render(renderer, scene, camera, SIZE)
    return (x, y) => Array.from(drawn.at(Math.floor(32 * x), Math.floor(32 * y)))
  }
  const rest = vec4(roughnessNode as never, aoNode as never, normalUp(normalNode as never), 1)
  return { renderer, terrain, camera, draw, color: colorNode, rest }
}

/** Cosine between a normal and the view from above. */
const normalUp = (normalView: Node<'vec3'>): Node<'float'> => normalView.z

function expectNear(found: readonly number[], expected: readonly number[], what: string): void {
  for (const [n, value] of expected.entries()) {
    if (!(Math.abs(found[n] - value) < 5e-3)) {
      throw new Error(`${what}: ${found.join(', ')} in place of ${expected.join(', ')}`)
    }
  }
}

gpuTest(
  'maps of materials are drawn where a mask has painted them, once they are there',
  async t => {
    const names: GroundKind[] = ['rock', 'sand', 'snow']
    const colors = [albedo(200, 40, 60), albedo(60, 200, 90), albedo(80, 70, 210)]
    // A normal that leans by 30°, roughness 0.4, light of the sky 0.7.
    const normal = picture(1, [[191, 128, 238, 255]])
    const roughness = picture(1, [[0, 102, 0, 255]])
    const ao = picture(1, [[178, 0, 0, 255]])
    const late = albedo(10, 20, 30)
    late.version = 0 // as of a texture whose picture is on its way
    const maps = new GroundMaps(
      {
        rock: { albedo: colors[0], normal, roughness, ao },
        sand: { albedo: colors[1] },
        snow: { albedo: colors[2] },
        grass: { albedo: late },
        forest: { albedo: late }
      },
      { size: 16 }
    )
    // From the south: rock and sand, then snow, and what nature has.
    const painted = picture(2, [
      [255, 0, 0, 255],
      [0, 255, 0, 255],
      [0, 0, 255, 255],
      [0, 0, 0, 255]
    ])
    // As far as the view: 1 km to the south and north, and east and west.
    const half = { north: 500 / 111_132, east: 500 / 78_847 }
    const mask = new GroundMask(painted, {
      materials: names,
      west: 10 - half.east,
      east: 10 + half.east,
      south: 45 - half.north,
      north: 45 + half.north
    })
    const { terrain, draw, color, rest } = await fromAbove(t, { maps, mask })
    const seen = await draw(color)
    const expected = [
      [0.25, 0.75, [200, 40, 60]],
      [0.75, 0.75, [60, 200, 90]],
      [0.25, 0.25, [80, 70, 210]]
    ] as const
    for (const [i, [x, y, bytes]] of expected.entries()) {
      expectNear(seen(x, y), bytes.map(linear), names[i])
    }
    const made = seen(0.75, 0.25)
    if (made.slice(0, 3).every((value, n) => Math.abs(value - linear([10, 20, 30][n])) < 5e-3)) {
      throw new Error('a map that is not there is drawn')
    }
    const others = await draw(rest)
    expectNear(others(0.25, 0.75), [0.4, 0.7, Math.cos(Math.PI / 6)], 'roughness, light and normal')
    expectNear(others(0.75, 0.75), [0.9, 1, 1], 'those of a material that has none')
    late.needsUpdate = true
    const after = (await draw(color))(0.75, 0.25)
    t.note(`made up ${made.map(value => value.toFixed(3)).join(' ')}, then ${after.join(' ')}`)
    expectNear(after, [10, 20, 30].map(linear), 'a map that has arrived')
    terrain.dispose()
    maps.dispose()
  }
)

gpuTest('a map lies in its array as it is, not turned over', async t => {
  const corners: Bytes[] = [
    [250, 0, 0, 255],
    [0, 250, 0, 255],
    [0, 0, 250, 255],
    [250, 250, 0, 255]
  ]
  const other = picture(1, [[9, 9, 9, 255]])
  const maps = new GroundMaps(
    {
      rock: { albedo: other },
      grass: { albedo: picture(2, corners), height: picture(2, corners) }
    },
    { size: 16 }
  )
  const renderer = await t.createRenderer({ width: 8, height: 8 })
  maps.update(renderer)
  const layer = (n: number) =>
    (texture(maps.texture, uv()) as unknown as { depth(n: number): Node<'vec4'> }).depth(n)
  const material = new NodeMaterial()
  const scene = new Scene()
  scene.add(new Mesh(new PlaneGeometry(2, 2), material))
  const camera = new PerspectiveCamera(90, 1, 0.1, 10)
  camera.position.z = 1
  for (const [n, expected] of [
    [2, corners.map(bytes => bytes.slice(0, 3).map(byte => byte / 255))],
    [3, corners.map(([red]) => [0.5, 0.5, 0.9, red / 255])]
  ] as const) {
    material.fragmentNode = layer(n)
    material.needsUpdate = true
    const seen = await t.render(renderer, scene, camera, { width: 8, height: 8 })
    for (const [i, texel] of expected.entries()) {
      const [x, y] = [i % 2 === 0 ? 1 : 6, i < 2 ? 6 : 1]
      expectNear(Array.from(seen.at(x, y)), texel, `layer ${n}, corner ${i}`)
    }
  }
  maps.dispose()
})

gpuTest(
  'a shader finds a place on a mask that the CPU does, to a centimetre',
  async t => {
    const atmosphere = new Atmosphere()
    const { ellipsoid } = atmosphere
    const area = { west: 7.9, east: 8.3, south: 46.2, north: 46.5 }
    const mask = new GroundMask(picture(1, [[0, 0, 0, 0]]), { materials: ['rock'], ...area })
    const viewer = ellipsoid.geodeticToECEF({ longitude: 8.01, latitude: 46.33 })
    const reference = viewer.divideScalar(256).round().multiplyScalar(256)
    mask.update(figureOf(atmosphere), reference)
    const point = new Vector3()
    const inputs = Array.from({ length: 400 }, (_, i) => {
      const [x, y] = [(i % 20) / 19, Math.floor(i / 20) / 19]
      // A third of them within some metres of the viewer.
      const reach = i % 3 === 0 ? 1e-4 : 0.2
      const place = { longitude: 8.01 + (x - 0.5) * reach, latitude: 46.33 + (y - 0.5) * reach }
      return ellipsoid.geodeticToECEF(place, point).sub(reference).toArray().map(Math.fround)
    })
    const results = await t.evaluate(inputs, input =>
      vec4(placeOnMask(mask, input.xyz, false), 0, 1)
    )
    const angles = { longitude: 0, latitude: 0 }
    const degrees = 180 / Math.PI
    let worst = 0
    for (const [i, [x, y, z]] of inputs.entries()) {
      point.set(x, y, z).add(reference)
      geographicPlace(point, ellipsoid.radii, angles)
      const expected = [
        (angles.longitude * degrees - area.west) / (area.east - area.west),
        (angles.latitude * degrees - area.south) / (area.north - area.south)
      ]
      for (const n of [0, 1]) {
        // The mask is 33 km from edge to edge.
        const off = Math.abs(results[4 * i + n] - expected[n]) * 33e3
        const away = Math.hypot(x, y, z)
        worst = Math.max(worst, off / Math.max(away / 1e4, 1))
      }
    }
    t.note(`within ${(100 * worst).toFixed(2)} cm for each 10 km`)
    if (!(worst < 0.01)) throw new Error(`places differ by ${worst} m`)
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'what a mask leaves is shared out as before',
  async t => {
    const names = [...GROUND_KINDS, 'desert'] as const
    // Even over the hypercube.
    const steps = [0.8566748838545029, 0.733891856627126, 0.6287067210378087, 0.5385972572236101]
    const inputs = Array.from({ length: 200 }, (_, i) => steps.map(step => (i * step) % 1))
    const nodes = (input: Node<'vec4'>) => {
      const { x, y, z, w } = input
      const layers = { snow: x, bare: y, inland: z, bareness: w, dryness: y, woods: x }
      // Some places are painted wholly, some not at all.
      const paint = z.sub(0.3).mul(2).clamp(0, 1).toConst()
      const painted = ofKinds(kind =>
        kind === 'rock' ? paint.mul(0.4) : kind === 'grass' ? paint.mul(0.6) : paint.mul(0)
      )
      return { before: sharesOf(layers), after: sharesOf(paintedLayers(layers, painted)), paint }
    }
    let worst = 0
    for (const name of names) {
      const results = await t.evaluate(inputs, input => {
        const { before, after, paint } = nodes(input)
        return vec4(before[name], after[name], paint, 1)
      })
      const painted = { rock: 0.4, grass: 0.6 }[name as 'rock'] ?? 0
      for (let i = 0; i < inputs.length; i++) {
        const [before, after, paint] = results.subarray(4 * i, 4 * i + 3)
        worst = Math.max(worst, Math.abs(before * (1 - paint) + painted * paint - after))
      }
    }
    t.note(`shares within ${worst.toExponential(1)}`)
    if (!(worst < 1e-4)) throw new Error(`shares differ by ${worst}`)
  },
  { backends: ['webgpu'] }
)
