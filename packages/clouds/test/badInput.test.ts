import { Atmosphere, heightFog, SkyLightProbe } from '@welkin/atmosphere'
import { Data3DTexture, Mesh, PerspectiveCamera, Scene, Texture } from 'three'
import { float, vec4 } from 'three/tsl'
import { describe, expect, it } from 'vitest'
import {
  CloudCover,
  CloudLayer,
  CloudLayers,
  CloudLightTable,
  CloudNoise,
  cloudAirShadow,
  cloudEnvironment,
  cloudLayersFromMETAR,
  DropletLightTable,
  cloudPreset,
  clouds,
  cloudsDebug,
  CloudField,
  cloudShadow,
  cloudFogLight,
  cloudSkyLight,
  cloudWorldMap,
  noiseVolume
} from '@welkin/clouds'

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const layers = new CloudLayers()

/** Value of a type that the compiler would not let pass. */
const wrong = (value: unknown): never => value as never

const make = (options = {}, given = layers) =>
  clouds(vec4(0), float(1), camera, atmosphere, given, options)
const node = make()
const probe = new SkyLightProbe(atmosphere)
const layer = layers.at(0)

const cases: [message: string, call: () => unknown][] = [
  // No such option.
  ['CloudsNode: ambient must be finite and ≥ 0, got -1', () => make({ ambient: -1 })],
  ["CloudsNode: unknown option 'qualty', did you mean 'quality'?", () => make({ qualty: 'low' })],
  [
    "CloudsNode.quality: unknown option 'step', did you mean 'steps'?",
    () => make({ quality: { step: 3 } })
  ],
  [
    "CloudCover: unknown option 'ligt', did you mean 'light'?",
    () => new CloudCover(layers, wrong({ ligt: node.light }))
  ],
  ['CloudCover: layers must be CloudLayers, got a CloudsNode', () => new CloudCover(wrong(node))],
  [
    'CloudCover: light must be a CloudLightTable, got 3',
    () => new CloudCover(layers, { light: wrong(3) })
  ],
  [
    "CloudEnvironment: unknown option 'drft', did you mean 'drift'?",
    () => cloudEnvironment(node, wrong({ drft: 1 }))
  ],
  [
    "CloudField: unknown option 'worldmap', did you mean 'worldMap'?",
    () => new CloudField(atmosphere, layers, undefined, wrong({ worldmap: null }))
  ],
  [
    "CloudLayer: unknown option 'covrage', did you mean 'coverage'?",
    () => new CloudLayer(wrong({ covrage: 1 }))
  ],
  [
    "CloudLayer: unknown option 'base', there are baseAltitude",
    () => layer.set(wrong({ base: 1 }))
  ],
  [
    "CloudLayer.wind: unknown option 'est', did you mean 'east'?",
    () => (layer.wind = wrong({ est: 1, north: 0 }))
  ],
  [
    "cloudLayersFromMETAR: unknown option 'stationElevaton', did you mean 'stationElevation'?",
    () => cloudLayersFromMETAR('CAVOK', wrong({ stationElevaton: 0 }))
  ],
  [
    "DropletLightTable: unknown option 'radius', there are dropletRadius, crystals",
    () => new DropletLightTable(wrong({ radius: 8 }))
  ],
  [
    'DropletLightTable: dropletRadius must be in [3, 30], got 31',
    () => new DropletLightTable({ dropletRadius: 31 })
  ],
  [
    'DropletLightTable: crystals must be a ScatteringPhase or null, got true',
    () => new DropletLightTable({ crystals: wrong(true) })
  ],
  [
    "DropletLightTable: unknown option 'forwardShare', there are dropletRadius",
    () => (new DropletLightTable().forwardShare = 0.5)
  ],
  [
    'CloudLightTable: dropletRadius needs a DropletLightTable',
    () => new CloudLightTable().set(wrong({ dropletRadius: 8 }))
  ],
  [
    "CloudLightTable: unknown option 'forwardAsymetry', did you mean 'forwardAsymmetry'?",
    () => new CloudLightTable(wrong({ forwardAsymetry: 0 }))
  ],

  // One thing for another.
  [
    'cloudLayersFromMETAR: report must be a string, got undefined',
    () => cloudLayersFromMETAR(wrong(undefined))
  ],
  ["cloudLayersFromMETAR: report must be a METAR, got 'fine'", () => cloudLayersFromMETAR('fine')],
  [
    'cloudLayersFromMETAR: stationElevation must be in [-500, 9000], got NaN',
    () => cloudLayersFromMETAR('CAVOK', { stationElevation: NaN })
  ],
  ['CloudsNode: layers must be CloudLayers, got a CloudLayer', () => make({}, wrong(layer))],
  [
    'CloudsNode: layers must be CloudLayers, got undefined',
    () => clouds(vec4(0), float(1), camera, atmosphere, wrong(undefined))
  ],
  [
    'CloudsNode: atmosphere must be an Atmosphere, got a CloudLayers',
    () => clouds(vec4(0), float(1), camera, wrong(layers), wrong(atmosphere))
  ],
  [
    'CloudsNode: colorNode must be a node, got a Scene',
    () => clouds(wrong(new Scene()), float(1), camera, atmosphere, layers)
  ],
  [
    'CloudsNode: worldMap must be a CloudWorldMap or null, got a Texture',
    () => make({ worldMap: new Texture() })
  ],
  ['CloudWorldMap: texture must be a Texture, got a Mesh', () => cloudWorldMap(wrong(new Mesh()))],
  [
    'CloudWorldMap: texture.wrapS must be RepeatWrapping, got 1001',
    () => cloudWorldMap(new Texture())
  ],
  [
    'CloudWorldMap: bounds.north must be in [-90, 90], got 91',
    () => cloudWorldMap(new Texture(), { bounds: { west: 0, south: 0, east: 1, north: 91 } })
  ],
  [
    'CloudWorldMap: bounds.north must be greater than bounds.south, got { west: 0, south: 5, east: 1, north: 5 }',
    () => cloudWorldMap(new Texture(), { bounds: { west: 0, south: 5, east: 1, north: 5 } })
  ],
  [
    "CloudWorldMap: unknown option 'perlayer', did you mean 'perLayer'?",
    () => cloudWorldMap(new Texture(), wrong({ perlayer: true }))
  ],
  [
    'CloudNoise: shape must be a function, got a Texture',
    () => new CloudNoise({ shape: wrong(new Texture()) })
  ],
  [
    'noiseVolume: volume.wrapS must be RepeatWrapping, got 1001',
    () => noiseVolume(new Data3DTexture())
  ],
  [
    'noiseVolume: volume must be a Data3DTexture, got a Texture',
    () => noiseVolume(wrong(new Texture()))
  ],
  ['CloudsNode: noise must be a CloudNoise, got {}', () => make({ noise: {} })],
  ["CloudsNode: light must be a CloudLightTable, got 'sun'", () => make({ light: 'sun' })],
  ['CloudsNode: accumulates must be true or false, got 0', () => (node.accumulates = wrong(0))],
  ["CloudsNode: unknown option 'noise', there are", () => node.set(wrong({ noise: null }))],
  [
    "CloudsNode: quality must be 'low', 'medium', 'high' or 'ultra', got 'best'",
    () => make({ quality: 'best' })
  ],
  [
    "CloudEnvironment: quality must be 'low', 'medium', 'high' or 'ultra', got 'best'",
    () => cloudEnvironment(node, { quality: wrong('best') })
  ],
  [
    'CloudEnvironment: drift must be positive and finite, got 0',
    () => cloudEnvironment(node, { drift: 0 })
  ],
  [
    'CloudEnvironment: clouds must be a CloudsNode, got an Atmosphere',
    () => cloudEnvironment(wrong(atmosphere))
  ],
  [
    "cloudPreset: name must be 'fairWeather', 'congestus', 'stratocumulus', 'overcast', 'cumulonimbus', 'altocumulus', 'cirrus', 'mixed', 'shower', 'nimbostratus', 'snowShower', 'hailstorm' or 'fog', got 'fair'",
    () => cloudPreset(wrong('fair'))
  ],
  ['CloudLayer: options must be an object such as {', () => new CloudLayer(wrong(layer))],
  [
    'CloudShadowNode: clouds must be a CloudsNode, got an Atmosphere',
    () => cloudShadow(wrong(atmosphere))
  ],
  [
    'CloudShadowNode: shadowNode must be a node or null, got a Mesh',
    () => cloudShadow(node, wrong(new Mesh()))
  ],
  ['CloudLayers: layers must be an array, got a CloudLayer', () => new CloudLayers(wrong(layer))],
  [
    'CloudLayers.copy: other must be CloudLayers, got a CloudLayer',
    () => new CloudLayers().copy(wrong(layer))
  ],
  ["cloudPreset: count must be 0 to 4, got '3'", () => cloudPreset('mixed', wrong('3'))],
  [
    'cloudLayersFromMETAR: count must be 0 to 4, got 5',
    () => cloudLayersFromMETAR('LFPG 221200Z CAVOK', { count: 5 })
  ],
  [
    "CloudsNode: camera must be a PerspectiveCamera, got 'camera'",
    () => clouds(vec4(0), float(1), wrong('camera'), atmosphere, cloudPreset('mixed'))
  ],
  [
    'CloudAirShadow: clouds must be a CloudsNode, got an Atmosphere',
    () => cloudAirShadow(wrong(atmosphere))
  ],
  [
    'CloudsDebugNode: clouds must be a CloudsNode, got an Atmosphere',
    () => cloudsDebug(wrong(atmosphere), 'steps')
  ],
  [
    'CloudSkyLight: probe must be a SkyLightProbe or NightLightProbe, got a CloudsNode',
    () => cloudSkyLight(wrong(node), wrong(probe))
  ],
  [
    'CloudSkyLight: probe must have no other CloudSkyLight: dispose of that first, got a SkyLightProbe',
    () => {
      const lit = new SkyLightProbe(atmosphere)
      cloudSkyLight(lit, node)
      return cloudSkyLight(lit, node)
    }
  ],
  [
    'CloudFogLight: fog must be a HeightFog or DistanceFog, got a CloudsNode',
    () => cloudFogLight(wrong(node), node)
  ],
  [
    'CloudFogLight: fog must have no other CloudFogLight: dispose of that first, got a HeightFog',
    () => {
      const fog = heightFog()
      cloudFogLight(fog, node)
      return cloudFogLight(fog, node)
    }
  ],

  // Setters.
  ['CloudLayer: coverage must be in [0, 1], got 7', () => (layer.coverage = 7)],
  ['CloudLayer: weatherScale must be in [0.1, 10], got 0', () => (layer.weatherScale = 0)],
  ['CloudLayer: shapeScale must be in [0.1, 10], got 12', () => (layer.shapeScale = 12)],
  ['CloudLayer: detailScale must be in [0.1, 10], got -1', () => (layer.detailScale = -1)],
  ['CloudLayer: edgeSoftness must be in [0, 1], got 2', () => (layer.edgeSoftness = 2)],
  ['CloudLayer: turbulence must be in [0, 2], got 3', () => (layer.turbulence = 3)],
  ['CloudLayer: shear must be in [-5, 5], got -6', () => (layer.shear = -6)],
  ['CloudLayer: anvil must be in [0, 1], got NaN', () => (layer.anvil = NaN)],
  ["CloudLayer: openCells must be in [0, 1], got '1'", () => (layer.openCells = wrong('1'))],
  ['CloudLayer: densityGrowth must be in [0, 4], got 4.5', () => (layer.densityGrowth = 4.5)],
  [
    'CloudLayer: topAltitude must be above baseAltitude (1000 m), got 900',
    () => (layer.topAltitude = 900)
  ],
  ["CloudLayer: shadow must be true or false, got 'no'", () => (layer.shadow = wrong('no'))],
  [
    'CloudLightTable: forwardShare must be in [0, 1], got 2',
    () => (new CloudLightTable().forwardShare = 2)
  ]
]

describe('wrong use throws with name and value', () => {
  it.each(cases)('%s', (message, call) => {
    expect(call).toThrow(message)
  })
})

describe('settings are properties', () => {
  it('of layers', () => {
    const changed = new CloudLayer({ coverage: 0.5 })
    expect(changed.coverage).toBe(0.5)
    const before = changed.parameters
    changed.coverage = 0.7
    changed.wind = { east: 1, north: 2 }
    expect(changed.parameters).toEqual({ ...before, coverage: 0.7, wind: { east: 1, north: 2 } })
    // Those of another one stay.
    expect(new CloudLayer().coverage).toBe(0.35)
    expect(() => (changed.coverage = 7)).toThrow('coverage')
    expect(changed.set({ coverage: undefined }).coverage).toBe(0.7)
  })

  it('of the light table', () => {
    const table = new CloudLightTable()
    table.forwardAsymmetry = 0.7
    expect([table.phase.forwardAsymmetry, table.forwardAsymmetry, table.forwardShare]).toEqual([
      0.7, 0.7, 0.8
    ])
  })

  it('of a light table of droplets, whose lobes follow', () => {
    const table = new DropletLightTable({ dropletRadius: 5, scatteringAlbedo: 0.9 })
    table.bake()
    const { forwardAsymmetry, forwardShare, backwardAsymmetry } = table
    // The asymmetry of droplets of 5 µm.
    const asymmetry = forwardShare * forwardAsymmetry + (1 - forwardShare) * backwardAsymmetry
    expect(asymmetry).toBeCloseTo(0.85, 2)
    expect(table.scatteringAlbedo).toBe(0.9)
    table.set({ dropletRadius: 20 })
    expect([table.dropletRadius, table.scatteringAlbedo]).toEqual([20, 0.9])
    expect(table.isDirty).toBe(true)
    table.bake()
    expect(table.isDirty).toBe(false)
    expect(table.forwardAsymmetry).toBeGreaterThan(forwardAsymmetry)
    table.dispose()
  })

  it('free a probe for other clouds', () => {
    const lit = new SkyLightProbe(atmosphere)
    cloudSkyLight(lit, node).dispose()
    expect(cloudSkyLight(lit, node).probe).toBe(lit)
  })
})
