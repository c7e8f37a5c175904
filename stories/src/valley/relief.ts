import {
  HalfFloatType,
  LinearFilter,
  LinearMipmapLinearFilter,
  NoColorSpace,
  RGFormat
} from 'three'
import {
  cos,
  float,
  Fn,
  int,
  Loop,
  max,
  mix,
  positionWorld,
  rtt,
  sin,
  smoothstep,
  uint,
  uv,
  vec2,
  vec3
} from 'three/tsl'
import type { Node } from 'three/webgpu'
import { MEAN_RIDGE, ROUNDED } from './noise'
import { LAKE } from './places'

type Float = Node<'float'>
type Vec2 = Node<'vec2'>

/** Middle of the map along the valley, and distance from it to its edges [m]: all land that is drawn. */
const MIDDLE = -3500
const EXTENT = 48_500

/** Distance from the middle up to which texels are all alike [m], and the part of the map that is within it. Further out they grow. */
const EVEN = 11_000
const EVEN_PART = 0.8

/** Metres for each unit of the map's half width in its even part, and what is added to a distance for the square of one further out [m]. */
const UNIT = EVEN / EVEN_PART
const GROWTH = (EXTENT - EVEN - UNIT * (1 - EVEN_PART)) / (1 - EVEN_PART) ** 2

/** Distance from the middle along both axes, of a place in the map whose middle is 0 and whose edges are ±1 [m]. */
function fromMiddle(at: Vec2): Vec2 {
  const beyond = at.abs().sub(EVEN_PART).max(0)
  return at.mul(UNIT).add(beyond.mul(beyond).mul(GROWTH).mul(at.sign()))
}

/** Place in the map of a distance from the middle: the inverse of `fromMiddle`. */
function inMap(distance: Vec2): Vec2 {
  const size = distance.abs().toConst()
  const beyond = size.sub(EVEN).max(0)
  const grown = beyond
    .mul(4 * GROWTH)
    .add(UNIT ** 2)
    .sqrt()
    .sub(UNIT)
    .div(2 * GROWTH)
  return size.min(EVEN).div(UNIT).add(grown).mul(distance.sign())
}

/** Pseudo-random direction of a lattice point, along which an offset from it is measured: the noise's gradient. */
const gradient = /*#__PURE__*/ Fn(([cell, offset]: [Vec2, Vec2]) => {
  const bits = uint(int(cell.x))
    .mul(uint(0x27d4eb2d))
    .bitXor(uint(int(cell.y)).mul(uint(0x165667b1)))
    .toVar()
  bits.assign(bits.bitXor(bits.shiftRight(uint(15))).mul(uint(0x2c1b3c6d)))
  bits.assign(bits.bitXor(bits.shiftRight(uint(12))))
  const angle = float(bits).mul((2 * Math.PI) / 2 ** 32)
  return cos(angle).mul(offset.x).add(sin(angle).mul(offset.y))
}).setLayout({
  name: 'valleyGradient',
  type: 'float',
  inputs: [
    { name: 'cell', type: 'vec2' },
    { name: 'offset', type: 'vec2' }
  ]
})

/** Gradient noise: twin of `smoothNoise` in noise.ts. */
const smoothNoise = /*#__PURE__*/ Fn(([place]: [Vec2]) => {
  const cell = place.floor().toConst()
  const at = place.sub(cell).toConst()
  const fade = at
    .mul(at)
    .mul(at)
    .mul(at.mul(at.mul(6).sub(15)).add(10))
    .toConst()
  const corner = (x: number, y: number): Float => gradient(cell.add(vec2(x, y)), at.sub(vec2(x, y)))
  return mix(
    mix(corner(0, 0), corner(1, 0), fade.x),
    mix(corner(0, 1), corner(1, 1), fade.x),
    fade.y
  )
}).setLayout({ name: 'valleyNoise', type: 'float', inputs: [{ name: 'place', type: 'vec2' }] })

/** Mountains of unit width: twin of `ridges` in noise.ts, down to the finest of its octaves that the map can hold. */
const ridges = /*#__PURE__*/ Fn(([place, finest]: [Vec2, Float]) => {
  const bent = place
    .add(
      vec2(
        smoothNoise(place.mul(1.7).add(vec2(5, 0))),
        smoothNoise(place.mul(1.7).add(vec2(0, 9)))
      ).mul(0.22)
    )
    .toConst()
  const sum = float(0).toVar()
  const weight = float(1).toVar()
  const amplitude = float(0.5).toVar()
  const scale = float(1).toVar()
  Loop(8, ({ i }: { i: Node<'int'> }) => {
    const octave = float(i)
    const noise = smoothNoise(bent.mul(scale).add(vec2(octave.mul(17), octave.mul(-9))))
    const crease = noise.mul(1.4).abs().oneMinus()
    const ridge = crease.mul(crease).toConst()
    const isShown = finest.mul(scale).reciprocal().sub(1).clamp()
    sum.addAssign(amplitude.mul(weight).mul(mix(float(MEAN_RIDGE), ridge, isShown)))
    weight.assign(ridge.mul(weight).mul(1.6).clamp())
    amplitude.mulAssign(0.5)
    scale.mulAssign(2.03)
  })
  const above = max(sum.sub(ROUNDED), 0).div(1 - ROUNDED)
  return sum.min(ROUNDED).add(
    above
      .negate()
      .exp()
      .oneMinus()
      .mul(1 - ROUNDED)
  )
}).setLayout({
  name: 'valleyRidges',
  type: 'float',
  inputs: [
    { name: 'place', type: 'vec2' },
    { name: 'finest', type: 'float' }
  ]
})

/** Height of the land on a plane [m]: twin of `flatHeight` in ground.ts. */
export const flatHeight = /*#__PURE__*/ Fn(([place, finest]: [Vec2, Float]) => {
  const { x, y: z } = place
  const valley = sin(z.div(3100).add(0.4))
    .mul(500)
    .add(sin(z.div(1270).add(1.1)).mul(220))
  const wall = max(x.sub(valley).abs(), z.negate().sub(5200).mul(0.8)).toConst()
  const width = sin(z.div(1700)).mul(190).add(640)
  const rise = wall.sub(width).div(3400).clamp().toConst()
  const knolls = smoothNoise(place.div(260))
    .mul(14)
    .add(smoothNoise(place.div(55)).mul(3))
  const floor = max(wall.sub(250), 0)
    .mul(0.012)
    .add(7)
    .add(knolls.mul(smoothstep(120, 700, wall)))
  const peaks = ridges(place.div(5200), finest.div(5200)).mul(2150).add(260)
  const height = floor.add(rise.pow(1.25).mul(peaks)).toConst()
  const bend = sin(z.div(420)).mul(130)
  const fromLake = vec2(
    x.sub(LAKE.x).sub(bend).div(LAKE.halfWidth),
    z.sub(LAKE.z).div(LAKE.halfLength)
  ).length()
  const basin = smoothstep(0.8, 1.25, fromLake)
    .oneMinus()
    .mul(smoothstep(50, 150, height).oneMinus())
  return mix(height, float(-14), basin)
}).setLayout({
  name: 'valleyHeight',
  type: 'float',
  inputs: [
    { name: 'place', type: 'vec2' },
    { name: 'finest', type: 'float' }
  ]
})

/**
 * Slopes of the ground in a map that is made on the GPU with the first frame: the land's light shows ridges and gullies between
 * the vertices of its grid.
 */
export class Relief {
  readonly #map

  /** @param size - Texels along an edge. */
  constructor(size: number) {
    const at = uv().sub(0.5).mul(2).toConst()
    const place = fromMiddle(at).add(vec2(0, MIDDLE)).toConst()
    const beyond = at.abs().sub(EVEN_PART).max(0)
    const texel = beyond
      .mul(2 * GROWTH)
      .add(UNIT)
      .mul(2 / size)
      .toConst()
    const finest = max(texel.x, texel.y).mul(2).toConst()
    const rise = (across: Vec2, length: Float): Float =>
      flatHeight(place.add(across), finest)
        .sub(flatHeight(place.sub(across), finest))
        .div(length.mul(2))
    const slopes = vec2(rise(vec2(texel.x, 0), texel.x), rise(vec2(0, texel.y), texel.y))
    this.#map = rtt(slopes, size, size, {
      type: HalfFloatType,
      format: RGFormat,
      colorSpace: NoColorSpace,
      depthBuffer: false,
      generateMipmaps: true,
      minFilter: LinearMipmapLinearFilter,
      magFilter: LinearFilter,
      anisotropy: 2,
      autoUpdate: false
    })
  }

  /** Normal of the ground in world space. */
  normal(): Node<'vec3'> {
    const { x, z } = positionWorld
    const at = inMap(vec2(x, z.sub(MIDDLE))).mul(0.5)
    const slopes = (this.#map.sample(at.add(0.5)) as unknown as Node<'vec2'>).toConst()
    return vec3(slopes.x.negate(), 1, slopes.y.negate()).normalize()
  }

  /** Frees the map. */
  dispose(): void {
    this.#map.dispose()
  }
}
