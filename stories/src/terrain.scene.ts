import {
  aerialPerspective,
  Atmosphere,
  groundShadow,
  heightFog,
  lightShafts,
  skyEnvironment,
  terrainShadow
} from '@welkin/atmosphere'
import {
  cloudAirShadow,
  cloudEnvironment,
  cloudPreset,
  clouds,
  cloudShadow,
  cloudSkyLight
} from '@welkin/clouds'
import type { CloudsNode } from '@welkin/clouds'
import { Lake, MountainHeights, Terrain, terrainView } from '@welkin/terrain'
import { PerspectiveCamera, Scene } from 'three'
import { shadow } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { Air } from './air'
import { prepareShadow } from './globe/sunShadow'
import {
  applyTime,
  createRenderer,
  type RendererArgs,
  type SceneHandle,
  type TimeArgs
} from './scene'
import { GroundCamera } from './terrain/GroundCamera'
import { GroundFinish, hasEffects } from './terrain/GroundFinish'
import { groundHandle } from './terrain/groundHandle'
import { LAKES } from './terrain/lakes'
import { addNightSky } from './terrain/NightSky'
import { Vegetation } from './terrain/vegetation/Vegetation'
import type { GroundView } from './terrain/viewAlong'
import type { PostEffects } from './valley/finish'
import { drawnOf } from './valleyAir'

export const VIEWS = {
  meadow: {
    label: 'Meadow, 2 m',
    longitude: 0.494,
    latitude: 46.35,
    height: 2,
    heading: 338,
    pitch: 6
  },
  shore: {
    label: 'Shore, 30 m',
    longitude: 1.6848,
    latitude: 46.15,
    height: 30,
    heading: 45,
    pitch: 2
  },
  lake: {
    label: 'Lake, 25 m',
    longitude: 0.5118,
    latitude: 46.563,
    height: 25,
    heading: 10,
    pitch: -4
  },
  summit: {
    label: 'Summit, 2 m',
    longitude: 0.428,
    latitude: 47.372,
    height: 2,
    heading: 200,
    pitch: -5
  },
  range: {
    label: 'Range, 8 km',
    longitude: 0.45,
    latitude: 46.9,
    height: 8000,
    heading: 0,
    pitch: -10
  },
  orbit: {
    label: 'Orbit, 400 km',
    longitude: 1,
    latitude: 43.5,
    height: 4e5,
    heading: 0,
    pitch: -25
  },
  globe: {
    label: 'Globe, 20,000 km',
    longitude: 1,
    latitude: 30,
    height: 2e7,
    heading: 0,
    pitch: -90
  }
} satisfies Record<string, GroundView>

/** Colours of the ground: its own, or those that tell how it is drawn. */
export const COLORS = {
  ground: { label: 'Ground' },
  levels: { label: 'Levels of detail' },
  tiles: { label: 'Tiles' },
  pages: { label: 'Pages: there, fading in, missing' }
} as const

export interface TerrainArgs extends RendererArgs, TimeArgs, PostEffects {
  view: keyof typeof VIEWS
  color: keyof typeof COLORS
  wireframe: boolean
  /** True to go from the shore to the summit and out to orbit, without a cut. */
  tour: boolean
  /** Wind over the sea [m/s]. */
  windSpeed: number
  shadows: boolean
  /** Shadows in the air, and those of mountains far away. */
  shafts: boolean
  /** Part of the light that shadowed air loses: 1 is physical. */
  strength: number
  /** True for an environment map that water mirrors, with the clouds in it. */
  mirror: boolean
  /** Broken clouds, which summits reach into. */
  clouds: boolean
  /** Mist over the valleys: extinction at sea level [1/km]. */
  mist: number
  /** Grass, flowers and trees about the viewer. */
  vegetation: boolean
  /** Stars, Milky Way, moon and airglow with their light, and the sun's halo. */
  night: boolean
}

/** Way of the tour, and the time that it takes [s]. */
const TOUR = ['shore', 'summit', 'orbit'] as const
const TOUR_SECONDS = 75

/** Place of the world's origin [°]. */
const ORIGIN = { longitude: 0.494, latitude: 46.35 }

/** Clouds from below the snow line up [m], and height over which mist thins to 1/e [m]. */
const CLOUDS = { baseAltitude: 2300, topAltitude: 3500, coverage: 0.4 }
const MIST_FALLOFF = 220

/** Fewer cells and texels in a still: a software renderer draws it. */
const STILL = { resolution: 16, pageMemory: 100, pagesPerFrame: 4 }

/** A procedural planet from a walker's feet to orbit: one mesh, without a byte of data. */
export async function createTerrain(
  canvas: HTMLCanvasElement,
  args: TerrainArgs
): Promise<SceneHandle<TerrainArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(50, 1, 0.2, 1e8)
  const current = { ...args }
  const atmosphere = new Atmosphere()
  atmosphere.place(ORIGIN)
  const isFinished = hasEffects(args)
  const isPost = args.clouds || args.shafts || isFinished
  const air = new Air(renderer, scene, camera, isPost ? 'post' : args.path, atmosphere)
  const mist = heightFog({ base: 0, falloff: MIST_FALLOFF, density: 0 })
  if (args.mist > 0) atmosphere.add(mist)
  const options = args.frame ? STILL : {}
  // #region terrain
  const heights = new MountainHeights({ seed: 513 }) // a function: nothing is loaded
  // #shown const terrain = new Terrain(atmosphere, heights)
  const terrain = new Terrain(atmosphere, heights, options) // #hidden
  terrain.castShadow = terrain.receiveShadow = true
  scene.add(terrain)
  // #shown scene.add(new Lake(terrain, { longitude: 0.51, latitude: 46.58, radius: 2000, level: 1516 }))
  const lakes = LAKES.map(lake => new Lake(terrain, lake)) // #hidden
  scene.add(...lakes) // #hidden
  // #endregion
  const { sun, post } = air
  prepareShadow(sun)
  let onGround: Node = shadow(sun)
  let color: Node | undefined = post?.color
  const mountains = args.shafts ? groundShadow(atmosphere, terrain) : undefined
  const shafts = mountains && lightShafts(atmosphere, camera, sun).add(mountains)
  if (mountains && shafts) onGround = terrainShadow(mountains, sun, onGround)
  if (post && (shafts || isFinished)) {
    const picture = isFinished ? drawnOf(post.scenePass) : post.picture
    color = aerialPerspective(picture, post.depth, camera, atmosphere, { shafts })
  }
  let cloudsNode: CloudsNode | undefined
  if (args.clouds && post && color) {
    const layers = cloudPreset('fairWeather')
    layers.at(0).set(CLOUDS)
    color = cloudsNode = clouds(color, post.depth, camera, atmosphere, layers)
    if (args.frame) cloudsNode.time = 0
    onGround = cloudShadow(cloudsNode, onGround)
    cloudSkyLight(air.sky, cloudsNode)
    shafts?.add(cloudAirShadow(cloudsNode))
  }
  const lights = args.night ? addNightSky(scene, atmosphere, cloudsNode) : []
  let finish: GroundFinish | undefined
  if (post && color) {
    post.pipeline.outputNode = color
    if (isFinished)
      finish = new GroundFinish(renderer, post, color, camera, atmosphere, cloudsNode, args.frame)
  }
  Object.assign(sun.shadow, { shadowNode: onGround })
  const overlay = cloudsNode && cloudEnvironment(cloudsNode)
  const environment = args.mirror ? skyEnvironment(atmosphere, overlay ? { overlay } : {}) : null
  scene.environmentNode = environment
  const groundColor = terrain.material.colorNode
  let shown: keyof typeof COLORS = 'ground'

  const ground = new GroundCamera(camera, canvas, terrain, args.frame)
  let plants: Vegetation | null = null
  const setPlants = (isThere: boolean): void => {
    if (isThere === (plants !== null)) return
    if (plants !== null) {
      scene.remove(plants)
      plants.dispose()
      plants = null
    } else scene.add((plants = new Vegetation(renderer, terrain)))
  }

  const apply = (): void => {
    applyTime(renderer, air, current)
    finish?.set(current, current.exposure)
    terrain.material.wireframe = current.wireframe
    terrain.windSpeed = current.windSpeed
    mist.density = current.mist / 1000
    if (shafts) shafts.strength = current.strength
    // One frame must show it all; a running scene draws it over fifteen.
    if (environment && args.frame) environment.needsRedraw = true
    terrain.castShadow = terrain.receiveShadow = current.shadows
    setPlants(current.vegetation)
    ground.tour(current.tour ? TOUR.map(name => VIEWS[name]) : null, TOUR_SECONDS)
    if (current.color === shown) return
    shown = current.color
    terrain.material.colorNode = shown === 'ground' ? groundColor : terrainView(shown)
    terrain.material.needsUpdate = true
  }
  return groundHandle<Omit<TerrainArgs, 'view'>, typeof VIEWS>({
    renderer,
    scene,
    camera,
    current,
    air,
    terrain,
    ground,
    views: VIEWS,
    apply,
    finish,
    follow() {
      // A still is planted at once.
      plants?.update(camera, args.frame ? 0 : performance.now() / 1000, args.frame ? Infinity : 3)
    },
    dispose() {
      setPlants(false)
      for (const owned of [shafts, mountains, environment, cloudsNode, finish, ...lights, ...lakes])
        owned?.dispose()
    }
  })
}
