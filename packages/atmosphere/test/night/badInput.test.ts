import { Matrix4, PerspectiveCamera } from 'three'
import { vec4 } from 'three/tsl'
import {
  airglow,
  Atmosphere,
  milkyWay,
  moon,
  proceduralStars,
  Stars,
  starsOverlay,
  sunFlare
} from '@welkin/atmosphere'
import { throwsEach, wrong } from '../harness/wrong'

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const luna = moon().attach(atmosphere)
const night = {
  stars: new Stars({ catalogue: proceduralStars({ count: 2 }) }),
  way: milkyWay(),
  glow: airglow()
}
const flat = new Matrix4().set(
  ...(Array.from({ length: 16 }).fill(NaN) as Parameters<Matrix4['set']>)
)

throwsEach('moon and stars', [
  [
    'Stars: orientation must be a Matrix4',
    () => new Stars({ catalogue: [], orientation: wrong('north') })
  ],
  ['Stars: orientation must be a Matrix4', () => (night.stars.orientation = wrong(undefined))],
  ['MilkyWay: orientation must be a Matrix4', () => milkyWay({ orientation: flat })],
  ['Stars: intensity must be finite and ≥ 0, got NaN', () => (night.stars.intensity = NaN)],
  ['MilkyWay: intensity must be finite and ≥ 0, got -1', () => (night.way.intensity = -1)],
  [
    'Airglow: intensity must be finite and ≥ 0, got null',
    () => (night.glow.intensity = wrong(null))
  ],
  ['Airglow: luminance must be in', () => airglow({ luminance: wrong(null) })],
  ['Moon: strength must be finite', () => (luna.strength = wrong(null))],
  ['Moon: earthshine must be finite', () => (luna.earthshine = wrong(null))],
  ['Moon: phase must be in [0, 1], got []', () => moon({ phase: wrong([]) })],
  ['SunFlare: innerStrength must be', () => sunFlare({ innerStrength: wrong(null) })],
  ['proceduralStars: faintest must be in', () => proceduralStars({ faintest: wrong(null) })],
  ['Moon: direction must be a Vector3', () => moon({ direction: wrong([0, 1, 0]) })],
  ['Moon: direction must be a Vector3', () => (luna.direction = wrong(undefined))],
  ['Stars: catalogue must be an array of stars, got undefined', () => new Stars(wrong({}))],
  [
    'Stars: ascension of star 0 must be finite, got undefined',
    () => new Stars({ catalogue: [wrong({})] })
  ],
  [
    'Stars: ascension of star 0 must be finite, got undefined',
    () => new Stars({ catalogue: [wrong(null)] })
  ],
  ['Moon: outerPower must be positive and finite, got 0', () => (luna.flare.outerPower = 0)],
  ['SunFlare: innerStrength must be finite and ≥ 0', () => (sunFlare().innerStrength = -1)],
  [
    'StarsOverlayNode: depthNode must be a node, got a PerspectiveCamera',
    () => starsOverlay(vec4(1), wrong(camera), camera, atmosphere)
  ],
  [
    'StarsOverlayNode: transmittance must be a node, got 0.5',
    () => starsOverlay(vec4(1), vec4(1), camera, atmosphere, { transmittance: wrong(0.5) })
  ],
  [
    'Moon.seenFrom: position must be a Vector3, got a PerspectiveCamera',
    () => luna.seenFrom(wrong(camera))
  ]
])
