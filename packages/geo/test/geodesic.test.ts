import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { Ellipsoid, geodesicDestination, geodesicDistance, geodesicInverse } from '@welkin/geo'
import { latitude, longitude, number, runs } from './arbitraries'

const dms = (degrees: number, minutes: number, seconds: number): number =>
  Math.sign(degrees) * (Math.abs(degrees) + minutes / 60 + seconds / 3600)

const at = (latitude: number, longitude: number) => ({ latitude, longitude })

describe('published geodesics', () => {
  it('Flinders Peak to Buninyong, GRS80 (Geocentric Datum of Australia technical manual)', () => {
    const a = 6378137
    const grs80 = new Ellipsoid(a, a, a * (1 - 1 / 298.257222101))
    const flinders = at(dms(-37, 57, 3.7203), dms(144, 25, 29.5244))
    const buninyong = at(dms(-37, 39, 10.1561), dms(143, 55, 35.3839))
    const path = geodesicInverse(flinders, buninyong, grs80)
    expect(path.distance).toBeCloseTo(54972.271, 3)
    expect(path.initialAzimuth + 360).toBeCloseTo(dms(306, 52, 5.37), 5)
    // The manual gives the reverse azimuth, back from Buninyong.
    expect(path.finalAzimuth + 180).toBeCloseTo(dms(127, 10, 25.07), 5)
    const end = geodesicDestination(flinders, dms(306, 52, 5.37), 54972.271, grs80)
    expect(end.latitude).toBeCloseTo(buninyong.latitude, 7)
    expect(end.longitude).toBeCloseTo(buninyong.longitude, 7)
  })

  it('Wellington to Salamanca, nearly antipodal (GeographicLib documentation)', () => {
    expect(geodesicDistance(at(-41.32, 174.81), at(40.96, -5.5))).toBeCloseTo(19959679.267, 3)
  })

  it('20,000 km south-west from Perth (GeographicLib documentation)', () => {
    const end = geodesicDestination(at(-32.06, 115.74), 225, 20000e3)
    expect(end.latitude).toBeCloseTo(32.11195529, 8)
    expect(end.longitude).toBeCloseTo(-63.95925278, 8)
  })

  /** Latitude, longitude, azimuth; the same at the other end; distance. Karney's GeodTest cases. */
  const karney = [
    [
      35.60777, -139.44815, 111.098748429560326, -11.17491, -69.95921, 129.289270889708762,
      8935244.5604818305
    ],
    [
      55.52454, 106.05087, 22.020059880982801, 77.03196, 197.18234, 109.112041110671519,
      4105086.1713924406
    ],
    [
      -21.97856, 142.59065, -32.44456876433189, 41.84138, 98.56635, -41.84359951440466,
      8394328.894657671
    ],
    [
      -17.42761, 173.34268, -159.033557661192928, -15.84784, 5.93557, -20.787484651536988,
      16076603.1631180673
    ],
    [
      6.96833, 52.74123, 92.581585386317712, -7.39675, 206.17291, 90.721692165923907,
      17102477.2496958388
    ]
  ] as const

  it.each(karney)('Karney, from %d° %d°', (lat1, lon1, azi1, lat2, lon2, azi2, distance) => {
    const path = geodesicInverse(at(lat1, lon1), at(lat2, lon2))
    expect(path.distance).toBeCloseTo(distance, 7)
    expect(path.initialAzimuth).toBeCloseTo(azi1, 11)
    expect(path.finalAzimuth).toBeCloseTo(azi2, 11)
    const end = geodesicDestination({ ...at(lat1, lon1), height: 123 }, azi1, distance)
    expect(end.latitude).toBeCloseTo(lat2, 12)
    expect((end.longitude + 360) % 360).toBeCloseTo((lon2 + 360) % 360, 11)
    expect(end.height).toBe(123)
  })

  it('quarter meridian of WGS84: 10,001,965.729 m', () => {
    expect(geodesicDistance(at(0, 0), at(90, 0))).toBeCloseTo(10001965.729, 3)
  })

  it('is a great circle on a sphere', () => {
    const sphere = new Ellipsoid(6371e3)
    expect(geodesicDistance(at(0, 0), at(0, 90), sphere)).toBeCloseTo((6371e3 * Math.PI) / 2, 6)
    expect(geodesicDistance(at(30, 10), at(-30, -170), sphere)).toBeCloseTo(6371e3 * Math.PI, 6)
  })
})

it('destination undoes distance and azimuth', () => {
  fc.assert(
    fc.property(longitude, latitude, number(-180, 180), number(0, 2e7), (lon, lat, azimuth, d) => {
      const start = at(lat, lon)
      const end = geodesicDestination(start, azimuth, d)
      const path = geodesicInverse(start, end)
      // A geodesic is shortest up to the conjugate point, near the antipode.
      if (d < 1.99e7) expect(path.distance).toBeCloseTo(d, 5)
      const again = geodesicDestination(start, path.initialAzimuth, path.distance)
      const gap = Ellipsoid.WGS84.geodeticToECEF(again).distanceTo(
        Ellipsoid.WGS84.geodeticToECEF(end)
      )
      expect(gap).toBeLessThan(1e-6)
    }),
    runs
  )
})
