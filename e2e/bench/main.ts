import { writeFileSync } from 'node:fs'
import { parseArgs } from 'node:util'
import { HeadlessDevice } from '../headless/device'
import { airLine, PATHS, timeAir, timeBake, timeFirstFrame } from './air'
import { bowLine, timeBows } from './bows'
import { cloudLine, timeClouds, timeNoise } from './clouds'
import { timeEnvironment } from './environment'
import { measureFeatures } from './features'
import { firstPictureLines, flightLine, measureFlight, timeFirstPictures } from './flight'
import { lightningLine, timeLightning } from './lightning'
import { crackLines, findCracks } from './cracks'
import { measureCloudMemory } from './memory'
import { rainLine, timeRain } from './rain'
import { measureShaders } from './shaders'
import { shaftLine, timeShafts } from './shafts'
import { timeShells } from './shell'
import { skyLine, timeSky } from './sky'
import { median } from './statistics'
import { measureSwitches } from './switches'
import { terrainLine, timeTerrain, timeVegetation, vegetationLine } from './terrain'
import { timeValley } from './valley'

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    json: { type: 'boolean', default: false },
    frames: { type: 'string', default: '40' },
    size: { type: 'string', default: '1920x1080' },
    only: { type: 'string', multiple: true, default: [] },
    // Of the valley by how their names begin, of switches by name.
    rows: { type: 'string', multiple: true, default: [] },
    out: { type: 'string' }
  }
})
const frames = Number(values.frames)
const size = values.size.split('x').map(Number) as [number, number]
const [width, height] = size
if (!Number.isInteger(frames) || frames < 1 || !(width > 0 && height > 0)) {
  throw new Error(`bench: --frames must be a positive integer and --size WIDTHxHEIGHT`)
}

const device = await HeadlessDevice.open()
const log = (text: string): void => {
  if (!values.json) console.log(text)
}

function megabytes(bytes: number): string {
  return `${(bytes / 1e6).toFixed(2)} MB`
}

/** Measures one part of the library, prints its figures as it goes, and returns what `--json` prints. */
type Part = () => Promise<Record<string, unknown>>

const parts: Record<string, Part> = {
  async air() {
    // Before anything else is warm.
    const firstFrameMs = await timeFirstFrame(device)
    const cases = await timeAir(device, size, frames)
    for (const cost of cases) log(airLine(cost))
    const skyCosts = await timeSky(device, size, frames, PATHS)
    for (const cost of skyCosts) log(skyLine(cost))
    const bake = await timeBake(device)
    const environment = await timeEnvironment(device, size, 10)
    const cpuMsPerFrame = median(cases.map(({ cpuMs }) => cpuMs))
    log(`
bake           ${bake.total.toFixed(2)} ms in all, ${bake.most.toFixed(2)} ms at most in a frame
GPU memory     ${megabytes(bake.bytes)}, tables
first frame    ${firstFrameMs.toFixed(0)} ms at 320×180
environment    ${environment.totalMs.toFixed(3)} ms in all, ${environment.mostMs.toFixed(3)} ms at most in a frame; CPU ${environment.submitMs.toFixed(2)} ms
CPU            ${cpuMsPerFrame.toFixed(2)} ms a frame while the volume is updated`)
    const tables = { bakeMs: bake.total, bakeMaxFrameMs: bake.most, gpuBytes: bake.bytes }
    return { cases, skyCosts, ...tables, firstFrameMs, environment, cpuMsPerFrame }
  },
  async shafts() {
    const shafts = await timeShafts(device, size, frames)
    for (const cost of shafts) log(shaftLine(cost))
    return { shafts }
  },
  async rain() {
    const rain = await timeRain(device, size, frames)
    for (const cost of rain) log(rainLine(cost))
    return { rain }
  },
  async lightning() {
    const costs = await timeLightning(device, size, frames)
    for (const cost of costs) log(lightningLine(cost))
    return { lightning: costs }
  },
  async bows() {
    const bows = await timeBows(device, size, frames, cost => log(bowLine(cost)))
    return { bows }
  },
  async valley() {
    const valley = await timeValley(device, size, frames, values.rows, log)
    return { valley }
  },
  async terrain() {
    const terrain = await timeTerrain(device, size, frames)
    for (const cost of terrain) log(terrainLine(cost))
    const vegetation = await timeVegetation(device, size, frames)
    log(vegetationLine(vegetation))
    return { terrain, vegetation }
  },
  async firstPictures() {
    const firstPictures = await timeFirstPictures(device, size)
    log(firstPictureLines(firstPictures))
    return { firstPictures }
  },
  async flight() {
    const flight = await measureFlight(device, memory => log(flightLine(memory)))
    return { flight }
  },
  async cracks() {
    const search = await findCracks(device, 10_000, 95, log)
    log(crackLines(search))
    if (search.cracks.length > 0) process.exitCode = 1
    return { cracks: search }
  },
  async switches() {
    return { switches: await measureSwitches(device, values.rows, log) }
  },
  async features() {
    return { features: await measureFeatures(device, size, values.rows, log) }
  },
  async shell() {
    const shells = await timeShells(device, size, frames)
    for (const { model, outsideMs, insideMs } of shells) {
      log(
        `shell, ${model.padEnd(18)} outside ${outsideMs.toFixed(3)} ms   inside ${insideMs.toFixed(3)} ms`
      )
    }
    return { shells }
  },
  async clouds() {
    const cloudNoise = await timeNoise(device)
    log(
      `clouds' noise  ${cloudNoise.total.toFixed(2)} ms in all, ${cloudNoise.most.toFixed(2)} ms at most in a frame`
    )
    const clouds = await timeClouds(device, size, Math.min(frames, 10), cost =>
      log(cloudLine(cost))
    )
    const cloudMemory = await measureCloudMemory(device, size)
    for (const { quality, renderTargets, shadowMaps, noise } of cloudMemory) {
      log(
        `clouds' memory, ${quality.padEnd(7)} render targets ${megabytes(renderTargets)}   shadow maps ${megabytes(shadowMaps)}   noise ${megabytes(noise)}`
      )
    }
    return { clouds, cloudNoise, cloudMemory }
  },
  async showers() {
    const showers = await timeClouds(
      device,
      size,
      Math.min(frames, 20),
      cost => log(cloudLine(cost)),
      'shower'
    )
    return { showers }
  },
  async shaders() {
    log('\nshaders, vertex + fragment')
    return { shaders: await measureShaders(device, log) }
  }
}

// `--only clouds valley` and `--only clouds --only valley` alike.
const only = [...values.only, ...positionals]
for (const name of only) {
  if (!(name in parts)) {
    throw new Error(`bench: --only takes ${Object.keys(parts).join(', ')}, got '${name}'`)
  }
}
log(`device: ${device.name}, ${width}×${height}, medians of ${frames} frames\n`)
const result: Record<string, unknown> = { device: device.name }
/** Parts for which one asks: all of `clouds` has the showers, too; the others are no figures of cost. */
const ASKED = new Set(['bows', 'showers', 'cracks', 'switches', 'features'])
const all = Object.keys(parts).filter(name => !ASKED.has(name))
for (const name of only.length > 0 ? only : all) {
  Object.assign(result, await parts[name]())
}
if (values.json) console.log(JSON.stringify(result, null, 2))
if (values.out !== undefined) writeFileSync(values.out, JSON.stringify(result, null, 2))
// Dawn's objects outlive the script otherwise, and the process does not end.
device.close()
