import {
  MoonDirectionalLight,
  SkyLightProbe,
  aerialPerspective,
  aerialPerspectiveFog,
  airglow,
  airStyle,
  CascadedShadowNode,
  cascadedShadow,
  distanceFog,
  droplets,
  forwardShafts,
  heightFieldShadow,
  heightFog,
  iceCrystals,
  lightShafts,
  milkyWay,
  moon,
  planetGround,
  precipitationOverlay,
  PrecipitationShelter,
  raindrops,
  rainfall,
  skyBackground,
  skyEnvironment,
  snowfall,
  stars,
  sunFlare,
  surfaceLighting,
  SurfaceWater,
  wetSurface
} from '@welkin/atmosphere'
import type { LightShafts, SkyLayer } from '@welkin/atmosphere'
import {
  cloudAirShadow,
  cloudPreset,
  clouds,
  cloudShadow,
  cloudSkyLight,
  cloudWorldMap,
  DropletLightTable,
  lightning,
  precipitationShafts
} from '@welkin/clouds'
import { Matrix4, PointLight } from 'three'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { ao } from 'three/addons/tsl/display/GTAONode.js'
import { builtinAOContext, pass, screenUV, shadow } from 'three/tsl'
import { NodeMaterial, RenderPipeline, type Node } from 'three/webgpu'
import { readFileSync } from 'node:fs'
import { expect, it } from 'vitest'
import {
  inLit,
  inPass,
  inPasses,
  LIT,
  mostTextures,
  picture,
  pipelinesIn,
  stated,
  texturesOf,
  withLayers,
  World
} from '../harness/sampledTextures'
import type { BuiltPipeline } from '../headless/traceShaders'

it('features of the atmosphere sample as many textures as its README says', async () => {
  // Besides the pass itself: its colour, its depth and the air; and in the material three's own table.
  const [inSky, inMaterial] = await withLayers(() => [])
  expect([inSky, inMaterial]).toEqual([3, 2])
  expect(stated('atmosphere', 'Air, sun and sky light')).toEqual(['1', '1'])
  expect(stated('atmosphere', '`aerialPerspective`')).toEqual(['2', '0'])
  expect(stated('atmosphere', "three's `MeshStandardMaterial`")).toEqual(['–', '1'])
  const rows: [string, () => SkyLayer[]][] = [
    ['`moon`', () => [moon()]],
    ['`stars`', () => [stars()]],
    ['`milkyWay`', () => [milkyWay()]],
    ['`planetGround`', () => [planetGround({ surface: picture() })]],
    ['`heightFog` without', () => [heightFog()]],
    ['`heightFog` with', () => [heightFog({ droplets: droplets() })]],
    ['`sunFlare`', () => [sunFlare(), airglow(), distanceFog(), planetGround(), airStyle()]]
  ]
  for (const [feature, layers] of rows) {
    const [sky, lit] = await withLayers(layers)
    const found = [feature, `${sky - inSky}`, `${lit - inMaterial}`]
    expect(found).toEqual([feature, ...stated('atmosphere', feature)])
  }
  const environment = await inLit(({ scene, atmosphere }) => {
    scene.environmentNode = skyEnvironment(atmosphere)
  })
  expect(['–', `${environment - inMaterial}`]).toEqual(stated('atmosphere', '`skyEnvironment`'))
  const shadows = await inLit(({ sun }) => {
    sun.castShadow = true
  })
  expect(['–', `${shadows - inMaterial}`]).toEqual(stated('atmosphere', 'Each shadow map'))
  const cascades = await inLit(({ sun }) => {
    sun.castShadow = true
    Object.assign(sun.shadow, { shadowNode: cascadedShadow(sun, { cascades: 5, maxFar: 100 }) })
  })
  expect(['–', `${cascades - inMaterial}`]).toEqual(stated('atmosphere', '`cascadedShadow`'))
})

/** Textures of a lit material with six maps, environment, moonlight, shadows of clouds, light shafts and four cascades. */
const withSixMaps = (
  cascades: new (...given: ConstructorParameters<typeof CascadedShadowNode>) => Node,
  hasOcclusion: boolean
): Promise<number> =>
  texturesOf(LIT, renderer => {
    const world = new World()
    const { atmosphere, camera, scene, sun, sky, material } = world
    for (const slot of ['map', 'normalMap', 'roughnessMap', 'metalnessMap', 'aoMap', 'emissiveMap'])
      Object.assign(material, { [slot]: picture() })
    const luna = moon()
    atmosphere.add(luna)
    const moonlight = new MoonDirectionalLight(atmosphere, luna, 50)
    scene.add(moonlight, new SkyLightProbe(atmosphere, luna.source))
    scene.environmentNode = skyEnvironment(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
    sun.castShadow = moonlight.castShadow = true
    const node = world.clouds()
    const four = new cascades(sun, { cascades: 4, maxFar: 100 })
    Object.assign(sun.shadow, { shadowNode: cloudShadow(node, four) })
    const moonShadow = cloudShadow(node, shadow(moonlight), luna.source)
    Object.assign(moonlight.shadow, { shadowNode: moonShadow })
    cloudSkyLight(sky, node)
    atmosphere.add(forwardShafts(atmosphere, camera, sun).add(cloudAirShadow(node)))
    const scenePass = pass(scene, camera, { samples: 0 })
    if (hasOcclusion) {
      const before = pass(scene, camera, { samples: 0 })
      before.overrideMaterial = new NodeMaterial()
      const occlusion = ao(before.getTextureNode('depth'), before.getTextureNode(), camera)
      scenePass.contextNode = builtinAOContext(occlusion.getTextureNode().sample(screenUV).r)
    }
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputNode = scenePass
    return () => pipeline.render()
  })

it('a lit material with six maps has all light at once, and room for ambient occlusion in one map of cascades', async () => {
  expect(await withSixMaps(CSMShadowNode, false)).toBe(16)
  const [without, occluded] = [false, true].map(has => withSixMaps(CascadedShadowNode, has))
  expect(await without).toBe(13)
  expect(`${(await occluded) - (await without)}`).toBe(stated('atmosphere', "three's GTAO")[1])
  const text = readFileSync(new URL('../../packages/atmosphere/README.md', import.meta.url), 'utf8')
  expect(text).toContain('has room for two')
  expect(16 - (await occluded)).toBe(2)
})

it('light of surfaces and shafts sample as many textures as the README says', async () => {
  const air = await inPass(world => world.air)
  const lit = await inPass(({ atmosphere, camera, color, depth, sun, sky }) => {
    const surfaces = surfaceLighting(color, depth, camera, [sun, sky])
    return aerialPerspective(surfaces, depth, camera, atmosphere)
  })
  expect(`${lit - air}`).toBe(stated('atmosphere', '`surfaceLighting`')[0])
  const withShafts = (hasHills: boolean): Promise<number> =>
    inPass(({ atmosphere, camera, color, depth, sun }) => {
      sun.castShadow = true
      const shafts = lightShafts(atmosphere, camera, sun)
      if (hasHills) shafts.add(heightFieldShadow(picture(), new Matrix4()))
      return aerialPerspective(color, depth, camera, atmosphere, { shafts })
    })
  const shaded = await withShafts(false)
  expect(`${shaded - air}`).toBe(stated('atmosphere', '`lightShafts`')[0])
  expect(`${(await withShafts(true)) - shaded}`).toBe(
    stated('atmosphere', '`heightFieldShadow`')[0]
  )
  const forward = (casters: number, isLit: boolean): Promise<number> =>
    texturesOf(isLit ? LIT : 'Background.material', renderer => {
      const { atmosphere, camera, scene, sun } = new World()
      scene.fogNode = aerialPerspectiveFog(atmosphere)
      scene.backgroundNode = skyBackground(atmosphere)
      sun.castShadow = true
      if (casters > 0) atmosphere.add(forwardShafts(atmosphere, camera, sun))
      const { layers } = atmosphere
      if (casters > 1) (layers[0] as LightShafts).add(heightFieldShadow(picture(), new Matrix4()))
      return () => renderer.render(scene, camera)
    })
  for (const isLit of [false, true]) {
    const [none, shafts, all] = await Promise.all([0, 1, 2].map(casters => forward(casters, isLit)))
    const column = isLit ? 1 : 0
    expect(`${shafts - none}`).toBe(stated('atmosphere', '`lightShafts`')[column])
    expect(`${all - shafts}`).toBe(stated('atmosphere', '`heightFieldShadow`')[column])
  }
})

it('features of the clouds sample as many textures as their README says', async () => {
  const air = await inPass(world => world.air)
  const lit = await inLit(() => undefined)
  const withClouds = await inPass(world => world.clouds())
  expect([`${withClouds - air}`, '0']).toEqual(stated('clouds', '`clouds`'))
  const shafted = await inPass(world => {
    const { atmosphere, camera, sun } = world
    sun.castShadow = true
    const node = world.clouds()
    lightShafts(atmosphere, camera, sun).add(cloudAirShadow(node))
    return node
  })
  expect(`${shafted - withClouds}`).toBe(stated('clouds', '`lightShafts` that clouds')[0])
  // Clouds keep what materials read of the shafts beside their shadows.
  const forward = (hasShafts: boolean): Promise<number> =>
    inLit(world => {
      const { atmosphere, camera, scene, sun } = world
      scene.fogNode = aerialPerspectiveFog(atmosphere)
      sun.castShadow = true
      const node = world.clouds()
      Object.assign(sun.shadow, { shadowNode: cloudShadow(node, shadow(sun)) })
      const occluder = cloudAirShadow(node)
      const shafts = forwardShafts(atmosphere, camera, sun).add(occluder)
      const { target } = node.shadows
      expect(target.height).toBe(256)
      if (!hasShafts) return
      atmosphere.add(shafts)
      const { height } = target
      expect(height).toBeGreaterThan(256)
      shafts.remove(occluder).add(occluder)
      expect(target.height, 'room that was left').toBe(height)
    })
  expect((await forward(true)) - (await forward(false))).toBe(0)
  expect(stated('clouds', '`lightShafts` that clouds')[1]).toMatch(/^0 with `cloudShadow`/)
  for (const worldMap of [null, picture()]) {
    const shaded = await inLit(world => {
      const { sun } = world
      sun.castShadow = true
      const shadowNode = cloudShadow(world.clouds(worldMap), shadow(sun))
      Object.assign(sun.shadow, { shadowNode })
    })
    // The shadow map is one more.
    const feature = worldMap === null ? '`cloudShadow`' : '`cloudShadow`, with a `worldMap`'
    expect(['–', `${shaded - lit - 1}`]).toEqual(stated('clouds', `${feature} |`))
  }
  const passesOfClouds = ['Welkin.CloudsMarch', 'Welkin.CloudsShade']
  expect(await inPasses(passesOfClouds, world => world.clouds(picture()))).toEqual([8, 11])
  const rainy = await inPass(({ air, depth, camera, atmosphere }) => {
    const light = new DropletLightTable({ crystals: iceCrystals() })
    const precipitation = precipitationShafts({ drops: raindrops() })
    const options = { light, precipitation, worldMap: cloudWorldMap(picture()) }
    return clouds(air, depth, camera, atmosphere, cloudPreset('shower'), options)
  }, 'Welkin.CloudsShade')
  // What falls is laid over that light by passes of its own.
  expect(rainy).toBe(13)
  // Casters in sunlight and in moonlight, one with textures of its own, add none: they have a pass of their own, with room for others.
  const castPasses = ['Welkin.CloudsShade', 'Welkin.CloudsCast']
  const cast = await inPasses(castPasses, ({ air, depth, camera, atmosphere, sun }) => {
    const light = new DropletLightTable({ crystals: iceCrystals() })
    const precipitation = precipitationShafts({ drops: raindrops() })
    const options = { light, precipitation, worldMap: cloudWorldMap(picture()) }
    const luna = moon()
    atmosphere.add(luna)
    const node = clouds(air, depth, camera, atmosphere, cloudPreset('shower'), options)
    for (const each of [sun, new MoonDirectionalLight(atmosphere, luna)]) {
      each.castShadow = true
      const hills = heightFieldShadow(picture(), new Matrix4())
      lightShafts(atmosphere, camera, each).add(cloudAirShadow(node), hills)
    }
    return node
  })
  expect(cast).toEqual([rainy, 10])
  const flashing = await inPass(world => {
    const node = world.clouds()
    lightning(node)
    return node
  })
  expect([`${flashing - withClouds}`, '0']).toEqual(stated('clouds', '`lightning`'))
  const dimmed = await inLit(world => {
    cloudSkyLight(world.sky, world.clouds())
  })
  expect(['–', `${dimmed - lit}`]).toEqual(stated('clouds', '`cloudSkyLight`'))
})

it('near rain and wet ground sample as many textures as the README says', async () => {
  const air = await inPass(world => world.air)
  /** Textures of drops or flakes under sun, sky and lamps, and a roof. */
  const falling = (make: typeof rainfall, name: string, hasShelter: boolean): Promise<number> =>
    texturesOf(name, renderer => {
      const { atmosphere, camera, scene, sun, sky } = new World()
      const shelter = hasShelter ? new PrecipitationShelter(scene) : undefined
      scene.add(make(atmosphere, { rate: 5, lights: [sun, sky, new PointLight()], shelter }))
      return () => renderer.render(scene, camera)
    })
  const near = await Promise.all(
    [false, true].flatMap(hasShelter => [
      falling(rainfall, 'Welkin.Rainfall', hasShelter),
      falling(snowfall, 'Welkin.Snowfall', hasShelter)
    ])
  )
  expect(near).toEqual([0, 0, 0, 0])
  expect(stated('atmosphere', '`rainfall`')).toEqual(['0', '–'])
  const over = await inPass(({ air, atmosphere, camera, depth, sun, sky }) => {
    const rain = rainfall(atmosphere, { rate: 5, lights: [sun, sky], depth, depthCamera: camera })
    return precipitationOverlay(air, camera, [rain])
  })
  expect([`${over - air}`, '–']).toEqual(stated('atmosphere', '`precipitationOverlay`'))
  const lit = await inLit(() => undefined)
  const wet = await inLit(({ material }) => {
    const water = new SurfaceWater()
    water.water = 1
    Object.assign(material, wetSurface(water))
  })
  expect(['–', `${wet - lit}`]).toEqual(stated('atmosphere', '`wetSurface`'))
})

/** Look-ups of textures in a shader's `main`, by the conditions and loops that they stand in, outermost first. */
function readsOf(source: string): string[] {
  const around: string[] = []
  const reads: string[] = []
  for (const line of source.slice(source.indexOf('void main')).split('\n')) {
    if (line.includes('}')) around.pop()
    if (line.includes('{')) around.push(line.trim())
    const [, name] = /texture\w*\( (\w+),/.exec(line) ?? []
    if (name !== undefined) reads.push([...around.slice(1), name].join(' '))
  }
  return reads
}

it('a bow costs nothing where none is: it is looked up once, on rays that have met rain', async () => {
  const names = ['Welkin.CloudsShade', 'Welkin.CloudsFall', 'Welkin.CloudsMarch']
  const [[textures, smooth], [bowedTextures, bowed]] = await Promise.all(
    [undefined, raindrops()].map(async drops => {
      const built = await pipelinesIn(names, renderer => {
        const { air, depth, camera, atmosphere } = new World()
        const pipeline = new RenderPipeline(renderer)
        const precipitation = precipitationShafts({ drops })
        const layers = cloudPreset('shower')
        pipeline.outputNode = clouds(air, depth, camera, atmosphere, layers, { precipitation })
        return () => pipeline.render()
      })
      const ofName = (name: string): BuiltPipeline[] => built.filter(each => each.name === name)
      const counts = names.map(name => mostTextures(ofName(name)))
      return [counts, readsOf(ofName('Welkin.CloudsFall')[0].source)] as const
    })
  )
  // The pass of what falls alone reads the table of bows.
  expect(bowedTextures).toEqual([textures[0], textures[1] + 1, textures[2]])
  expect(bowed.length).toBe(smooth.length + 1)
  const namesIn = (reads: readonly string[]): (string | undefined)[] =>
    reads.map(read => read.split(' ').at(-1))
  const phase = bowed.filter((_, i) => {
    const name = namesIn(bowed)[i]
    return namesIn(bowed).filter(each => each === name).length === 1
  })
  // Not in the march's loop, and behind the condition that something was met.
  const added = phase.filter(read => /^if \( \( \w+\.x > 0\.0001 \) \) \{ \w+$/.test(read))
  expect(added).toHaveLength(1)
})

it('a shader that samples too many textures throws in drawing, and says what samples them', async () => {
  const [surface, water, nightLights] = [picture(), picture(), picture()]
  const comet = (): SkyLayer => planetGround({ surface: picture() })
  await expect(
    inPass(({ atmosphere, air }) => {
      atmosphere.add(stars(), moon(), planetGround({ surface, water, nightLights }))
      for (let i = 0; i < 8; i++) atmosphere.add(comet())
      return air
    })
  ).rejects.toThrow(
    'Atmosphere: RenderPipeline must sample at most 16 textures, leave out some of: PlanetGround 11, Stars 2, '
  )
})
