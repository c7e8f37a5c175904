import { raindrops } from '@welkin/atmosphere'
import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import {
  cloudLayersFromMETAR,
  cloudPreset,
  visibilityFromMETAR,
  type CloudLayerParameters
} from '../../src'
import { snowShareOf } from '../twins/precipitation'

const read = (report: string, options = {}): CloudLayerParameters[] =>
  [...cloudLayersFromMETAR(report, options)].map(({ parameters }) => parameters)

/** Amounts in eighths and bases in hundreds of feet, as a report has them. */
const groupsOf = (report: string): [number, number][] =>
  read(report).map(({ coverage, baseAltitude }) => [8 * coverage, Math.round(baseAltitude / 30.48)])

const clear: [number, number][] = [[0, 33]]

const reports: [report: string, groups: [number, number][]][] = [
  [
    'EDDM 221150Z 24008KT 9999 FEW018 SCT035TCU BKN080 10/04 Q1015',
    [
      [1.5, 18],
      [3.5, 35],
      [6, 80]
    ]
  ],
  ['METAR EGLL 221150Z AUTO 21010KT 9999 OVC009 12/10 Q1009 NOSIG=', [[8, 9]]],
  [
    'KSFO 221156Z 28014G22KT 10SM FEW008 SCT200 BKN250 14/10 A2997 RMK AO2 SLP148 T01390100 OVC003',
    [
      [1.5, 8],
      [3.5, 200],
      [6, 250]
    ]
  ],
  ['METAR KJFK 221151Z COR 00000KT 10SM CLR 10/04 A3012', clear],
  ['LFPG 221200Z VRB02KT CAVOK 21/09 Q1023 NOSIG', clear],
  ['ENGM 221150Z 01005KT 9999 NSC M02/M08 Q1031', clear],
  ['EHAM 221155Z AUTO 24008KT 9999 NCD 10/04 Q1015', clear],
  ['KXYZ 221156Z AUTO 24008KT 10SM 10/04 A2990 RMK AO2 CHINO', clear],
  [
    'LFBO 221130Z AUTO 14012KT 9999 FEW030/// BKN045TCU //////CB 18/12 Q1012 TEMPO 30025G45KT BKN012CB',
    [
      [1.5, 30],
      [6, 45],
      [3.5, 30]
    ]
  ],
  ['EGPC 221150Z AUTO /////KT //// // ////// 10/04 Q1015', clear],
  [
    'LSZS 221150Z VRB01KT 9999 SCT/// ///120 02/M04 Q1021',
    [
      [3.5, 30],
      [3.5, 120]
    ]
  ],
  ['UUEE 221130Z 19004MPS 0150 R24C/0400N FG VV002 M01/M01 Q1024 R24C/290050 NOSIG', [[8, 0]]],
  [
    'SCTE 221200Z 35012KT 9000 -RA SCT008 BKN020 OVC060 11/10 Q1008',
    [
      [3.5, 8],
      [6, 20],
      [8, 60]
    ]
  ],
  ['VNKT 221150Z 25006KT 6000 FEW015 20/12 Q1016', [[1.5, 15]]],
  [
    'feW018\n sct035tcu',
    [
      [1.5, 18],
      [3.5, 35]
    ]
  ]
]

const malformed = [
  'SCT35',
  'SCT0355',
  'BKN80CB',
  'OVC',
  'FEW018CBX',
  'FEW999',
  'VV2',
  'OVCO30',
  '24008GKT',
  '999999KT',
  '36508KT',
  '240/08KT',
  'VRBKT',
  'NIL'
]

describe('cloudLayersFromMETAR', () => {
  it.for(reports)('reads %s', ([report, groups]) => {
    expect(groupsOf(report)).toEqual(groups)
  })

  it.for(malformed)('refuses %s', group => {
    expect(() => read(`EDDM 221150Z 9999 ${group} 10/04 Q1015`)).toThrow(
      new RegExp(`^cloudLayersFromMETAR: (clouds|wind) must be like .*, got '${group}'$`)
    )
  })

  it('refuses what is no report', () => {
    for (const report of ['', 'overcast', 'EDDM']) {
      expect(() => read(report)).toThrow(/^cloudLayersFromMETAR: report must .*, got '/)
    }
  })

  it('makes clouds of their height and amount what they are in the presets', () => {
    const [cumulus, altocumulus, cirrus] = cloudPreset('mixed')
    const found = read('EDDM 221150Z FEW040 BKN100 SCT250')
    for (const [i, { weatherWeights, density, profileExponent }] of [
      cumulus,
      altocumulus,
      cirrus
    ].entries()) {
      expect(found[i]).toMatchObject({ weatherWeights, density, profileExponent })
    }
    const [deck] = read('EDDM 221150Z BKN030')
    expect(deck.weatherWeights).toEqual(cloudPreset('stratocumulus').at(0).weatherWeights)
    const [grey] = read('EDDM 221150Z OVC030')
    expect(grey.shapeAmount).toBe(cloudPreset('overcast').at(0).shapeAmount)
  })

  it('makes TCU and CB tall', () => {
    const [cumulus, towering, storm] = read('EDDM 221150Z FEW030 SCT030TCU BKN030CB')
    const thickness = (layer: CloudLayerParameters): number =>
      layer.topAltitude - layer.baseAltitude
    expect(thickness(towering)).toBeGreaterThan(3 * thickness(cumulus))
    expect(storm.topAltitude).toBe(11_000)
    const [high] = read('SLLP 221150Z BKN030CB', { stationElevation: 4062 })
    expect(thickness(high)).toBeGreaterThanOrEqual(6000)
  })

  it('has bases above the station, but not below the ellipsoid', () => {
    const baseOf = (report: string, stationElevation: number): number =>
      read(report, { stationElevation })[0].baseAltitude
    expect(baseOf('EDDM 221150Z FEW010', 453)).toBeCloseTo(453 + 304.8, 9)
    expect(baseOf('LLMZ 221150Z FEW010', -376)).toBe(0)
    expect(baseOf('EDDM 221150Z VV001', 453)).toBe(453)
  })

  it('moves low clouds by the wind, and others by their own', () => {
    const [low, high] = read('EDDM 221150Z 24010G25KT 9999 FEW018 SCT250')
    expect(low.wind.east).toBeCloseTo(5.144 * Math.cos(Math.PI / 6), 3)
    expect(low.wind.north).toBeCloseTo(5.144 / 2, 3)
    expect(high.wind).toEqual(cloudPreset('cirrus').at(0).wind)
    const windOf = (wind: string): unknown => read(`EDDM 221150Z ${wind} FEW018`)[0].wind
    expect(windOf('09010MPS')).toEqual({ east: -10, north: expect.closeTo(0, 9) })
    expect(windOf('36010MPS')).toEqual({ east: expect.closeTo(0, 9), north: -10 })
    expect(windOf('18010KT 140V220')).toEqual({
      east: expect.closeTo(0, 9),
      north: expect.closeTo(5.144, 3)
    })
    const own = cloudPreset('fairWeather').at(0).wind
    const unknown = [
      '/////KT',
      '///05KT',
      '240//KT',
      '///05G15KT',
      '24010G//KT',
      'VRB//KT',
      '///12MPS'
    ]
    for (const wind of ['VRB03KT', '', ...unknown.filter(each => each !== '24010G//KT')])
      expect(windOf(wind)).toEqual(own)
    expect(windOf('24010G//KT')).toEqual(windOf('24010KT'))
  })

  it('has fog in which one sees as far as the report says', () => {
    for (const [group, metres] of [
      ['VV001', 30.48],
      ['VV005', 152.4],
      ['VV000', 30.48]
    ] as const) {
      const [fog] = read(`EDDM 221150Z 0200 FG ${group} 02/02 Q1030`)
      expect(fog.density * metres).toBeCloseTo(3, 9)
      expect(fog).toMatchObject({ baseAltitude: 0, coverage: 1 })
    }
  })

  it('leaves out what covers least of more than four groups, CB and TCU last', () => {
    const report = 'KDEN 221156Z FEW008 SCT015 FEW030CB BKN050 OVC120 SCT250'
    expect(groupsOf(report)).toEqual([
      [3.5, 15],
      [1.5, 30],
      [6, 50],
      [8, 120]
    ])
  })

  it('has layers for later reports', () => {
    const layers = cloudLayersFromMETAR('LFPG 221200Z CAVOK', { count: 4 })
    expect(layers.length).toBe(4)
    layers.copy(cloudLayersFromMETAR('LFPG 221300Z FEW018 SCT035 BKN080 BKN200'))
    expect(layers.at(3).coverage).toBe(0.75)
  })

  it('gives valid layers for every group', () => {
    const group = fc
      .tuple(
        fc.constantFrom('FEW', 'SCT', 'BKN', 'OVC', 'VV', '///'),
        fc.integer({ min: 0, max: 599 }),
        fc.constantFrom('', 'CB', 'TCU', '///')
      )
      .map(([amount, base, kind]) => `${amount}${String(base).padStart(3, '0')}${kind}`)
    const elevations = fc.double({ min: -500, max: 9000, noNaN: true })
    fc.assert(
      fc.property(fc.array(group, { maxLength: 6 }), elevations, (groups, stationElevation) => {
        const layers = read(`EDDM 221150Z ${groups.join(' ')}`, { stationElevation })
        expect(layers).toHaveLength(Math.min(Math.max(groups.length, 1), 4))
      })
    )
  })
})

describe('weather of a METAR', () => {
  const falls = (report: string) =>
    read(report, { precipitation: true }).map(({ precipitation }) => precipitation)

  it('falls from storms, towers, or what covers most', () => {
    const rates = (report: string) => falls(report).map(each => each?.rate)
    expect(rates('EDDM 221150Z 24008KT 6000 -RA FEW018 OVC035 10/08 Q1015')).toEqual([
      undefined,
      1.2
    ])
    expect(rates('EDDM 221150Z 24008KT 4000 +TSRA SCT025CB BKN080 22/18 Q1008')).toEqual([
      20,
      undefined
    ])
    expect(rates('EDDM 221150Z 24008KT 8000 SHRA BKN018 SCT030TCU 12/09 Q1008')).toEqual([
      undefined,
      5
    ])
    expect(read('EDDM 221150Z 24008KT 3000 DZ BR OVC004 08/08 Q1020')[0].precipitation).toBe(null)
    expect(rates('EDDM 221150Z 24008KT 3000 DZ BR OVC004 08/08 Q1020')).toEqual([0.3])
    expect(rates('EDDM 221150Z 24008KT 9999 VCSH FEW030 10/08 Q1015')).toEqual([undefined])
    expect(rates('EDDM 221150Z 24008KT 9999 OVC030 10/08 Q1015 TEMPO 3000 RA')).toEqual([undefined])
  })

  it('is snow or rain as reported, with hail', () => {
    const [snow] = falls('ENGM 221150Z 01005KT 1500 SN OVC010 M02/M03 Q1001')
    expect(snow).toMatchObject({ rate: 2, share: 0.9, hail: 0 })
    expect(snow?.freezingLevel).toBeCloseTo(-308, 0)
    const [rain] = falls('EGLL 221150Z 21010KT 5000 +SHRAGS SCT020CB 13/10 Q0998')
    expect(rain).toMatchObject({ rate: 20, share: 0.5, hail: 0.3, freezingLevel: 2000 })
  })

  it('tells words of two letters apart', () => {
    const [hail] = falls('EGLL 221150Z 21010KT 5000 GSGR SCT020CB 13/10 Q0998')
    expect(hail).toMatchObject({ rate: 5, hail: 0.3, freezingLevel: 2000 })
  })

  it('is snow in frost where a station cannot tell, unless it freezes on the ground', () => {
    const snowOf = (weather: string, air: string): number => {
      const report = `KXYZ 221156Z AUTO 24008KT 5SM ${weather} OVC010 ${air} A2990`
      return snowShareOf(0, falls(report)[0]!.freezingLevel!)
    }
    expect(snowOf('UP', 'M05/M06')).toBe(1)
    expect(snowOf('UP', '05/04')).toBe(0)
    expect(snowOf('UP', '/////')).toBe(0)
    expect(snowOf('FZUP', 'M05/M06')).toBe(0)
    expect(snowOf('RAUP', 'M05/M06')).toBe(0)
  })

  it('is of the present: not of what a trend expects', () => {
    const report = 'YSSY 221200Z 24008KT 9999 FEW030 18/10 Q1015'
    for (const trend of ['FM1300 18015KT 3000 RA BKN010', 'FM221300 RA OVC010', 'PROB30 TSRA'])
      expect(read(`${report} ${trend}`, { precipitation: true })).toEqual(
        read(report, { precipitation: true })
      )
  })

  it('has rates that drops of rain take', () => {
    for (const weather of ['-DZ', 'DZ', '+DZ', '-RA', '+TSRA']) {
      const { rate } = falls(`EGLL 221150Z 21010KT 5000 ${weather} OVC010 13/10 Q0998`)[0]!
      const drops = raindrops({ rate })
      expect(drops.extinction).toBeCloseTo((0.33 * rate ** 0.64) / 1000, 12)
      drops.dispose()
    }
  })

  it('falls no more where the wind raises what lies, or where it fell before', () => {
    const fallsFrom = (weather: string) =>
      falls(`ENGM 221150Z 01025KT 0800 ${weather} OVC010 M05/M07 Q1001`)[0]?.rate
    expect(fallsFrom('BLSN')).toBe(undefined)
    expect(fallsFrom('DRSN')).toBe(undefined)
    expect(fallsFrom('BR RESN')).toBe(undefined)
    expect(fallsFrom('-SN BLSN')).toBe(0.5)
    expect(fallsFrom('BLSN +SN')).toBe(6)
  })

  it('is at the ground what is reported, however warm or high it is there', () => {
    const grounds = fc.record({
      temperature: fc.integer({ min: -40, max: 45 }),
      stationElevation: fc.integer({ min: 0, max: 4500 })
    })
    const snowAt = (weather: string, temperature: number, stationElevation: number): number => {
      const digits = String(Math.abs(temperature)).padStart(2, '0')
      const report = `EDDM 221150Z 24008KT 3000 ${weather} OVC020 ${temperature < 0 ? 'M' : ''}${digits}/// Q1005`
      const [layer] = read(report, { precipitation: true, stationElevation })
      return snowShareOf(stationElevation, layer.precipitation!.freezingLevel!)
    }
    fc.assert(
      fc.property(grounds, ({ temperature, stationElevation }) => {
        expect(snowAt('-SHSN', temperature, stationElevation)).toBe(1)
        expect(snowAt('FZRA', temperature, stationElevation)).toBe(0)
        expect(snowAt('+TSRAGR', temperature, stationElevation)).toBe(0)
      })
    )
  })

  it('has the visibility of mist and fog, and no layer of them', () => {
    for (const [weather, metres] of [
      ['3000 BR', 3000],
      ['0400 FG', 400]
    ] as const) {
      const report = `EGLL 221150Z 00000KT ${weather} FEW020 08/08 Q1025`
      expect(visibilityFromMETAR(report)).toBe(metres)
      expect(read(report, { precipitation: true })).toHaveLength(1)
      expect(falls(report)).toEqual([null])
    }
  })

  it.for([
    ['UUEE 221130Z 19004MPS 0150 R24C/0400N FG VV002 M01/M01 Q1024', 150],
    ['EDDM 221150Z 24008KT 9999 FEW018 10/04 Q1015', 10_000],
    ['LFPG 221200Z VRB02KT CAVOK 21/09 Q1023 NOSIG', 10_000],
    ['KSFO 221156Z 28014G22KT 10SM FEW008 14/10 A2997', 16_093],
    ['KSFO 221156Z 28014G22KT 1 1/2SM BR FEW008 14/10 A2997', 2414],
    ['KSFO 221156Z 28014G22KT M1/4SM FG VV001 14/14 A2997', 402],
    // Less than 50 m, and less than what a mile's fractions can say: never 0, by which users divide.
    ['EGLL 221150Z 00000KT 0000 FG VV/// 02/02 Q1030', 25],
    ['KDEN 221150Z 00000KT 0SM FG VV000 M02/M02 A3010', 25],
    ['EGPC 221150Z AUTO /////KT //// // ////// 10/04 Q1015', null]
  ] as const)('sees as far as %s says', ([report, metres]) => {
    const seen = visibilityFromMETAR(report)
    expect(seen === null ? null : Math.round(seen)).toBe(metres)
  })
})
