import { Atmosphere } from '@welkin/atmosphere'
import { PerspectiveCamera } from 'three'
import type { Vector2 } from 'three'
import { float, vec3 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { createRenderer, exposureOf } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { TexturePictures } from './showTextures'
import type { Picture, Region } from './showTextures'

export interface TablesArgs extends RendererArgs {
  /** Haziness, 1 is air without aerosols. */
  turbidity: number
  /** [Dobson units] */
  ozone: number
  /** Part of the light that the ground reflects. */
  groundAlbedo: number
  /** Height of the camera of the sky volume [km]. */
  altitude: number
  /** Elevation of the sun at the camera [degrees]. */
  sunElevation: number
  /** [stops], 0 suits daylight. */
  exposure: number
}

type Texel = Node<'vec4'>

/** The tables' four wavelengths, 440 to 630 nm, as red, green and blue. */
const spectral = (texel: Texel): Node<'vec3'> => vec3(texel.w, texel.y, texel.x)
const transmittance = (texel: Texel): Node<'vec3'> => spectral(texel).negate().exp()
const light = (texel: Texel): Node<'vec3'> => spectral(texel).max(0)
/** Blue where a moment is negative, orange where it is positive. */
const signed = (texel: Texel): Node<'vec3'> => {
  const value = texel.y
  const positive = value.max(0)
  const negative = value.negate().max(0)
  return vec3(
    positive.add(negative.mul(float(0.1))),
    positive.mul(0.55).add(negative.mul(0.4)),
    positive.mul(0.1).add(negative)
  )
}

/** Tiles in the order of the diffuse-light table; the factor brings a daylit tile to a mid grey. */
const DIFFUSE = [
  { name: 'mean', factor: 4, color: light },
  { name: 'moment (1, 0)', factor: 8, color: signed },
  { name: 'moment (1, 1)', factor: 8, color: signed },
  { name: 'moment (2, 0)', factor: 16, color: signed },
  { name: 'moment (2, 1)', factor: 16, color: signed },
  { name: 'moment (2, 2)', factor: 16, color: signed },
  { name: 'irradiance from above', factor: 3, color: light },
  { name: 'irradiance from below', factor: 3, color: light }
]

/** Scale of the light in the tables, which suits half floats. */
const RADIANCE_SCALE = 4096

/** Layout of the sky volume's atlas. */
const VOLUME = { azimuths: 32, elevations: 96, columns: 6, rows: 4 }
const SLICES = [0, 11, 22]
const SLICE_COUNT = 23
const PARTS = ['molecules', 'aerosols']

const sliceLabel = (part: string, slice: number): string =>
  `Sky volume: ${part}, slice ${slice + 1} of ${SLICE_COUNT}`

/** A rectangle of the atlas [texels], without the outer half of its texels, where filtering mixes in others. */
function regionOf({ tables }: Atmosphere, x: number, y: number, w: number, h: number): Region {
  const { width, height } = tables.atlas.target
  return [(x + 0.5) / width, (y + 0.5) / height, (w - 1) / width, (h - 1) / height]
}

/** A slice of the light by molecules or aerosols, of the volume that a view has. */
function sliceRegion(atmosphere: Atmosphere, part: number, slice: number, light: Vector2): Region {
  const { azimuths, elevations, columns } = VOLUME
  const x = light.x + (part * columns + (slice % columns)) * azimuths
  const y = light.y + Math.floor(slice / columns) * elevations
  return regionOf(atmosphere, x, y, azimuths, elevations)
}

function pictures(atmosphere: Atmosphere): Picture[] {
  const { transmittance: table, diffuseLight, atlas } = atmosphere.tables
  const { texture } = atlas.target
  const { azimuths, elevations } = VOLUME
  const diffuse = DIFFUSE.map(({ name, color }, i) => ({
    label: `Diffuse light: ${name}`,
    texture,
    width: 96,
    height: 48,
    region: regionOf(
      atmosphere,
      diffuseLight.region.x + (i % 2) * 96,
      diffuseLight.region.y + Math.floor(i / 2) * 16,
      96,
      16
    ),
    color
  }))
  const slices = PARTS.flatMap(part =>
    SLICES.map(slice => ({
      label: sliceLabel(part, slice),
      texture,
      width: 2 * azimuths,
      height: elevations,
      color: light
    }))
  )
  return [
    {
      label: 'Transmittance to space: zenith → horizon, ground → top',
      texture,
      width: 256,
      height: 96,
      region: regionOf(atmosphere, table.region.x, table.region.y, 256, 64),
      color: transmittance
    },
    ...diffuse,
    ...slices
  ]
}

/** The atmosphere's tables, and the sky volume of a camera at an altitude, as pictures. */
export async function createTables(
  canvas: HTMLCanvasElement,
  args: TablesArgs
): Promise<SceneHandle<TablesArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  renderer.setClearColor('#14181d')
  const atmosphere = new Atmosphere()
  const eye = new PerspectiveCamera()
  const shown = new TexturePictures(canvas, pictures(atmosphere))
  const current = { ...args }

  const apply = (): void => {
    const { turbidity, ozone, groundAlbedo, altitude, sunElevation } = current
    // #region tables
    // #shown const [turbidity, ozone, groundAlbedo, sunElevation] = [2, 300, 0.1, 30]
    atmosphere.parameters
      .set({ turbidity, ozone })
      .set({ groundAlbedo: [groundAlbedo, groundAlbedo, groundAlbedo, groundAlbedo] })
    atmosphere.setSunAngles(sunElevation, 180)
    // #endregion
    eye.position.y = altitude * 1000
    eye.updateMatrixWorld()
    const exposure = exposureOf(current.exposure)
    for (const { name, factor } of DIFFUSE) {
      shown.set(`Diffuse light: ${name}`, { scale: (exposure * factor) / RADIANCE_SCALE })
    }
    shown.set('Sky volume', { scale: (exposure * 10) / RADIANCE_SCALE })
  }
  apply()

  return {
    renderer,
    scene: shown.scene,
    camera: shown.camera,
    ready: Promise.resolve(),
    progress: 1,
    render() {
      const { volume } = atmosphere.update(renderer, eye)
      for (const [i, part] of PARTS.entries()) {
        for (const slice of SLICES) {
          if (volume === null) continue
          const region = sliceRegion(atmosphere, i, slice, volume.light)
          shown.set(sliceLabel(part, slice), { region })
        }
      }
      renderer.render(shown.scene, shown.camera)
    },
    resize(width, height, pixelRatio) {
      renderer.setPixelRatio(pixelRatio)
      renderer.setSize(width, height, false)
      shown.resize(width, height)
    },
    update(changes) {
      Object.assign(current, changes)
      apply()
    },
    dispose() {
      shown.dispose()
      atmosphere.dispose()
      void renderer.dispose()
    }
  }
}
