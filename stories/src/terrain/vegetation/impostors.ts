import {
  Color,
  DoubleSide,
  HalfFloatType,
  LinearFilter,
  LinearMipmapLinearFilter,
  Mesh,
  OrthographicCamera,
  PlaneGeometry,
  RenderTarget,
  Scene,
  type BufferGeometry
} from 'three'
import {
  attribute,
  cos,
  floor,
  fract,
  mix,
  positionGeometry,
  sin,
  smoothstep,
  texture,
  transformNormalToView,
  uv,
  varying,
  vec2,
  vec3
} from 'three/tsl'
import { MeshBasicNodeMaterial, type Node, type WebGPURenderer } from 'three/webgpu'
import { setFoliage, setTwigs } from '../../valley/leaves'
import {
  plantGeometry,
  PlantMaterial,
  plantNodes,
  type Float,
  type Planted,
  type PlantUniforms,
  type Vec3
} from './plantShader'

/** Sides that a tree is drawn from, and texels of a picture of it. */
const SIDES = 8
const WIDTH = 128
const HEIGHT = 208

export interface Frame {
  readonly width: number
  readonly height: number
}

/** Width and height that a picture shows, the tree's foot in the middle of its lower edge [m]. */
const FRAME: Frame = { width: 6.6, height: 11 }

/** Coverage from which a picture is solid near and far: its means are thinner than leaves are. */
const SOLID = [0.45, 0.22] as const
const FAR = 600

/** Pictures of a tree from all sides: colour with coverage, and normals. */
export interface TreePictures {
  readonly color: RenderTarget
  readonly normal: RenderTarget
  /** Width and height that each shows [m]. */
  readonly frame: Frame
}

/**
 * Draws a tree from all sides.
 *
 * @param isBare - Leaves have fallen.
 */
export function drawPictures(
  renderer: WebGPURenderer,
  geometry: BufferGeometry,
  frame = FRAME,
  isBare = false
): TreePictures {
  const scene = new Scene()
  const { width, height } = frame
  const camera = new OrthographicCamera(-width / 2, width / 2, height, 0, 0, 40)
  const target = (): RenderTarget =>
    new RenderTarget(SIDES * WIDTH, HEIGHT, {
      type: HalfFloatType,
      generateMipmaps: true,
      minFilter: LinearMipmapLinearFilter,
      magFilter: LinearFilter
    })
  const pictures = { color: target(), normal: target(), frame }
  const setLeaves = isBare ? setTwigs : setFoliage
  const colors = new MeshBasicNodeMaterial({ vertexColors: true, side: DoubleSide })
  setLeaves(colors)
  const normals = new MeshBasicNodeMaterial({ side: DoubleSide })
  setLeaves(normals)
  normals.colorNode = attribute<'vec3'>('normal', 'vec3').normalize().mul(0.5).add(0.5)
  const mesh = new Mesh(geometry)
  mesh.frustumCulled = false
  scene.add(mesh)
  const before = renderer.getRenderTarget()
  const { autoClear } = renderer
  const alpha = renderer.getClearAlpha()
  const clear = renderer.getClearColor(new Color())
  renderer.setClearColor(0, 0)
  renderer.autoClear = false
  for (const [into, material] of [
    [pictures.color, colors],
    [pictures.normal, normals]
  ] as const) {
    mesh.material = material
    // All sides at once: WebGL clears within the scissor alone.
    renderer.setRenderTarget(into)
    renderer.clear()
    for (let side = 0; side < SIDES; side++) {
      const angle = (2 * Math.PI * side) / SIDES
      camera.position.set(20 * Math.sin(angle), 0, 20 * Math.cos(angle))
      camera.lookAt(0, 0, 0)
      camera.updateMatrixWorld()
      into.viewport.set(side * WIDTH, 0, WIDTH, HEIGHT)
      into.scissor.set(side * WIDTH, 0, WIDTH, HEIGHT)
      into.scissorTest = true
      renderer.setRenderTarget(into)
      renderer.render(scene, camera)
    }
  }
  renderer.autoClear = autoClear
  renderer.setClearColor(clear, alpha)
  renderer.setRenderTarget(before)
  colors.dispose()
  normals.dispose()
  return pictures
}

/**
 * Trees as pictures that turn to the viewer, lit by the normals in them.
 *
 * @param from - Distance from which trees are drawn so [m], and distances between which they go.
 */
export function createImpostors(
  pictures: TreePictures,
  plants: Planted,
  uniforms: PlantUniforms,
  from: number,
  goes: readonly [number, number]
): Mesh {
  const material = new PlantMaterial({ side: DoubleSide })
  const { foot, size, random, tint, distance } = plantNodes(uniforms)
  const yaw = attribute<'vec4'>('plantLook', 'vec4').x as unknown as Float
  const shown = distance
    .greaterThan(from)
    .select(smoothstep(goes[0], goes[1], distance.mul(random.mul(0.2).add(0.9))).oneMinus(), 0)
  const scaled = size.mul(shown)
  const { frame } = pictures
  const towards = (to: Vec3): Picture => pictureTowards(to, yaw, { foot, size: scaled, frame })
  const seen = towards(uniforms.viewer.sub(foot).toConst())
  const lit = towards(uniforms.sun)
  const at = seen.at
  material.positionNode = seen.position
  // Shadow maps see the side that the sun does.
  material.castShadowPositionNode = lit.position
  material.maskShadowNode = texture(pictures.color.texture, lit.at).a.greaterThan(SOLID[0])
  const color = texture(pictures.color.texture, at).toConst() as unknown as Node<'vec4'>
  const normal = texture(pictures.normal.texture, at).toConst() as unknown as Node<'vec4'>
  const solid = mix(SOLID[0], SOLID[1], smoothstep(80, FAR, varying(distance)))
  material.maskNode = color.a.greaterThan(solid)
  material.colorNode = color.rgb.div(color.a.max(0.05)).mul(varying(tint))
  const turn = varying(yaw)
  const n = normal.xyz.div(normal.a.max(0.05)).mul(2).sub(1)
  const turned = vec3(
    n.x.mul(cos(turn)).add(n.z.mul(sin(turn))),
    n.y,
    n.z.mul(cos(turn)).sub(n.x.mul(sin(turn)))
  )
  material.normalNode = transformNormalToView(turned.normalize())
  const mesh = new Mesh(
    plantGeometry(new PlaneGeometry(1, 1).translate(0, 0.5, 0), plants),
    material
  )
  mesh.frustumCulled = false
  mesh.castShadow = mesh.receiveShadow = true
  return mesh
}

/** A tree's picture: place of a vertex, and place in the texture of the side that it shows. */
interface Picture {
  readonly position: Vec3
  readonly at: Node<'vec2'>
}

/**
 * Picture that turns to what sees it.
 *
 * @param to - Way from its foot to that, of any length.
 * @param yaw - Turn of the tree about the vertical.
 */
function pictureTowards(
  to: Vec3,
  yaw: Float,
  { foot, size, frame }: { foot: Vec3; size: Float; frame: Frame }
): Picture {
  const level = to.xz.length().max(1e-3).toConst() as unknown as Float
  // Azimuth about the tree, in its own frame.
  const azimuth = to.x.atan(to.z).sub(yaw).toConst() as unknown as Float
  const right = vec3(to.z.div(level), 0, to.x.div(level).negate())
  const { x, y } = positionGeometry
  const across = right.mul(x.mul(frame.width))
  const position = foot.add(across.add(vec3(0, y.mul(frame.height), 0)).mul(size))
  const sector = floor(
    fract(azimuth.div(2 * Math.PI))
      .mul(SIDES)
      .add(0.5)
  )
  const side = varying(sector.mod(SIDES).div(SIDES)).setInterpolation('flat')
  const at = vec2(uv().x.div(SIDES).add(side), uv().y.oneMinus()).toConst()
  return { position, at }
}
