import { Texture } from 'three'
import { expect, it } from 'vitest'
import { Atmosphere, distanceFog, heightFog, moon, planetGround } from '@welkin/atmosphere'
import { notASource, throwsEach, wrong } from '../harness/wrong'

const atmosphere = new Atmosphere()
const luna = moon().attach(atmosphere)
const fog = distanceFog()
const ground = planetGround()

throwsEach('fogs and ground', [
  [`HeightFog: sources[0] ${notASource}`, () => heightFog({ sources: [wrong(luna)] })],
  ['HeightFog: sources must be an array, got null', () => heightFog({ sources: wrong(null) })],
  [
    "PlanetGround: surface must be a Texture or null, got 'earth.jpg'",
    () => planetGround({ surface: wrong('earth.jpg') })
  ],
  ['PlanetGround: water must be a Texture', () => planetGround({ water: wrong({}) })],
  ['PlanetGround: nightLights must be a Texture', () => planetGround({ nightLights: wrong(1) })],
  ['DistanceFog: density must be in [0, 100], got NaN', () => (fog.density = NaN)],
  ['PlanetGround: windSpeed must be in [0, 40], got 41', () => (ground.windSpeed = 41)],
  ['PlanetGround: nightLuminance must be in', () => (ground.nightLuminance = NaN)],
  ['PlanetGround: roughness must be in [0, 1.5], got 2', () => (ground.roughness = 2)],
  ['HeightFog: density must be in [0, 100], got null', () => heightFog({ density: wrong(null) })],
  ['HeightFog: density must be in [0, 100], got []', () => heightFog({ density: wrong([]) })],
  [
    'HeightFog: albedo[1] must be in [0, 1], got null',
    () => heightFog({ albedo: [1, wrong(null), 1, 1] })
  ],
  ['DistanceFog: density must be in [0, 100], got []', () => distanceFog({ density: wrong([]) })],
  ['PlanetGround: roughness must be in', () => planetGround({ roughness: wrong(null) })],
  [
    'HeightFog: albedo must be an array of 4 values, got null',
    () => heightFog({ albedo: wrong(null) })
  ],
  [
    'HeightFog: fade must be an array of 2 altitudes, got null',
    () => heightFog({ fade: wrong(null) })
  ],
  [
    'DistanceFog: fade must be an array of 2 altitudes, got null',
    () => distanceFog({ fade: wrong(null) })
  ],
  ['DistanceFog: fade[1] must be in', () => distanceFog({ fade: [0, NaN] })]
])

it('ground tells its numbers and takes textures', () => {
  const made = planetGround({ surface: new Texture(), water: null })
  made.windSpeed = 12
  made.nightLuminance = 3
  made.roughness = 0
  expect([made.windSpeed, made.nightLuminance, made.roughness]).toEqual([12, 3, 0])
  // Those of another one stay.
  expect([planetGround().windSpeed, planetGround().roughness]).toEqual([7, 0.35])
})
