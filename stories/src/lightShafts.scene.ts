import {
  aerialPerspective,
  exposureFor,
  heightFog,
  lightShafts,
  moon,
  MoonDirectionalLight
} from '@welkin/atmosphere'
import {
  cloudAirShadow,
  CloudCover,
  cloudPreset,
  clouds,
  cloudShadow,
  cloudSkyLight
} from '@welkin/clouds'
import type { CloudPresetName, CloudsNode } from '@welkin/clouds'
import { shadow } from 'three/tsl'
import { STILL_QUALITY } from './clouds/still'
import { createCity } from './globe/city'
import { createLand } from './globe/land'
import { CITY } from './globe/places'
import type { Place } from './globe/places'
import { exposureOf } from './scene'
import type { RendererArgs, SceneHandle } from './scene'

/** A view of shafts: the camera, and objects that cast them. */
export interface ShaftView extends Place {
  readonly clouds?: { readonly preset: CloudPresetName; readonly coverage?: number }
  /** Height above which ground fog thins out, by e in 40 m [m]. */
  readonly fogBase?: number
  readonly hasCity?: boolean
  /** True for the moon's light, by night. */
  readonly isNight?: boolean
}

const valley = { longitude: -84.178, latitude: 36.622, height: 345 }

export const VIEWS = {
  ridge: {
    label: 'Ridge at sunrise',
    longitude: -84.163,
    latitude: 36.492,
    height: 700,
    heading: 60,
    pitch: -3,
    fogBase: 330
  },
  deck: {
    label: 'Broken deck',
    ...valley,
    heading: 45,
    pitch: 12,
    clouds: { preset: 'stratocumulus', coverage: 0.7 }
  },
  city: { label: 'Towers', ...CITY, height: 130, heading: 248, pitch: -2, hasCity: true },
  storm: {
    label: "Storm's shadow",
    ...valley,
    height: 10_000,
    heading: 152,
    pitch: -6,
    clouds: { preset: 'cumulonimbus' }
  },
  opposite: {
    label: 'Opposite the sunset',
    ...valley,
    heading: 70,
    pitch: 10,
    clouds: { preset: 'congestus', coverage: 0.4 }
  },
  moon: {
    label: 'Moonlight',
    ...valley,
    heading: 45,
    pitch: 14,
    isNight: true,
    clouds: { preset: 'stratocumulus', coverage: 0.6 }
  }
} satisfies Record<string, ShaftView>

export interface LightShaftsArgs extends RendererArgs {
  view: keyof typeof VIEWS
  /** Part of the light that shadowed air loses; 1 is physical, 0 has no shafts. */
  strength: number
  /** Aerosol of the air: 1 is clear, 6 thick haze. */
  turbidity: number
  /** Elevation of the sun, or of the moon by night [degrees]. */
  elevation: number
  /** Its azimuth, clockwise from north [degrees]. */
  azimuth: number
  /** [stops], 0 as `exposureFor` says. */
  exposure: number
}

/** A still marches every pixel of the clouds in every frame, coarsely. */
const STILL = { quality: STILL_QUALITY, frames: 3 }

/** Time of the clouds' drift: there are gaps in the views then [s]. */
const TIME = 300

/** Shadows in the air: of ridges, towers and clouds, in sunlight and moonlight. */
export const createLightShafts = (
  canvas: HTMLCanvasElement,
  args: LightShaftsArgs
): Promise<SceneHandle<LightShaftsArgs>> =>
  createLand<LightShaftsArgs>(
    canvas,
    { ...args, path: 'post' },
    55,
    ({ scene, camera, renderer, air, noise }) => {
      const { atmosphere, sun, sky, post } = air
      if (post === undefined) throw new Error('createLightShafts: there must be a post effect')
      const { pipeline, picture, depth } = post
      const view: ShaftView = VIEWS[args.view]
      atmosphere.place(view) // from where the sun has its angles
      atmosphere.frame = 'ecef' // the world's axes are the Earth's, its origin the Earth's centre

      const luna = moon()
      const moonlight = new MoonDirectionalLight(atmosphere, luna, 1000)
      if (view.isNight) {
        atmosphere.add(luna)
        scene.add(moonlight, moonlight.target)
      }
      const light = view.isNight ? moonlight : sun
      // #region light shafts
      // #shown const picture = scenePass.getTextureNode() // without its air
      // #shown const light = sun // or a moon's
      const shafts = lightShafts(atmosphere, camera, light)
      const lit = aerialPerspective(picture, depth, camera, atmosphere, { shafts })
      pipeline.outputNode = lit
      // #endregion

      let cloudsNode: CloudsNode | undefined
      let clouded: CloudCover | undefined
      if (view.clouds !== undefined) {
        const { preset, coverage } = view.clouds
        // #region shafts of clouds
        // #shown const preset = 'stratocumulus'
        const layers = cloudPreset(preset)
        const node = clouds(lit, depth, camera, atmosphere, layers)
        pipeline.outputNode = node
        Object.assign(sun.shadow, { shadowNode: cloudShadow(node, shadow(sun)) })
        cloudSkyLight(sky, node)
        shafts.add(cloudAirShadow(node)) // clouds cast their shadows into the air
        const cover = new CloudCover(layers, { light: node.light }) // and dim what eyes are used to
        // #endregion
        cloudsNode = node
        clouded = cover
        if (coverage !== undefined) layers.at(0).set({ coverage })
        if (args.frame) node.quality = STILL.quality
        node.time = TIME
      }
      const city = view.hasCity ? createCity(noise) : undefined
      if (city !== undefined) scene.add(city.object)
      if (view.fogBase !== undefined) {
        atmosphere.add(heightFog({ base: view.fogBase, falloff: 40, density: 0.004 }))
      }

      let haze = NaN
      return {
        warmUpFrames: cloudsNode === undefined ? undefined : STILL.frames,
        place: () => view,
        // Exposure is that of the tables, in every frame of a screenshot.
        prepare: () => atmosphere.bake(renderer),
        apply({ strength, turbidity, elevation, azimuth, exposure }) {
          shafts.strength = strength
          if (turbidity !== haze) atmosphere.parameters.set({ turbidity })
          haze = turbidity
          const direction = atmosphere.setSunAngles(elevation, azimuth).sunDirection
          if (view.isNight) {
            luna.set({ direction, phase: 0.5 })
            atmosphere.setSunAngles(-40, azimuth + 180)
          }
          renderer.toneMappingExposure = exposureOf(exposure)
        },
        beforeDraw() {
          const sources = view.isNight ? [luna.source] : []
          // #region exposure under clouds
          // #shown const exposure = exposureFor(atmosphere, camera, { clouds: cover })
          const exposure = exposureFor(atmosphere, camera, { clouds: clouded, sources }) // #hidden
          atmosphere.luminanceScale = 1e-4 * exposure // as sun, moon and camera move
          // #endregion
          if (args.frame) cloudsNode?.field.bake(renderer)
        },
        dispose() {
          city?.dispose()
          cloudsNode?.dispose()
          shafts.dispose()
          moonlight.dispose()
        }
      }
    }
  )
