import { PerspectiveCamera, Texture } from 'three'
import { texture } from 'three/tsl'
import {
  Atmosphere,
  autoExposure,
  type AutoExposureOptions,
  DayCycle,
  exposureFor,
  exposureOfIlluminance,
  moon,
  photographicToneMapping
} from '@welkin/atmosphere'
import { noOptions, notASource, throwsEach, wrong } from '../harness/wrong'

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const luna = moon().attach(atmosphere)
const picture = texture(new Texture())
const metered = autoExposure(picture, atmosphere)
const cycle = new DayCycle(atmosphere, { date: new Date('2026-06-21T12:00:00Z') })

throwsEach('exposure', [
  [
    'photographicToneMapping: contrast must be > 0, got 0',
    () => photographicToneMapping({ contrast: 0 })
  ],
  [
    'photographicToneMapping: saturation must be ≥ 0, got NaN',
    () => photographicToneMapping({ saturation: NaN })
  ],
  [
    'photographicToneMapping: white must be three numbers > 0, got 1,0,1',
    () => photographicToneMapping({ white: [1, 0, 1] })
  ],
  [
    `DayCycle: sources[0] ${notASource}`,
    () => new DayCycle(atmosphere, { exposureOptions: { sources: [wrong(luna)] } })
  ],
  [
    `exposureFor: sources[0] ${notASource}`,
    () => exposureFor(atmosphere, camera, { sources: [wrong(luna)] })
  ],
  [
    'DayCycle: floor must be positive and finite, got NaN',
    () => new DayCycle(atmosphere, { exposureOptions: { floor: NaN } })
  ],
  [`DayCycle: ${noOptions}`, () => new DayCycle(atmosphere, { exposureOptions: wrong(null) })],
  [
    'exposureFor: camera must be a Camera, got undefined',
    () => exposureFor(atmosphere, wrong(undefined))
  ],
  [
    'exposureFor: clouds must be a CloudCover of @welkin/clouds, or null, got 0.5',
    () => exposureFor(atmosphere, camera, { clouds: wrong(0.5) })
  ],
  ['exposureFor: atmosphere must be an Atmosphere', () => exposureFor(wrong(undefined), camera)],
  ['illuminance must be finite and ≥ 0, got NaN', () => exposureOfIlluminance(NaN)],
  ['illuminance must be finite and ≥ 0, got -1', () => exposureOfIlluminance(-1)],
  ['illuminance must be finite and ≥ 0, got Infinity', () => exposureOfIlluminance(Infinity)],
  [
    'DayCycle: autoExposure must be an autoExposure() of its atmosphere, got 1',
    () => new DayCycle(atmosphere, { autoExposure: wrong(1) })
  ],
  [
    'DayCycle: autoExposure must be an autoExposure() of its atmosphere',
    () => new DayCycle(new Atmosphere(), { autoExposure: metered })
  ],
  [
    'AutoExposureNode: colorNode must be a node, got undefined',
    () => autoExposure(wrong(undefined), atmosphere)
  ],
  [
    'AutoExposureNode: atmosphere must be an Atmosphere',
    () => autoExposure(picture, wrong(undefined))
  ],
  ...(
    [
      [{ compensation: NaN }, 'compensation must be a finite number, got NaN'],
      [{ limits: [0, 1] }, 'limits[0] must be in [1e-9, 1000000000000], got 0'],
      [{ limits: wrong(1) }, 'limits must be an array of 2 numbers, got 1'],
      [{ percentiles: [0.6, 0.4] }, 'percentiles must rise, got [0.6, 0.4]'],
      [{ percentiles: [0, 1.1] }, 'percentiles[1] must be in [0, 1], got 1.1'],
      [{ highlightPriority: 1.1 }, 'highlightPriority must be in [0, 1], got 1.1'],
      [{ centerWeight: -1 }, 'centerWeight must be in [0, 1], got -1'],
      [{ lightSeconds: -1 }, 'lightSeconds must be finite and ≥ 0, got -1'],
      [{ darkSeconds: Infinity }, 'darkSeconds must be finite and ≥ 0, got Infinity'],
      [{ darkNights: wrong(1) }, 'darkNights must be true or false, got 1'],
      [{ purkinjeShift: 1.5 }, 'purkinjeShift must be in [0, 1], got 1.5']
    ] satisfies [AutoExposureOptions, string][]
  ).map(
    ([options, message]) =>
      [`AutoExposureNode: ${message}`, () => autoExposure(picture, atmosphere, options)] as [
        string,
        () => unknown
      ]
  ),
  [
    'AutoExposureNode.adapt: deltaSeconds must be finite and ≥ 0, got NaN',
    () => metered.adapt(NaN)
  ],
  ['DayCycle: time must be a date in milliseconds, got null', () => (cycle.time = wrong(null))],
  ['DayCycle: hour must be in [0, 24), got null', () => (cycle.hour = wrong(null))],
  ['DayCycle: latitude must be in [-90, 90], got NaN', () => (cycle.latitude = NaN)],
  ["DayCycle: daylight must be in (0, 1), got '0.5'", () => (cycle.daylight = wrong('0.5'))],
  ['DayCycle: paused must be true or false, got 1', () => (cycle.paused = wrong(1))],
  ["DayCycle: holdDay must be true or false, got 'no'", () => (cycle.holdDay = wrong('no'))],
  [
    'DayCycle: holdDay must be true or false, got null',
    () => new DayCycle(atmosphere, { holdDay: wrong(null) })
  ],
  ["DayCycle: unknown option 'hour', there are rate,", () => cycle.set(wrong({ hour: 3 }))],
  [
    "DayCycle: date must be a valid Date, got '2026'",
    () => new DayCycle(atmosphere, { date: wrong('2026') })
  ]
])
