import type { DataTexture } from 'three'
import {
  attribute,
  float,
  hash,
  mix,
  normalViewGeometry,
  positionView,
  screenCoordinate,
  smoothstep,
  texture,
  uv,
  vec3
} from 'three/tsl'
import type { Node, NodeMaterial } from 'three/webgpu'
import { mipmapped } from '../mipmapped'
import { randomSequence } from '../random'

/** Texels along an edge of each of the two halves of the picture. */
const SIZE = 256

/** Numbers of channels of a texel. */
const CHANNELS = 4

/** Leaves of a spray, and needles along a twig and its side twigs. */
const LEAVES = 330
const SIDE_TWIGS = 32

/** Branches of a spray without leaves, and twigs of each. */
const BRANCHES = 5
const TWIGS = 5

/** Coverage of leaves from which a place is solid, near and far: far away pictures are means, of which gaps take most. */
const SOLID = [0.5, 0.34] as const
const FAR = 160

/** Blue of vertices in the shade of a crown over their green, at most. */
const SHADED = 0.12

/** Colour of leaves in the shade over that of their vertices, whose blue only marks them. */
const SHADE_COLOR = [1, 1, 9] as const

/** Colour of twigs over that of leaves. */
const TWIG_COLOR = [2.3, 1.35, 4] as const

/** Coverage of twigs from which a place is solid near by, and the range of such limits far away. */
const TWIG_EDGE = 0.3
const TWIG_NOISE = [0.03, 0.5] as const

/** Coverage of twigs in means of a picture from which they are solid. */
const TWIG_MEAN = 0.19

/** Part of a bare crown of the distance that one looks through. */
const BARE = 0.55

/** Share of leaves that have fallen: all where snow lies. */
export const fallenLeaves = (snow: Node<'float'>): Node<'float'> => smoothstep(0.1, 0.6, snow)

/** Colour of a crown over that of its leaves, by the share that has fallen. */
export const autumnColor = (fallen: Node<'float'>): Node<'vec3'> =>
  mix(vec3(1), vec3(...TWIG_COLOR), fallen)

type Bytes = Uint8Array

/** Channels of coverage: of leaves and needles, and of the twigs that are left of a spray when its leaves have fallen. */
const LEAFY = 1
const BARE_TWIGS = 2

/** Paints an ellipse: full coverage, and of leaves their brightness. */
function ellipse(
  bytes: Bytes,
  left: number,
  [x, y]: readonly [number, number],
  [length, width]: readonly [number, number],
  angle: number,
  brightness: number,
  channel = LEAFY
): void {
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)]
  const reach = Math.ceil(Math.max(length, width))
  for (let j = Math.floor(y) - reach; j <= y + reach; j++) {
    for (let i = Math.floor(x) - reach; i <= x + reach; i++) {
      if (i < 0 || j < 0 || i >= SIZE || j >= SIZE) continue
      const [dx, dy] = [i + 0.5 - x, j + 0.5 - y]
      const along = (dx * cos + dy * sin) / length
      const across = (dy * cos - dx * sin) / width
      if (along * along + across * across > 1) continue
      const texel = CHANNELS * (j * 2 * SIZE + left + i)
      bytes[texel + channel] = 255
      // The rib of a leaf is darker on one side.
      if (channel === LEAFY) bytes[texel] = 255 * Math.min(brightness * (across > 0 ? 1 : 0.86), 1)
    }
  }
}

/** Paints the twigs of a spray without leaves: branches from its middle outwards, with twigs on both sides. */
function bareTwigs(bytes: Bytes, random: () => number): void {
  const line = (x: number, y: number, angle: number, length: number, width: number): void => {
    const middle = [
      SIZE * (x + 0.5 * length * Math.cos(angle)),
      SIZE * (y + 0.5 * length * Math.sin(angle))
    ] as const
    ellipse(bytes, 0, middle, [0.5 * SIZE * length, SIZE * width], angle, 1, BARE_TWIGS)
  }
  for (let i = 0; i < BRANCHES; i++) {
    const angle = (2 * Math.PI * (i + 0.7 * random())) / BRANCHES
    const reach = 0.36 + 0.13 * random()
    line(0.5, 0.5, angle, reach, 0.01)
    for (let j = 1; j <= TWIGS; j++) {
      const along = (reach * (j + random())) / (TWIGS + 1)
      const place = [0.5 + along * Math.cos(angle), 0.5 + along * Math.sin(angle)] as const
      const aside = angle + (j % 2 === 0 ? 1 : -1) * (0.5 + 0.5 * random())
      line(...place, aside, (0.1 + 0.08 * random()) * (1.25 - along / reach), 0.008)
    }
  }
}

/**
 * Left: a spray of leaves. Right: a twig with needles, its tip above. Brightness in red, coverage in green; in blue that of the
 * twigs of the spray alone.
 */
function createLeafTexture(): DataTexture {
  const random = randomSequence(41)
  const bytes = new Uint8Array(CHANNELS * 2 * SIZE * SIZE)
  for (let i = 0; i < bytes.length; i += CHANNELS) bytes[i] = 150
  for (let i = 0; i < LEAVES; i++) {
    const [angle, radius] = [2 * Math.PI * random(), 0.45 * Math.sqrt(random())]
    // Fewer towards the edge: sprays have no outline of their own.
    if (random() < 1.6 * radius - 0.25) continue
    const place = [0.5 + radius * Math.cos(angle), 0.5 + radius * Math.sin(angle)] as const
    const size = SIZE * (0.024 + 0.018 * random())
    const brightness = 0.42 + 0.5 * (i / LEAVES) + 0.12 * random()
    const at = [SIZE * place[0], SIZE * place[1]] as const
    ellipse(bytes, 0, at, [size, 0.55 * size], angle + 1.6 * random(), brightness)
  }
  ellipse(bytes, SIZE, [SIZE / 2, SIZE / 2], [SIZE / 2, 0.02 * SIZE], Math.PI / 2, 0.35)
  for (let i = 0; i < SIDE_TWIGS; i++) {
    const [up, side] = [(Math.floor(i / 2) + 0.6 * random()) / (SIDE_TWIGS / 2), i % 2 ? 1 : -1]
    // Broadest a third of the way up.
    const length = 0.46 * (up < 0.3 ? 0.5 + up / 0.6 : 1.43 * (1 - up)) * (0.75 + 0.35 * random())
    const angle = Math.PI / 2 - side * (1.05 - 0.35 * up)
    for (let t = 0; t < 1; t += 0.09) {
      const x = 0.5 + t * length * Math.cos(angle)
      const y = 0.03 + 0.94 * up + t * length * Math.sin(angle)
      const tuft = SIZE * 0.06 * (1 - 0.5 * t)
      const brightness = 0.5 + 0.4 * t + 0.15 * random()
      ellipse(
        bytes,
        SIZE,
        [SIZE * x, SIZE * y],
        [tuft, 0.5 * tuft],
        angle + random() - 0.5,
        brightness
      )
    }
  }
  bareTwigs(bytes, random)
  return mipmapped(bytes, 2 * SIZE, SIZE)
}

/** Noise of pixels, in [0, 1]: what is finer than these covers as many of them as it would cover of one. */
const dither = (): Node<'float'> => hash(screenCoordinate.x.add(screenCoordinate.y.mul(4099)))

/**
 * Gives a material of trees their leaves and needles, by texture coordinates: bark, of which vertices are redder than green, and
 * leaves in the shade, which are less blue than {@link SHADED}, have none. Leaves are lit by the normals of their vertices from both sides.
 *
 * @param fallen - Share of the leaves that have fallen, in [0, 1]; null for trees that keep theirs.
 */
export function setFoliage(material: NodeMaterial, fallen: Node<'float'> | null = null): void {
  const picture = createLeafTexture()
  material.addEventListener('dispose', () => picture.dispose())
  const leaf = texture(picture, uv()).toConst()
  const color = attribute<'vec3'>('color', 'vec3')
  const isBark = color.r.greaterThan(color.g)
  const isShade = color.b.lessThan(color.g.mul(SHADED))
  const distance = positionView.z.negate()
  const [near, far] = SOLID
  const remoteness = smoothstep(FAR / 8, FAR, distance)
  const solid = remoteness.mul(far - near).add(near)
  const hasLeaf = leaf.g.greaterThan(solid)
  const brightness = leaf.r.mul(1.25).add(0.22).toConst()
  const shade = vec3(...SHADE_COLOR).mul(brightness)
  const painted = isBark.select(vec3(1), isShade.select(shade, vec3(brightness)))
  material.normalNode = normalViewGeometry
  if (fallen === null) {
    material.maskNode = hasLeaf.or(isShade).or(isBark)
    material.colorNode = painted
    return
  }
  // Leaves fall one by one. Twigs are finer than pixels from near by.
  const noise = dither().toConst()
  const isBare = noise.lessThan(fallen)
  const twigs = leaf.b.greaterThan(mix(float(TWIG_EDGE), noise.clamp(...TWIG_NOISE), remoteness))
  material.maskNode = isBare.select(twigs.and(isShade.not()), hasLeaf.or(isShade)).or(isBark)
  const isLeaf = isBark.or(isShade).not()
  material.colorNode = isLeaf.select(autumnColor(fallen), vec3(1)).mul(painted)
}

/** Gives a material of trees that have shed all leaves their twigs, as {@link setFoliage} does, alike from near and far. */
export function setTwigs(material: NodeMaterial): void {
  const picture = createLeafTexture()
  material.addEventListener('dispose', () => picture.dispose())
  const color = attribute<'vec3'>('color', 'vec3')
  const isBark = color.r.greaterThan(color.g)
  material.maskNode = texture(picture, uv()).b.greaterThan(TWIG_MEAN).or(isBark)
  material.normalNode = normalViewGeometry
  material.colorNode = isBark.select(vec3(1), autumnColor(float(1)).mul(0.7))
}

/** Gives a material of trees of the distance bare crowns that one looks through, where leaves have fallen. */
export function setFarFoliage(material: NodeMaterial, fallen: Node<'float'>): void {
  const color = attribute<'vec3'>('color', 'vec3')
  const isBark = color.r.greaterThan(color.g)
  material.maskNode = dither().greaterThanEqual(fallen.mul(BARE)).or(isBark)
  material.colorNode = isBark.select(vec3(1), autumnColor(fallen))
}
