import { Camera, Group, Matrix4, PerspectiveCamera, Scene, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import {
  ecefFromTilesGroup,
  eciToECEF,
  fail,
  Ellipsoid,
  fitGlobeCamera,
  FloatingOrigin,
  Geodetic,
  geodesicDestination,
  geodesicDistance,
  horizonDip,
  horizonDistance,
  moonDirectionECEF,
  moonOrientation,
  moonPositionECEF,
  setOptions,
  siderealAngle,
  sunDirectionECEF,
  sunPositionECEF,
  tangentLimbDistance,
  visibleDistance
} from '@welkin/geo'

const earth = Ellipsoid.WGS84
const nan = new Vector3(0, NaN, 0)
const here = new Vector3(7e6, 0, 0)
const zero = new Vector3()
const place = { longitude: 0, latitude: 0 }
const never = new Date('never')

/** A class as a minifier leaves it. */
class e {
  x = 1
}

/** Value of a type that the compiler would not let pass. */
const wrong = (value: unknown): never => value as never

const cases: [message: string, call: () => unknown][] = [
  ['Ellipsoid: radius x must be positive and finite, got -1', () => new Ellipsoid(-1)],
  ['Ellipsoid: radius y must be positive and finite, got 0', () => new Ellipsoid(1, 0)],
  ['Ellipsoid: radius z must be positive and finite, got NaN', () => new Ellipsoid(1, 1, NaN)],
  ['Ellipsoid: radius x must be positive and finite, got Infinity', () => new Ellipsoid(Infinity)],
  [
    'Ellipsoid: radius x must be positive and finite, got -1',
    () => Ellipsoid.from({ radius: new Vector3(-1, 1, 1) })
  ],
  ['Ellipsoid: radius x must be positive and finite, got -621863', () => earth.grown(-7e6)],
  ['Ellipsoid.grown: height must be a finite number, got NaN', () => earth.grown(NaN)],
  ['Geodetic: latitude must be in [−90, 90], got 91', () => new Geodetic(0, 91)],
  ['Geodetic: longitude must be a finite number, got NaN', () => new Geodetic(NaN)],
  [
    'Geodetic.set: height must be a finite number, got Infinity',
    () => new Geodetic().set(0, 0, Infinity)
  ],
  [
    'Geodetic.copy: latitude must be in [−90, 90], got NaN',
    () => new Geodetic().copy({ longitude: 0, latitude: NaN })
  ],
  [
    'Ellipsoid.geodeticToECEF: latitude must be in [−90, 90], got -90.1',
    () => earth.geodeticToECEF({ longitude: 0, latitude: -90.1 })
  ],
  [
    'Ellipsoid.ecefToGeodetic: positionECEF must have finite components, got (0, NaN, 0)',
    () => earth.ecefToGeodetic(nan)
  ],
  [
    'Ellipsoid.surfaceNormal: positionECEF must have finite components',
    () => earth.surfaceNormal(nan)
  ],
  [
    'Ellipsoid.footPoint: positionECEF must have finite components',
    () => earth.localGroundRadius(nan)
  ],
  ['Ellipsoid.eastNorthUpFrame: positionECEF must have', () => earth.eastNorthUpFrame(nan)],
  ['Ellipsoid.localYUpFrame: positionECEF must have', () => earth.localYUpFrame(nan)],
  [
    'Ellipsoid.intersectRay: originECEF must have finite components',
    () => earth.intersectRay(nan, here)
  ],
  [
    'Ellipsoid.intersectRay: directionECEF must not be zero, got (0, 0, 0)',
    () => earth.intersectRay(here, zero)
  ],
  ['Ellipsoid.directionToSphere: direction must not be zero', () => earth.directionToSphere(zero)],
  ['Ellipsoid.directionFromSphere: direction must have', () => earth.directionFromSphere(nan)],
  [
    'Ellipsoid.osculatingSphere: radius must be positive and finite, got -5',
    () => earth.osculatingSphere(here, -5)
  ],
  [
    'geodesicDistance: latitude must be in [−90, 90], got 100',
    () => geodesicDistance(place, { longitude: 0, latitude: 100 })
  ],
  [
    'geodesicDistance: ellipsoid must have equal radii x and y, got (3, 2, 1)',
    () => geodesicDistance(place, place, new Ellipsoid(3, 2, 1))
  ],
  [
    'geodesicDestination: distance must be a finite number, got NaN',
    () => geodesicDestination(place, 0, NaN)
  ],
  [
    'geodesicDestination: azimuthDegrees must be a finite number, got NaN',
    () => geodesicDestination(place, NaN, 1)
  ],
  ['horizonDistance: positionECEF must have finite components', () => horizonDistance(nan)],
  [
    'horizonDip: azimuthDegrees must be a finite number, got NaN',
    () => horizonDip(here, { azimuthDegrees: NaN })
  ],
  [
    'tangentLimbDistance: limbHeight must be a finite number, got NaN',
    () => tangentLimbDistance(here, NaN)
  ],
  [
    'visibleDistance: targetHeight must be a finite number, got NaN',
    () => visibleDistance(here, NaN)
  ],
  [
    'visibleDistance: targetHeight must be at least surfaceHeight (10), got 5',
    () => visibleDistance(here, 5, 10)
  ],
  [
    'fitGlobeCamera: camera must be a PerspectiveCamera or an OrthographicCamera, got a Camera',
    () => fitGlobeCamera(new Camera() as PerspectiveCamera)
  ],
  [
    'fitGlobeCamera: minimumNear must be positive and finite, got 0',
    () => fitGlobeCamera(new PerspectiveCamera(), { minimumNear: 0 })
  ],
  [
    'fitGlobeCamera: clearance must be finite and ≥ 0, got -1',
    () => fitGlobeCamera(new PerspectiveCamera(), { clearance: -1 })
  ],
  [
    'fitGlobeCamera: minimumHeight must be at most maximumHeight (9000), got 9001',
    () => fitGlobeCamera(new PerspectiveCamera(), { minimumHeight: 9001 })
  ],
  [
    "fitGlobeCamera: depth must be 'standard', 'reversed' or 'logarithmic', got 'none'",
    () => fitGlobeCamera(new PerspectiveCamera(), { depth: 'none' as 'standard' })
  ],
  [
    'fitGlobeCamera: worldToECEF must have finite elements, got [1, 0, 0, 0, …]',
    () =>
      fitGlobeCamera(new PerspectiveCamera(), {
        worldToECEF: new Matrix4().makeTranslation(NaN, 0, 0)
      })
  ],
  [
    'fitGlobeCamera: camera position in ECEF must have finite components, got (NaN, NaN, NaN)',
    () => {
      const lost = new PerspectiveCamera()
      lost.position.x = NaN
      return fitGlobeCamera(lost)
    }
  ],
  [
    'FloatingOrigin: threshold must be positive and finite, got -1',
    () => new FloatingOrigin(new Group(), new Camera(), { threshold: -1 })
  ],
  [
    'FloatingOrigin: roots must not be inside one another, got a Group',
    () => {
      const a = new Group()
      const b = new Group()
      a.add(b)
      return new FloatingOrigin([a, b], new Camera())
    }
  ],
  [
    'FloatingOrigin.rebase: positionWorld must have finite components',
    () => new FloatingOrigin(new Group(), new Camera()).rebase(nan)
  ],
  [
    "ecefFromTilesGroup: the determinant of group's matrix must not be zero, got 0",
    () => {
      const group = new Group()
      group.scale.set(0, 1, 1)
      return ecefFromTilesGroup(group)
    }
  ],
  ['siderealAngle: date must be a valid Date, got Invalid Date', () => siderealAngle(never)],
  ['eciToECEF: date must be a valid Date', () => eciToECEF(never)],
  ['sunPositionECEF: date must be a valid Date', () => sunPositionECEF(never)],
  [
    "sunDirectionECEF: date must be a valid Date, got '2026-06-21'",
    () => sunDirectionECEF('2026-06-21' as unknown as Date)
  ],
  ['moonPositionECEF: date must be a valid Date', () => moonPositionECEF(never)],
  ['moonDirectionECEF: date must be a valid Date', () => moonDirectionECEF(never)],
  ['moonOrientation: date must be a valid Date', () => moonOrientation(never)],

  // Of another kind.
  [
    "Ellipsoid.geodeticToECEF: geodetic must be { longitude, latitude, height } [degrees, metres], got '35'",
    () => earth.geodeticToECEF(wrong('35'))
  ],
  [
    'geodesicDistance: to must be { longitude, latitude, height } [degrees, metres], got [1, 2]',
    () => geodesicDistance(place, wrong([1, 2]))
  ],
  [
    'geodesicDistance: ellipsoid must be an Ellipsoid, got { a: 1 }',
    () => geodesicDistance(place, place, wrong({ a: 1 }))
  ],
  [
    'horizonDip: ellipsoid must be an Ellipsoid, got null',
    () => horizonDip(here, { ellipsoid: wrong(null) })
  ],
  [
    'horizonDistance: positionECEF must be a Vector3, got [1, 2, 3]',
    () => horizonDistance(wrong([1, 2, 3]))
  ],
  [
    'FloatingOrigin: roots must be an Object3D or an array of such, got [undefined]',
    () => new FloatingOrigin(wrong([undefined]), new Camera())
  ],
  [
    'FloatingOrigin: camera must be an Object3D, got a Matrix4',
    () => new FloatingOrigin(new Group(), wrong(new Matrix4()))
  ],
  [
    'FloatingOrigin: worldToECEF must be a Matrix4, got a Group',
    () => new FloatingOrigin(new Group(), new Camera(), { worldToECEF: wrong(new Group()) })
  ],
  [
    'FloatingOrigin: threshold must be positive and finite, got NaN',
    () => (new FloatingOrigin(new Group(), new Camera()).threshold = NaN)
  ],
  [
    'ecefFromTilesGroup: group must be an Object3D, got undefined',
    () => ecefFromTilesGroup(wrong(undefined))
  ],

  // No such option.
  [
    "fitGlobeCamera: unknown option 'minimumNaer', did you mean 'minimumNear'?",
    () => fitGlobeCamera(new PerspectiveCamera(), wrong({ minimumNaer: 1 }))
  ],
  [
    "fitGlobeCamera: unknown option 'near', there are ellipsoid, worldToECEF",
    () => fitGlobeCamera(new PerspectiveCamera(), wrong({ near: 1 }))
  ],
  [
    "FloatingOrigin: unknown option 'treshold', did you mean 'threshold'?",
    () => new FloatingOrigin(new Group(), new Camera(), wrong({ treshold: 1 }))
  ],
  [
    "horizonDip: unknown option 'azimuthDegree', did you mean 'azimuthDegrees'?",
    () => horizonDip(here, wrong({ azimuthDegree: 1 }))
  ],
  [
    "visibleDistance: unknown option 'elipsoid', did you mean 'ellipsoid'?",
    () => visibleDistance(here, 0, 0, wrong({ elipsoid: earth }))
  ],
  [
    "geodesicDestination: unknown option 'heigth', did you mean 'height'?",
    () => geodesicDestination(wrong({ ...place, heigth: 3 }), 0, 1)
  ],
  [
    'fitGlobeCamera: options must be an object such as { ellipsoid }, got an Ellipsoid',
    () => fitGlobeCamera(new PerspectiveCamera(), wrong(earth))
  ]
]

describe('errors show what was given', () => {
  const shown: [text: string, value: unknown][] = [
    ["'35'", '35'],
    [`'${'a'.repeat(60)}…'`, 'a'.repeat(61)],
    ['35', 35],
    ['null', null],
    ['[]', []],
    ['[0, 1, 0]', [0, 1, 0]],
    ["['a', […], { … }, {}, …]", ['a', [1], { b: 2 }, {}, 5]],
    ['{}', {}],
    ["{ a: 1, b: 'c' }", { a: 1, b: 'c' }],
    ['(0, NaN, 0)', nan],
    ['a Scene', new Scene()],
    ['an Ellipsoid', earth],
    ['a Mesh', Object.assign(new e(), { type: 'Mesh' })],
    ['an object', new e()],
    ['the function Ellipsoid', Ellipsoid]
  ]
  it.each(shown)('%s', (text, value) => {
    expect(() => fail('Class', 'name must be right', value)).toThrow(
      new Error(`Class: name must be right, got ${text}`)
    )
  })

  it('shows nothing where there is nothing to show', () => {
    expect(() => fail('Class', 'is not ready')).toThrow(new Error('Class: is not ready'))
  })
})

describe('setOptions', () => {
  const settings = {
    even: 0,
    other: 1,
    get checked() {
      return this.even
    },
    set checked(value: number) {
      if (value % 2 === 1) fail('Settings', 'checked must be even', value)
      this.even = value
    }
  }

  it('assigns all or none, and leaves what is undefined', () => {
    setOptions('Settings', settings, { checked: 4, other: undefined }, 'checked', 'other')
    expect([settings.checked, settings.other]).toEqual([4, 1])
    expect(() =>
      setOptions('Settings', settings, { other: 5, checked: 3 }, 'checked', 'other')
    ).toThrow('Settings: checked must be even, got 3')
    expect(() =>
      setOptions('Settings', settings, { other: 5, cheked: 2 } as { other: number }, 'other')
    ).toThrow("Settings: unknown option 'cheked', there are other")
    expect([settings.checked, settings.other]).toEqual([4, 1])
  })
})

describe('wrong use throws with name and value', () => {
  it.each(cases)('%s', (message, call) => {
    expect(call).toThrow(message)
  })

  it('keeps the radii from changing', () => {
    expect(() => earth.radii.set(1, 2, 3)).toThrow(TypeError)
  })
})
