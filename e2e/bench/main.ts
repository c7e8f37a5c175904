import { writeFileSync } from 'node:fs'
import { parseArgs } from 'node:util'
import { cloudLine, timeClouds, timeNoise } from './clouds'
import { HeadlessDevice, finished, gpuMilliseconds } from '../headless/device'
import { timeEnvironment } from './environment'
import { timeFrame } from './frame'
import { benchScene, type Path } from './scene'
import { shaftLine, timeShafts } from './shafts'
import { timeShells } from './shell'
import { skyLine, timeSky } from './sky'
import { measureCloudMemory } from './memory'
import { measureShaders } from './shaders'
import { median } from './statistics'
import { terrainLine, timeTerrain } from './terrain'
import { timeValley, valleyLines } from './valley'

const { values } = parseArgs({
  options: {
    json: { type: 'boolean', default: false },
    frames: { type: 'string', default: '40' },
    size: { type: 'string', default: '1920x1080' },
    terrain: { type: 'boolean', default: false },
    out: { type: 'string' }
  }
})
const frames = Number(values.frames)
const size = values.size.split('x').map(Number) as [number, number]
const [width, height] = size
if (!Number.isInteger(frames) || frames < 1 || !(width > 0 && height > 0)) {
  throw new Error(`bench: --frames must be a positive integer and --size WIDTHxHEIGHT`)
}

const ALTITUDES = [2, 1e3, 1e4, 4e5, 2e7]
const PATHS: Path[] = ['forward', 'post']

interface Case {
  path: Path
  altitude: number
  compositeMs: number
  volumeUpdateMs: number
}

const device = await HeadlessDevice.open()
const log = (text: string): void => {
  if (!values.json) console.log(text)
}
log(`device: ${device.name}, ${width}×${height}, medians of ${frames} frames\n`)

if (values.terrain) {
  const terrain = await timeTerrain(device, size, frames)
  for (const cost of terrain) log(terrainLine(cost))
  if (values.json) console.log(JSON.stringify({ device: device.name, terrain }, null, 2))
  if (values.out !== undefined) writeFileSync(values.out, JSON.stringify({ terrain }, null, 2))
  process.exit()
}

// Before anything else is warm.
const firstFrameMs = await timeFirstFrame()
const cases: Case[] = []
const cpuCosts: number[] = []
for (const path of PATHS) {
  for (const altitude of ALTITUDES) {
    const at = { path, altitude }
    const without = await timeFrame(device, size, frames, { ...at, withAir: false })
    const still = await timeFrame(device, size, frames, at)
    const moving = await timeFrame(device, size, frames, { ...at, sunMoves: true })
    const compositeMs = still.gpu - without.gpu
    const volumeUpdateMs = moving.gpu - still.gpu
    cases.push({ path, altitude, compositeMs, volumeUpdateMs })
    cpuCosts.push(moving.cpu - without.cpu)
    log(
      `${path.padEnd(8)} ${String(altitude).padStart(9)} m   composite ${compositeMs.toFixed(3)} ms` +
        `   volume update ${volumeUpdateMs.toFixed(3)} ms   (scene alone ${without.gpu.toFixed(3)} ms)`
    )
  }
}

const skyCosts = await timeSky(device, size, frames, PATHS)
for (const cost of skyCosts) log(skyLine(cost))

const shafts = await timeShafts(device, size, frames)
for (const cost of shafts) log(shaftLine(cost))

const valley = await timeValley(device, size, frames)
log(valleyLines(valley))

const terrain = await timeTerrain(device, size, frames)
for (const cost of terrain) log(terrainLine(cost))

const shells = await timeShells(device, size, frames)
for (const { model, outsideMs, insideMs } of shells) {
  log(
    `shell, ${model.padEnd(18)} outside ${outsideMs.toFixed(3)} ms   inside ${insideMs.toFixed(3)} ms`
  )
}

function megabytes(bytes: number): string {
  return `${(bytes / 1e6).toFixed(2)} MB`
}

/** Size of a texel of the tables [bytes]. */
const HALF_FLOATS = 8

/** GPU time of a bake, one step a frame: in all, and the most in a frame. */
async function timeBake(): Promise<{ total: number; most: number; bytes: number }> {
  const runs: { total: number; most: number; bytes: number }[] = []
  for (let run = 0; run < 5; run++) {
    const renderer = await device.renderer(64, 36)
    const scene = benchScene(renderer, 'forward', 2, true, [64, 36])
    scene.draw()
    await gpuMilliseconds(renderer)
    scene.draw()
    const still = await gpuMilliseconds(renderer)
    scene.atmosphere.bakeStepsPerFrame = 1
    scene.atmosphere.parameters.set({})
    const steps: number[] = []
    const { tables } = scene.atmosphere
    for (const before = tables.version; tables.version === before;) {
      scene.draw()
      steps.push((await gpuMilliseconds(renderer)) - still)
    }
    const total = steps.reduce((sum, value) => sum + value, 0)
    const bytes = [tables.atlas.target, tables.volumes.segments]
      .map(({ width, height, textures }) => HALF_FLOATS * width * height * textures.length)
      .reduce((sum, value) => sum + value, 0)
    runs.push({ total, most: Math.max(...steps), bytes })
    scene.dispose()
    void renderer.dispose()
  }
  return {
    total: median(runs.map(run => run.total)),
    most: Math.max(...runs.map(run => run.most)),
    bytes: runs[0].bytes
  }
}

/** Time to the first finished frame, from no renderer on, tables baked; wall-clock. */
async function timeFirstFrame(): Promise<number> {
  const start = performance.now()
  const renderer = await device.renderer(320, 180)
  const scene = benchScene(renderer, 'forward', 2, true, [320, 180])
  scene.draw()
  await finished(renderer)
  const elapsed = performance.now() - start
  scene.dispose()
  void renderer.dispose()
  return elapsed
}

const bake = await timeBake()
const environment = await timeEnvironment(device, size, 10)
const noise = await timeNoise(device)
const cloudCosts = await timeClouds(device, size, Math.min(frames, 10))
for (const cost of cloudCosts) log(cloudLine(cost))
const cloudMemory = await measureCloudMemory(device, size)
for (const { quality, renderTargets, shadowMaps, noise } of cloudMemory) {
  log(
    `clouds' memory, ${quality.padEnd(7)} render targets ${megabytes(renderTargets)}   shadow maps ${megabytes(shadowMaps)}   noise ${megabytes(noise)}`
  )
}
log('\nshaders, vertex + fragment')
const shaders = await measureShaders(device, log)
const result = {
  device: device.name,
  cases,
  shells,
  shafts,
  valley,
  terrain,
  skyCosts,
  bakeMs: bake.total,
  bakeMaxFrameMs: bake.most,
  gpuBytes: bake.bytes,
  firstFrameMs,
  environment,
  clouds: cloudCosts,
  cloudNoise: noise,
  cloudMemory,
  shaders,
  cpuMsPerFrame: median(cpuCosts)
}
log(`
bake           ${bake.total.toFixed(2)} ms in all, ${bake.most.toFixed(2)} ms at most in a frame
clouds' noise  ${noise.total.toFixed(2)} ms in all, ${noise.most.toFixed(2)} ms at most in a frame
GPU memory     ${megabytes(bake.bytes)}, tables
first frame    ${firstFrameMs.toFixed(0)} ms at 320×180
environment    ${environment.totalMs.toFixed(3)} ms in all, ${environment.mostMs.toFixed(3)} ms at most in a frame; CPU ${environment.submitMs.toFixed(2)} ms
CPU            ${result.cpuMsPerFrame.toFixed(2)} ms a frame while the volume is updated`)
if (values.json) console.log(JSON.stringify(result, null, 2))
if (values.out !== undefined) writeFileSync(values.out, JSON.stringify(result, null, 2))
// Dawn's objects outlive the script otherwise, and the process does not end.
device.close()
