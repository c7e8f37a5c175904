import type { SurfaceWater } from '@welkin/atmosphere'
import {
  attribute,
  cameraPosition,
  dFdx,
  dFdy,
  float,
  Fn,
  If,
  mix,
  positionView,
  positionWorld,
  sin,
  smoothstep,
  texture,
  transformNormalToView,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import type { Node } from 'three/webgpu'
import { crops, roadAt } from './fields'
import { clumpsIn, cracksIn, grainNormal, levelOf, turned } from './groundDetail'
import { createGroundNoise } from './groundNoise'
import type { OpenSky } from './OpenSky'
import { PatchMap } from './PatchMap'
import type { Relief } from './relief'
import { VertexLitMaterial } from './VertexLitMaterial'

/** Radius of the planet, away from which the land bends [m]. */
export const RADIUS = 6_371_000

/** Height up to which land is farmed [m]. */
export const FARMED = 40

/** Depth by which the snow line comes down while snow lies everywhere [m]. */
const FALLEN_SNOW = 2300

/** Parts of a snowed wood that are dark, seen from afar: between crowns, and on their tops. */
const WOODS = [0.95, 0.76] as const

/** Parts of a road, and of stubble, that snow does not cover. */
const CLEARED = 0.7
const STUBBLE = 0.16

/** Part of the sky's light that a wet road mirrors at grazing angles. */
const MIRRORED = 0.2

/** Distances within which the finest grain of the ground is drawn, and that of tufts [m]. */
const NEAR = 200
const MIDDLE = 900

/** Way by which the finest grain strays from its place, over the period of its noise. */
const ASTRAY = 0.45

/** Height of grass and stones over the noise that they follow [m], and distance within which they shade themselves [m]. */
const GRASS = 0.1
const SHADED = 140

/** Height of crowns over their picture [m], and distance within which woods shade themselves [m]. */
const CROWNS = 3.5
const WOODED = 14_000

/** Brightness of crowns' tops over the noise that they follow, and of what is between them. */
const CANOPY = [-0.4, 0.35] as const

/** Share of woods from which ground has crowns, not clumps of grass, and distance within which these are drawn [m]. */
const WOODLAND = 0.12
const CLUMPED = 9000

/** Width of the edge of a wood, in its share of the ground. */
const EDGE = 0.16

/** Periods of the noise that tells broad parts of the land apart, and of that of patches [m]. */
const BROAD = [1310, 4170] as const
const PATCHES = 390

/** Coarse noise of the land, by a place [m]: of its broad parts, and of patches. */
export const coarseNoise =
  (noise: (at: Node<'vec2'>) => Node<'float'>) =>
  (place: Node<'vec3'>): Node<'vec2'> => {
    const [first, second, patches] = [...BROAD, PATCHES].map(each => noise(turned(place, each)))
    return vec2(first.add(second), patches)
  }

/** Colour and roughness of the ground: meadows, forest, rock, sand and snow by height and slope. */
export function groundMaterial(
  { wetnessNode, snowCoverNode }: SurfaceWater,
  relief: Relief,
  lamplight: Node<'vec3'> | null,
  sky: OpenSky | null = null
): VertexLitMaterial {
  const material = new VertexLitMaterial()
  const place = positionWorld.xz
  const picture = createGroundNoise()
  // Each of its many scales is blurred far away: there are coarser ones. The finest are seen along the ground.
  const grazed = picture.clone()
  picture.anisotropy = 1
  grazed.anisotropy = 2
  // The coarsest of its five octaves has 8 cells a period. Seen from above: with heights in it, slopes that go with them have
  // streaks.
  const turnedBy = (period: number): Node<'vec2'> => turned(positionWorld, period)
  const noiseAt = (at: Node<'vec2'>): Node<'float'> => texture(picture, at).r.sub(0.5).mul(2)
  const patchMap = new PatchMap(coarseNoise(noiseAt))
  for (const each of [picture, grazed, patchMap]) {
    material.addEventListener('dispose', () => each.dispose())
  }
  // A period that is a few pixels wide would show as a net.
  const distance = positionView.z.negate()
  const upTo = (metres: number): Node<'float'> => smoothstep(metres, metres / 4, distance)
  const coarse = patchMap.sample().toConst()
  const broad = coarse.x.mul(0.8).toVar()
  const patches = coarse.y.mul(upTo(24_000)).toVar()
  const near = turnedBy(1.9).toVar()
  const [across, along] = [dFdx(near).toVar(), dFdy(near).toVar()]
  // Its cells are seen near by: bent, they are no squares.
  const bent = turnedBy(11.3)
    .add(sin(turnedBy(0.9).yx).mul(0.05))
    .toVar()
  const [bentAcross, bentAlong] = [dFdx(bent).toVar(), dFdy(bent).toVar()]
  const grain = Fn(() => {
    const [tufts, sum] = [float(0).toVar(), float(0).toVar()]
    If(distance.lessThan(MIDDLE), () => {
      tufts.assign(texture(picture, bent).level(levelOf(bentAcross, bentAlong)).r.sub(0.5))
      sum.assign(tufts.mul(upTo(MIDDLE).mul(0.85)))
    })
    If(distance.lessThan(NEAR), () => {
      // Moved by what is coarser: its repetition would be a net.
      const moved = near.add(vec2(tufts, tufts.negate()).mul(ASTRAY))
      const finest = texture(grazed, moved).grad(across, along).r.sub(0.5).mul(2.2)
      sum.addAssign(finest.mul(upTo(NEAR)))
    })
    return sum
  })().toVar()
  const footprint = { right: dFdx(positionWorld).toVar(), down: dFdy(positionWorld).toVar() }
  const cover = attribute<'vec2'>('cover', 'vec2')
  const isWood = cover.x.greaterThan(WOODLAND)
  const clumped = clumpsIn(picture, distance.lessThan(CLUMPED), isWood, footprint)
    .mul(upTo(CLUMPED))
    .toVar()
  const clumps = clumped.x
  const fine = grain.add(clumps).add(patches).toVar()
  const height = positionWorld.y.add(place.dot(place).div(2 * RADIUS)).toVar()
  const rough = broad.mul(0.5).add(patches).toVar()
  const broadNormal = relief.normal().toConst()
  const slope = broadNormal.y.oneMinus().add(fine.mul(0.02)).add(rough.mul(0.07)).toVar()
  const field = cover.y
  // Woods have edges: between the grid's vertices noise tells where they are.
  const uneven = patches.mul(0.42).add(clumps.mul(0.12)).add(broad.mul(0.1))
  const wooded = cover.x.add(uneven.mul(smoothstep(0, 0.25, cover.x)))
  const forest = smoothstep(0.42 - EDGE, 0.42 + EDGE, wooded).toVar()
  const rocky = smoothstep(0.27, 0.42, slope).toVar()
  const cracks = Fn(() => {
    const found = vec2(0).toVar()
    If(rocky.greaterThan(0), () => {
      // Where walls turn, noise parts one from the other.
      const isEastern = broadNormal.x.abs().sub(broadNormal.z.abs()).greaterThan(fine.mul(0.25))
      found.assign(cracksIn(picture, isEastern, footprint).mul(rocky))
    })
    return found
  })().toVar()
  // Seen along the ground, differences between pixels are those of noise.
  const way = cameraPosition.sub(positionWorld).normalize()
  const facing = smoothstep(0.1, 0.45, broadNormal.dot(way)).toConst()
  const stones = grain.mul(GRASS).mul(upTo(SHADED)).add(cracks.x.mul(facing)).toConst()
  const crowns = clumped.yz.mul(forest.mul(CROWNS).mul(upTo(WOODED)).mul(facing))
  const rise = vec2(dFdx(stones), dFdy(stones)).add(crowns)
  const normal = grainNormal(broadNormal, rise, footprint).toVar()
  material.normalNode = transformNormalToView(normal)
  const dry = broad.mul(0.6).add(fine.mul(0.28)).add(0.43).clamp()
  const meadow = mix(vec3(0.053, 0.086, 0.027), vec3(0.14, 0.134, 0.055), dry).toVar()
  // Colour, and the part that snow does not cover: stalks of verges, and a road that is cleared.
  const farmed = Fn(() => {
    const ground = vec4(meadow, 0).toVar()
    If(height.lessThan(FARMED), () => {
      const road = roadAt().toConst()
      const tilled = mix(vec4(meadow, 0), crops(meadow, distance, clumps), field)
      ground.assign(mix(tilled, vec4(0.24, 0.21, 0.17, CLEARED), road))
    })
    return ground
  })()
  const canopy = smoothstep(...CANOPY, clumps.add(patches.mul(0.4)))
  const trees = mix(vec3(0.009, 0.016, 0.008), vec3(0.033, 0.046, 0.018), canopy)
  // Tufts stand in the light, gaps between them are dark.
  const tuft = smoothstep(-0.4, 0.45, grain)
    .sub(0.5)
    .mul(upTo(MIDDLE).mul(clumps.mul(0.9).add(0.65).clamp(0.15, 1.2)))
    .toVar()
  const hue = mix(vec3(0.93, 1.02, 0.86), vec3(1.08, 0.99, 1.06), tuft.add(0.5))
  const bright = hue.mul(float(0.95).add(fine.mul(0.2)).add(tuft.mul(0.24)))
  const snowLine = height.add(snowCoverNode.mul(FALLEN_SNOW)).toVar()
  const snow = smoothstep(1350, 1750, snowLine.add(broad.mul(170)).add(fine.mul(40)))
  const white = vec3(0.82, 0.84, 0.87).mul(rough.mul(0.07).add(1))
  // Of woods one sees the trunks and the undersides of branches, too.
  const dark = forest.mul(mix(float(WOODS[0]), float(WOODS[1]), canopy)).clamp()
  // Heights are those that no noise takes a part beyond.
  const color = Fn(() => {
    // Before branches: three computes in each of them what it meets there first. Slopes are read with all else.
    const cracked = cracks.toConst()
    const land = farmed.toConst()
    const result = land.rgb.toVar()
    const weathered = fine.mul(0.35).add(cracked.y.mul(0.55)).add(0.5).clamp()
    const rock = mix(vec3(0.105, 0.1, 0.094), vec3(0.29, 0.274, 0.247), weathered)
    const alpine = mix(
      vec3(0.095, 0.1, 0.045),
      rock,
      smoothstep(1050, 1700, height.add(broad.mul(150)))
    )
    // It lies in cracks, and is blown off what is between them.
    const steep = slope.add(cracked.y.mul(0.06))
    const stalks = land.a.mul(grain.mul(0.5).add(1)).add(smoothstep(0.2, 0.55, tuft).mul(STUBBLE))
    const whitened = snow
      .mul(smoothstep(0.46, 0.3, steep))
      .mul(dark.oneMinus())
      .mul(stalks.clamp().oneMinus())
    const cover = (other: Node<'vec3'>, share: Node<'float'>): void =>
      void result.assign(mix(result, other, share))
    If(height.greaterThan(350), () =>
      cover(alpine, smoothstep(550, 1050, height.add(broad.mul(120))))
    )
    If(height.lessThan(4.5), () =>
      cover(vec3(0.17, 0.15, 0.12), smoothstep(2.6, 0.6, height.add(fine.mul(0.5))))
    )
    If(forest.greaterThan(0), () => cover(trees, forest))
    result.mulAssign(bright)
    If(rocky.greaterThan(0), () => cover(rock.mul(bright), rocky))
    // Wet rough ground: of what it scatters, a share 1 − 1/n² comes back (Lekner & Dorf 1988).
    If(wetnessNode.greaterThan(0), () => {
      const back = result.oneMinus().mul(1.777).add(result)
      result.divAssign(mix(vec3(1), back, wetnessNode))
      // A wet road mirrors the sky as water does; ruts and stones scatter half of it.
      const grazing = cameraPosition.sub(positionWorld).normalize().y.oneMinus()
      const isRoad = smoothstep(0.5, CLEARED, land.a)
      const mirrored = grazing.pow(5).mul(wetnessNode).mul(isRoad).mul(MIRRORED)
      result.assign(mix(result, vec3(1), mirrored))
    })
    If(snowLine.greaterThan(900), () => cover(white, whitened))
    return result
  })()
  material.colorNode = color
  material.emissiveNode = lamplight
  if (sky !== null) material.openNode = sky.sample(footprint.right, footprint.down)
  return material
}
