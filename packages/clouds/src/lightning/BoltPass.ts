import {
  aerialPerspectiveTo,
  FragmentPass,
  tableTarget,
  type AtmosphereView
} from '@welkin/atmosphere'
import {
  Box2,
  BufferGeometry,
  CustomBlending,
  DoubleSide,
  Float32BufferAttribute,
  MaxEquation,
  Matrix3,
  Mesh,
  OneFactor,
  RGFormat,
  Scene,
  Vector2,
  Vector3
} from 'three'
import { Fn, Discard, If, attribute, mix, screenUV, texture, varying, vec2, vec4 } from 'three/tsl'
import { NodeMaterial, RendererUtils, type Renderer } from 'three/webgpu'
import { select } from '../select'
import type { CloudsNode } from '../march/CloudsNode'
import { isDrawnBefore } from '../march/tsl/viewRay'
import { CORNERS } from '../temporal/tsl/cells'
import type {
  Bool,
  Float,
  LevelTexture,
  Mat3,
  Mat4,
  Variable,
  Vec2,
  Vec3,
  Vec4
} from '../tsl-types'
import { matrix3, matrix4, number, vector3, vector4 } from '../uniforms'
import { STORED_POWER, type ChannelPiece, type PlacedChannel } from './channel'

/** Deviation of a channel's width in the picture [pixels]. Smaller: steps at its edges. */
const WIDTH = 0.8
/** Half width of what is drawn of it, and by how much it is drawn beyond the ends of a piece, where the next begins [pixels]. */
const HALF_WIDTH = 3 * WIDTH
const BEYOND = 1
/** Greatest luminance over the channel's colour that half floats keep. */
const GREATEST = 3e4
/** Part of the distance before a channel over which clouds begin to hide it. Greater: white lines within clouds (*Storm at night*). */
const HIDING = 0.005
/** Share of its light that clouds must let through: less is none, or it shines through opaque ones. */
const LEAST_PASSING = 0.01

const _toView = new Matrix3()
const _point = new Vector3()
const _pixel = new Vector2()
const _box = new Box2()
const _picture = new Box2(new Vector2())

/** Quads of all pieces: which corner a vertex is, for its position, and where its piece begins and ends. */
function quadsOf({ pieces }: PlacedChannel): BufferGeometry {
  const from: number[] = []
  const to: number[] = []
  const corner: number[] = []
  const index: number[] = []
  for (const [i, piece] of pieces.entries()) {
    for (const [end, side] of CORNERS) {
      from.push(...piece.from, piece.brightness)
      to.push(...piece.to, piece.isBranch ? 1 : 0)
      corner.push(end, 2 * side - 1, 0)
    }
    index.push(...[0, 1, 2, 2, 1, 3].map(k => 4 * i + k))
  }
  const geometry = new BufferGeometry()
  geometry.setAttribute('position', new Float32BufferAttribute(corner, 3))
  geometry.setAttribute('pieceFrom', new Float32BufferAttribute(from, 4))
  geometry.setAttribute('pieceTo', new Float32BufferAttribute(to, 4))
  geometry.setIndex(index)
  return geometry
}

/** A channel of lightning as thin bright lines, hidden by what was drawn and dimmed by clouds and air before it. */
export class BoltPass {
  readonly #clouds: CloudsNode
  /** Red and blue alone; dark but for the few pixels of a channel, of which the next frame clears the box: to clear all of it costs more than the channel. */
  readonly #target = tableTarget('Welkin.LightningChannel', 1, 1)
  readonly #texture: LevelTexture<Vec2>
  readonly #scene = new Scene()
  readonly #material: NodeMaterial
  readonly #mesh: Mesh
  readonly #eraser = new FragmentPass('Welkin.LightningErased', vec4(0))
  /** The channel's frame to view space [world units/m], and its place there. */
  readonly #toView = matrix3()
  readonly #placeView = vector3()
  readonly #projection = matrix4()
  /** Box around the channel in the picture: its least and greatest place, y down. The target's scissor has it in pixels. */
  readonly #box = vector4()
  /** Luminous intensity of a metre of the stem, and that of branches, for `STORED_POWER` [cd/m]. */
  readonly #stemLight = number()
  readonly #branchLight = number()

  constructor(clouds: CloudsNode) {
    this.#clouds = clouds
    this.#target.texture.format = RGFormat
    this.#texture = texture(this.#target.texture) as unknown as LevelTexture<Vec2>
    this.#material = this.#makeMaterial()
    this.#mesh = new Mesh(new BufferGeometry(), this.#material)
    this.#mesh.frustumCulled = false
    this.#scene.add(this.#mesh)
  }

  /** Takes a channel's geometry. */
  set channel(channel: PlacedChannel) {
    this.#mesh.geometry.dispose()
    this.#mesh.geometry = quadsOf(channel)
  }

  #makeMaterial(): NodeMaterial {
    const { passes, field } = this.#clouds
    const { viewRays, seen } = passes
    const { frame } = viewRays
    const from = attribute('pieceFrom', 'vec4') as unknown as Vec4
    const to = attribute('pieceTo', 'vec4') as unknown as Vec4
    const corner = attribute('position', 'vec3') as unknown as Vec3
    const projection = this.#projection as unknown as Mat4
    const toView = this.#toView as unknown as Mat3
    const clip = (p: Vec3): Vec4 =>
      projection.mul(vec4(toView.mul(p).add(this.#placeView), 1)).toConst()
    const pixels = (p: Vec4): Vec2 => p.xy.div(p.w.max(1e-6)).mul(frame.size).mul(0.5).toConst()
    /** Place in pixels along and across the piece, its length in pixels, and z in view space. */
    const place = varying(vec4(0)) as unknown as Variable<Vec4>
    /** Luminance of its middle in red and blue. */
    const light = varying(vec2(0)) as unknown as Variable<Vec2>
    const material = new NodeMaterial()
    Object.assign(material, {
      name: 'Welkin.LightningChannel',
      blending: CustomBlending,
      blendEquation: MaxEquation,
      blendSrc: OneFactor,
      blendDst: OneFactor,
      depthTest: false,
      depthWrite: false,
      transparent: true,
      side: DoubleSide
    })
    material.vertexNode = Fn(() => {
      const [a, b] = [clip(from.xyz), clip(to.xyz)]
      const [start, stop] = [pixels(a), pixels(b)]
      const line = stop.sub(start).toConst() as Vec2
      const length = line.length().toConst() as Float
      const along = line.div(length.max(1e-3)).toConst() as Vec2
      const beyond = corner.x.mul(2).sub(1).mul(BEYOND)
      const away = length.mul(corner.x).add(beyond).toConst() as Float
      const across = corner.y.mul(HALF_WIDTH).toConst() as Float
      const pixel = start.add(along.mul(away)).add(vec2(along.y.negate(), along.x).mul(across))
      const end = mix(from.xyz, to.xyz, corner.x).toConst() as Vec3
      const layers = field.atmosphere.layers.filter(layer => !('upTo' in layer))
      const displacement = toView.mul(end).add(this.#placeView).toConst() as Vec3
      const distance = field.view.toMapped(displacement).length().toConst() as Float
      // Light that clouds let through.
      const at = mix(start, stop, corner.x).div(frame.size).mul(vec2(1, -1)).add(0.5).clamp()
      const nearer = vec4(distance).sub(seen.distances.sample(at).level(0))
      const before = nearer.div(distance.mul(HIDING)).add(1).clamp()
      const through = seen.shares.sample(at).level(0).dot(before).oneMinus()
      const passing = through.sub(LEAST_PASSING).max(0)
      place.assign(vec4(away, across, length, displacement.z))
      const { transmittance } = aerialPerspectiveTo(field.view, displacement, layers)
      const width = distance.mul(field.pixelAngle).mul(WIDTH * Math.sqrt(2 * Math.PI))
      const perMetre = mix(this.#stemLight, this.#branchLight, to.w).mul(from.w)
      light.assign(transmittance.xz.mul(perMetre).mul(passing).div(width))
      // In front of the camera, or else nowhere.
      const isSeen = a.w.min(b.w).greaterThan(0)
      return select(isSeen, vec4(pixel.div(frame.size).mul(2), 0.5, 1), vec4(2, 2, 2, 1))
    })()
    material.fragmentNode = Fn(() => {
      const beside = place.x.sub(place.x.clamp(0, place.z)).toConst() as Float
      const square = beside.mul(beside).add(place.y.mul(place.y)).toConst() as Float
      // The channel is above the ground.
      If(isDrawnBefore(viewRays, vec2(screenUV), place.w.mul(0.999)), () => {
        Discard()
      })
      const luminance = light.mul(square.mul(-0.5 / WIDTH ** 2).exp())
      return vec4(luminance.min(GREATEST), 0, 1)
    })()
    return material
  }

  /** True in the box around the channel. To be called inside of a shader function. @param at - In the picture, y down. */
  isNear(at: Vec2): Bool {
    const box = this.#box as unknown as Vec4
    return at.clamp(box.xy, box.zw).distance(at).equal(0)
  }

  /** Red and blue of the channel, for `STORED_POWER`. To be called inside of a shader function. @param at - In the picture, y down. */
  sample(at: Vec2): Vec2 {
    return this.#texture.sample(at).level(0).xy
  }

  /**
   * Draws it.
   *
   * @param offset - Its place from the camera, in the mapped space [m].
   * @param branches - Light of branches over that which they can have, in [0, 1].
   */
  render(
    renderer: Renderer,
    { viewToMapped }: AtmosphereView,
    offset: Vector3,
    { axes, brightLength, pieces }: PlacedChannel,
    branches: number
  ): void {
    const [east, north, up] = axes
    _toView.copy(viewToMapped).invert()
    this.#placeView.value.copy(offset).applyMatrix3(_toView)
    const { x, y, z } = east
    this.#toView.value
      .set(x, north.x, up.x, y, north.y, up.y, z, north.z, up.z)
      .premultiply(_toView)
    const { frame } = this.#clouds.passes.viewRays
    frame.projectionOf(this.#clouds.camera, this.#projection.value)
    this.#stemLight.value = STORED_POWER / (4 * Math.PI * brightLength)
    this.#branchLight.value = this.#stemLight.value * branches
    const { x: width, y: height } = frame.size.value
    const target = this.#target
    if (target.width !== width || target.height !== height) target.setSize(width, height)
    target.scissorTest = true
    this.#eraser.render(renderer, target)
    this.#findBox(pieces)
    const state = RendererUtils.resetRendererState(renderer, {} as never)
    renderer.setRenderTarget(target)
    renderer.autoClear = false
    renderer.render(this.#scene, this.#clouds.camera)
    RendererUtils.restoreRendererState(renderer, state)
  }

  /** Sets the box around the channel, with the width of its lines. */
  #findBox(pieces: readonly ChannelPiece[]): void {
    const { width, height, scissor } = this.#target
    _picture.max.set(width, height)
    _box.makeEmpty()
    for (const end of pieces.flatMap(({ from, to }) => [from, to])) {
      _point
        .set(...end)
        .applyMatrix3(this.#toView.value)
        .add(this.#placeView.value)
      const isBehind = _point.z > 0
      const { x, y } = _point.applyMatrix4(this.#projection.value)
      // What is before the camera may be anywhere.
      if (isBehind) _box.copy(_picture)
      _box.expandByPoint(_pixel.set((1 + x) * width, (1 - y) * height).divideScalar(2))
    }
    const { min, max } = _box.expandByScalar(HALF_WIDTH + BEYOND + 1)
    for (const corner of [min, max]) corner.clamp(_picture.min, _picture.max)
    scissor.set(min.x, min.y, max.x - min.x, max.y - min.y)
    this.#box.value.set(min.x / width, min.y / height, max.x / width, max.y / height)
  }

  /** Frees its render target and geometry. */
  dispose(): void {
    this.#target.dispose()
    this.#mesh.geometry.dispose()
    this.#material.dispose()
    this.#eraser.dispose()
  }
}
