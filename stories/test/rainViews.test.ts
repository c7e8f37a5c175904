import { AtmosphereParameters } from '@welkin/atmosphere'
import { CloudLayer, cloudPreset } from '@welkin/clouds'
import { Ellipsoid } from '@welkin/geo'
import { MathUtils, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { layerRotation } from '../../packages/clouds/src/density/lattice'
import type { CloudState } from '../../packages/clouds/test/twins/density'
import { NoiseTextures } from '../../packages/clouds/test/twins/noiseTextures'
import { fallenRank } from '../../packages/clouds/test/twins/precipitation'
import { FIELD_OF_VIEW, VIEWS, type View } from '../src/rainViews'

const { bottomRadius } = new AtmosphereParameters()
const noise = new NoiseTextures()
const { radii } = Ellipsoid.WGS84

/** Rank of the column from which it falls, at a distance from a view's camera [m] in an azimuth [°]; 0 where it is dry. */
function rainOf(view: View): (azimuth: number, distance: number) => number {
  const [longitude, latitude] = [view.place.longitude, view.place.latitude].map(MathUtils.degToRad)
  // Clouds live on the sphere that the ellipsoid is stretched to.
  const reduced = Math.atan((radii.z / radii.x) * Math.tan(latitude))
  const up = new Vector3().setFromSphericalCoords(1, Math.PI / 2 - reduced, longitude)
  const zenith = new Vector3(up.z, up.x, up.y)
  const east = new Vector3(-Math.sin(longitude), Math.cos(longitude), 0)
  const north = zenith.clone().cross(east)
  const parameters = {
    ...cloudPreset(view.clouds).at(0).parameters,
    ...view.layer,
    coverage: view.coverage
  }
  const precipitation = { ...parameters.precipitation, rate: 1, ...view.fall }
  const layer = new CloudLayer({ ...parameters, precipitation }).parameters
  const state: CloudState = {
    layers: [layer],
    rotations: [layerRotation(0)],
    bottomRadius,
    zenith,
    pixelAngle: MathUtils.degToRad(FIELD_OF_VIEW) / 1080
  }
  return (azimuth, distance) => {
    const angle = MathUtils.degToRad(azimuth)
    const place = zenith
      .clone()
      .multiplyScalar(bottomRadius)
      .addScaledVector(east, Math.sin(angle) * distance)
      .addScaledVector(north, Math.cos(angle) * distance)
      .setLength(bottomRadius + layer.baseAltitude / 2)
    return fallenRank(state, noise, 0, place, distance)
  }
}

/** Numbers from one to another. */
const range = (from: number, to: number, step: number): number[] =>
  Array.from({ length: Math.floor((to - from) / step) + 1 }, (_, i) => from + i * step)

describe.for(['shower', 'bow'] as const)('the view of a %s', name => {
  const view = VIEWS[name]
  const rain = rainOf(view)
  const strongest = range(-55, 55, 2.5).map(turn => ({
    turn,
    rank: Math.max(...range(500, 20_000, 500).map(far => rain(view.heading + turn, far)))
  }))

  it('is from beside it', () => {
    for (const azimuth of range(0, 330, 30))
      for (const distance of range(0, 1500, 500)) expect(rain(azimuth, distance)).toBe(0)
  })

  it('has a strong shaft in the middle, which ends in the picture', () => {
    const middle = strongest.filter(({ turn }) => Math.abs(turn) < 15)
    expect(Math.max(...middle.map(({ rank }) => rank))).toBeGreaterThan(0.6)
    expect(strongest.filter(({ rank }) => rank === 0).length).toBeGreaterThan(3)
  })
})

it('the view of virga has many tails before one, and next to none overhead', () => {
  const { heading } = VIEWS.virga
  const rain = rainOf(VIEWS.virga)
  const found = (distances: readonly number[]): number[] =>
    range(-25, 25, 2.5).flatMap(turn => distances.map(far => rain(heading + turn, far)))
  const ahead = found(range(5000, 9000, 500))
  expect(ahead.filter(rank => rank > 0.3).length).toBeGreaterThan(ahead.length / 4)
  expect(Math.max(...found(range(0, 2000, 500)))).toBeLessThan(0.1)
})
