import { cloudQualities, type CloudQualityName } from '@welkin/clouds'
import { mkdirSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'
import { parseArgs } from 'node:util'
import { PNG } from 'pngjs'
import { photographicToneMapping } from '@welkin/atmosphere'
import { CustomToneMapping } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { cloudReference } from '../bench/clouds'
import { median } from '../bench/statistics'
import { toneFault, tonesOf, type Tones } from '../harness/tones'
import { gpuMilliseconds, HeadlessDevice, nextFrame } from '../headless/device'
import { selectStills, stills, type AnyStill } from './scenes'
import { StillView } from './StillView'
import { StreetView } from './StreetView'
import { TerrainView } from './TerrainView'
import { ValleyView } from './ValleyView'

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    size: { type: 'string', default: '1920x1080' },
    scenes: { type: 'string', multiple: true, default: [] },
    out: { type: 'string', default: 'e2e/output/stills' },
    frames: { type: 'string', default: '120' },
    quality: { type: 'string', default: 'high' },
    list: { type: 'boolean', default: false }
  }
})
const HELP = '[--size 1920x1080] [--scenes NAME…] [--out DIR] [--quality high] [--frames 120]'

/** Frames at the start that exposure adapts to. */
const EXPOSED = 10
/** Frames at the end whose GPU time is told. */
const TIMED = 20

const size = values.size.split('x').map(Number) as [number, number]
const frames = Number(values.frames)
if (size.length !== 2 || !size.every(side => Number.isInteger(side) && side > 0)) {
  throw new Error(`stills: --size must be WIDTHxHEIGHT, got '${values.size}'; ${HELP}`)
}
if (!Number.isInteger(frames) || frames < 1) {
  throw new Error(`stills: --frames must be a positive integer, got '${values.frames}'; ${HELP}`)
}
const names = [...Object.keys(cloudQualities), 'reference']
if (!names.includes(values.quality)) {
  throw new Error(`stills: --quality must be ${names.join(', ')}, got '${values.quality}'`)
}
const quality =
  values.quality === 'reference' ? cloudReference : (values.quality as CloudQualityName)
// `--scenes a b` and `--scenes a --scenes b` alike.
const selected = selectStills([...values.scenes, ...positionals])

/** A still's figures. */
interface Taken {
  name: string
  file: string
  /** Median of the last frames [ms]. */
  gpuMs: number
  /** Luminance that it is exposed for [cd/m²]. */
  luminance: number
  /** Mean, and part that is clipped, of what a viewer sees. */
  tones: Tones
}

/** @throws If nothing was drawn: the picture is of one colour. */
function encode(name: string, pixels: Uint8Array): Buffer {
  const [width, height] = size
  const png = new PNG({ width, height })
  png.data = Buffer.from(pixels)
  let isEven = true
  for (let i = 0; i < png.data.length; i += 4) {
    png.data[i + 3] = 255
    isEven &&= [0, 1, 2].every(channel => png.data[i + channel] === png.data[channel])
  }
  if (isEven) throw new Error(`stills: ${name} is of one colour`)
  return PNG.sync.write(png)
}

function viewOf(
  renderer: Parameters<typeof gpuMilliseconds>[0],
  still: AnyStill
): StillView | ValleyView | TerrainView | StreetView {
  if ('street' in still) return new StreetView(renderer, still, size)
  if ('terrain' in still) return new TerrainView(renderer, still, size)
  if ('valley' in still) return new ValleyView(renderer, still, size, quality)
  return new StillView(renderer, still, size, quality)
}

async function take(
  renderer: Parameters<typeof gpuMilliseconds>[0],
  still: AnyStill
): Promise<Taken> {
  const view = viewOf(renderer, still)
  try {
    if (!(view instanceof StillView)) await view.bake()
    const times: number[] = []
    for (let frame = 0; frame < frames; frame++) {
      nextFrame()
      view.draw()
      times.push(await gpuMilliseconds(renderer))
      if (frame < EXPOSED) await view.expose()
    }
    const file = `${still.name}.png`
    const pixels = await view.picture()
    writeFileSync(join(values.out, file), encode(still.name, pixels))
    const { luminance } = view
    const gpuMs = median(times.slice(-TIMED))
    return { name: still.name, file, gpuMs, luminance, tones: tonesOf(pixels, 255) }
  } finally {
    view.dispose()
  }
}

/** Fault of how a still is exposed. */
function faultOf(still: AnyStill, { tones, luminance }: Taken): string | undefined {
  const compensation = 'compensation' in still ? still.compensation : 0
  return toneFault(tones, luminance, 'inSpace' in still, compensation)
}

/** @param isPlanet - True if it shows metres and a planet at once. */
async function rendererOf(device: HeadlessDevice, isPlanet: boolean): Promise<WebGPURenderer> {
  const renderer = await device.renderer(...size, { reversedDepthBuffer: isPlanet })
  renderer.highPrecision = isPlanet
  renderer.library.addToneMapping(photographicToneMapping(), CustomToneMapping)
  renderer.toneMapping = CustomToneMapping
  renderer.shadowMap.enabled = true
  return renderer
}

async function takeAll(): Promise<void> {
  mkdirSync(values.out, { recursive: true })
  const device = await HeadlessDevice.open()
  console.log(`device: ${device.name}, ${values.size}, quality ${values.quality}, to ${values.out}`)
  const taken: Taken[] = []
  const renderers = new Map<boolean, Promise<WebGPURenderer>>()
  for (const still of selected) {
    const isPlanet = 'terrain' in still
    try {
      const renderer = renderers.get(isPlanet) ?? rendererOf(device, isPlanet)
      renderers.set(isPlanet, renderer)
      const result = await take(await renderer, still)
      taken.push(result)
      const { gpuMs, luminance, tones } = result
      console.log(
        `${still.name.padEnd(22)} ${gpuMs.toFixed(2)} ms a frame   ${luminance.toPrecision(3)} cd/m²   ` +
          `mean ${tones.mean.toFixed(2)}   clipped ${(100 * tones.clipped).toFixed(1)} %`
      )
      const fault = faultOf(still, result)
      if (fault !== undefined) {
        console.error(`✗ ${still.name}: ${fault}`)
        process.exitCode = 1
      }
    } catch (error) {
      // The others are worth having all the same.
      console.error(`${still.name.padEnd(22)} failed:`, error)
      process.exitCode = 1
    }
  }
  const report = { device: device.name, size, frames, quality: values.quality, stills: taken }
  writeFileSync(join(values.out, 'stills.json'), JSON.stringify(report, null, 2))
  device.close()
}

if (values.list) {
  for (const { name, about } of stills) console.log(`${name.padEnd(22)} ${about}`)
} else await takeAll()
