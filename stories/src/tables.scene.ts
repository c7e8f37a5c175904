import { Atmosphere } from '@welkin/atmosphere'
import { PerspectiveCamera } from 'three'
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
  /** Of the camera that the sky volume is computed for [km]. */
  altitude: number
  /** Of the sun, above the camera's level [degrees]. */
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

/** In the order of the diffuse-light table; the factor brings a daylit tile to a mid grey. */
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

/** What the tables hold for the light itself: they are scaled to suit half floats. */
const RADIANCE_SCALE = 4096

/** Layout of the sky volume's atlas. */
const VOLUME = { azimuths: 32, elevations: 96, columns: 6, rows: 4, slots: 2 }
const SLICES = [0, 11, 22]
const SLICE_COUNT = 23
const PARTS = ['molecules', 'aerosols']

const sliceLabel = (part: string, slice: number): string =>
  `Sky volume: ${part}, slice ${slice + 1} of ${SLICE_COUNT}`

/** Without the outer half of the first and last texel, where filtering mixes in the next tile. */
function inset([x, y, width, height]: Region, columns: number): Region {
  return [x + 0.5 / columns, y, width - 1 / columns, height]
}

function sliceRegion(slice: number, slot: number): Region {
  const { azimuths, columns, rows, slots } = VOLUME
  const row = Math.floor(slice / columns) + slot * rows
  const width = 1 / columns
  const height = 1 / (rows * slots)
  return inset([(slice % columns) * width, row * height, width, height], azimuths * columns)
}

function pictures(atmosphere: Atmosphere): Picture[] {
  const { transmittance: table, diffuseLight, volumes } = atmosphere.tables
  const { azimuths, elevations } = VOLUME
  const diffuse = DIFFUSE.map(({ name, color }, i) => ({
    label: `Diffuse light: ${name}`,
    texture: diffuseLight.target.texture,
    width: 96,
    height: 48,
    region: inset([i / DIFFUSE.length, 0, 1 / DIFFUSE.length, 1], 96 * DIFFUSE.length),
    color
  }))
  const slices = PARTS.flatMap((part, i) =>
    SLICES.map(slice => ({
      label: sliceLabel(part, slice),
      texture: volumes.light.textures[i],
      width: 2 * azimuths,
      height: elevations,
      region: sliceRegion(slice, 0),
      color: light
    }))
  )
  return [
    {
      label: 'Transmittance to space: zenith → horizon, ground → top',
      texture: table.target.texture,
      width: 256,
      height: 96,
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
      const { slot } = atmosphere.update(renderer, eye)
      for (const part of PARTS) {
        for (const slice of SLICES) {
          shown.set(sliceLabel(part, slice), { region: sliceRegion(slice, slot) })
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
