import { existsSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { parseArgs } from 'node:util'
import type { Backend } from '../harness/backend'
import type { LightShaftsQuality } from '@welkin/atmosphere'
import {
  cloudPresetNames,
  cloudQualities,
  type CloudPresetName,
  type CloudQualityName
} from '@welkin/clouds'
import { drawCloudFields, writeGrid } from './cloud-field'
import { printCloudLight, validateCloudLight } from './cloud-light'
import { printClouds, validateClouds } from './clouds'
import { evaluateInBrowser } from './evaluate'
import { colorRequest, compareColors, compareSky, compareSun, skyRequest } from './figures'
import type { ColorFigures, SkyComparisons } from './figures'
import { printForm, validateForm } from './form/run'
import { missedCloudGoals, missedCloudLightGoals, missedGoals } from './goals'
import { printColors, printQuantities, printSun, printWorst } from './print'
import { readColorReference, readSkyReference } from './reference'
import type { Path } from './request'
import { missedShaftGoals, printShafts, validateShafts } from './shafts'
import { bandStatistics, everyNth, type Comparison } from './score'

const usage = `npm run validate -- [options]

  --sky FILE                 spectral radiances, by default e2e/reference/sky.json
  --spectral FILE            sky colours, by default e2e/reference/spectral_sky.json
  --clouds FILE              clouds of simple shapes, by default e2e/reference/cloud_slab.json;
                             with --path march only if named
  --backend webgpu|webgl     by default webgpu
  --path volume|march        how the air along a ray is found, by default volume; or both (volume,march), each in turn
  --every N                  takes every Nth sky colour alone: each has a sun, and thereby a volume, of its own
  --json                     print JSON alone; missed goals go to standard error
  --worst N                  also list the N largest errors of each quantity; not with --json
  --check                    exit with 1 if a goal is missed, with --json as without
  --form PRESET              instead: figures of the form of a cloud preset, as the GPU draws it;
                             --coverage C for another one than the preset's
  --cloud-light [FILE]       instead: light of a simulated cloud, by default e2e/reference/cloud_light.json;
                             --quality NAME of the march, by default high
  --shafts [FILE]            instead: light that boxes take from the air in their shadows, by default
                             e2e/reference/shafts.json; --quality NAME of the shafts, by default high,
                             or several (medium,high), each in turn,
                             --reversed for a reversed depth buffer, --forward for materials that draw
                             the air themselves, --all for post effect and materials on WebGPU and the post
                             effect on WebGL (of these the backend's alone, if --backend names one), and of
                             qualities but the first for the post effect alone,
                             --every N for every Nth camera of the file alone
  --export-clouds OUT        instead: writes clouds as OUT.raw (float32 extinction [1/m], z, y, x) and
                             OUT.json; with --preset NAME, --size 6000 and --cell 20 [m], --longitude and
                             --latitude [°], --coverage C
  --help                     print this

A default file that is not there leaves its quantities out.`

function choice<T extends string>(name: string, value: string, choices: readonly T[]): T {
  if (choices.includes(value as T)) return value as T
  throw new Error(`--${name} must be ${choices.join(' or ')}, got '${value}'`)
}

function count(name: string, value: string): number {
  if (/^\d+$/.test(value)) return Number(value)
  throw new Error(`--${name} must be a whole number from 0, got '${value}'`)
}

function inRange(name: string, value: string, min: number, max: number): number {
  const number = value.trim() === '' ? NaN : Number(value)
  if (number >= min && number <= max) return number
  throw new Error(`--${name} must be in [${min}, ${max}], got '${value}'`)
}

const preset = (option: string, value: string): CloudPresetName =>
  choice(option, value, cloudPresetNames)

const backends: readonly Backend[] = ['webgpu', 'webgl']

const lightShaftsQualities: LightShaftsQuality[] = ['low', 'medium', 'high', 'reference']

/** The file named on the command line, or the default one if it is there. */
function input(named: string | undefined, standard: string): string | undefined {
  if (named !== undefined) return named
  const file = fileURLToPath(new URL(`../reference/${standard}`, import.meta.url))
  return existsSync(file) ? file : undefined
}

/** The arguments, with an empty file for options that may go without. */
function commandLine(): string[] {
  const words = process.argv.slice(2)
  for (const option of ['--cloud-light', '--shafts']) {
    const at = words.indexOf(option)
    if (at >= 0 && (words[at + 1] ?? '--').startsWith('--')) words.splice(at + 1, 0, '')
  }
  // A negative number looks like an option.
  for (let at = words.length - 1; at > 0; at--) {
    if (/^-[\d.]/.test(words[at])) words.splice(at - 1, 2, `${words[at - 1]}=${words[at]}`)
  }
  return words
}

async function main(): Promise<void> {
  const { values } = parseArgs({
    args: commandLine(),
    options: {
      sky: { type: 'string' },
      spectral: { type: 'string' },
      clouds: { type: 'string' },
      backend: { type: 'string' },
      path: { type: 'string', default: 'volume' },
      json: { type: 'boolean', default: false },
      worst: { type: 'string', default: '0' },
      check: { type: 'boolean', default: false },
      form: { type: 'string' },
      'cloud-light': { type: 'string' },
      shafts: { type: 'string' },
      reversed: { type: 'boolean', default: false },
      forward: { type: 'boolean', default: false },
      all: { type: 'boolean', default: false },
      every: { type: 'string', default: '1' },
      quality: { type: 'string', default: 'high' },
      'export-clouds': { type: 'string' },
      preset: { type: 'string', default: 'fairWeather' },
      size: { type: 'string', default: '6000' },
      cell: { type: 'string', default: '20' },
      longitude: { type: 'string', default: '139.77' },
      latitude: { type: 'string', default: '35.68' },
      coverage: { type: 'string' },
      help: { type: 'boolean', default: false }
    }
  })
  if (values.help) {
    console.log(usage)
    return
  }
  const where = { backend: choice<Backend>('backend', values.backend ?? 'webgpu', backends) }
  const every = Math.max(count('every', values.every), 1)
  const paths = values.path.split(',').map(name => choice<Path>('path', name, ['volume', 'march']))
  const worst = count('worst', values.worst)
  const coverage =
    values.coverage === undefined
      ? {}
      : { coverage: inRange('coverage', values.coverage, Number.MIN_VALUE, 1) }
  if (values['export-clouds'] !== undefined) {
    const request = {
      backend: where.backend,
      preset: preset('preset', values.preset),
      longitude: inRange('longitude', values.longitude, -180, 180),
      latitude: inRange('latitude', values.latitude, -90, 90),
      size: inRange('size', values.size, 1, 1e5),
      cell: inRange('cell', values.cell, 1, 1e4),
      ...coverage
    }
    const name = values['export-clouds']
    await drawCloudFields([request], grid => writeGrid(name, grid))
    return
  }
  // What the tools on the way have to say must not get between the JSON.
  const print = console.log
  if (values.json) console.log = console.error
  const tellMissed = (missed: readonly string[]): void => {
    if (values.check && missed.length > 0) process.exitCode = 1
    if (values.json) for (const goal of missed) console.error(`missed: ${goal}`)
  }
  if (values.form !== undefined) {
    const form = await validateForm(preset('form', values.form), where.backend, coverage.coverage)
    tellMissed(form.rows.filter(row => !row.isMet).map(({ name }) => name))
    if (values.json) print(JSON.stringify({ form }, null, 2))
    else printForm(form)
    return
  }
  if (values['cloud-light'] !== undefined) {
    const file = input(values['cloud-light'] || undefined, 'cloud_light.json')
    if (file === undefined) throw new Error('there is nothing to compare: name a file')
    const names = Object.keys(cloudQualities) as CloudQualityName[]
    const quality = choice('quality', values.quality, names)
    const cloudLight = await validateCloudLight(file, where.backend, quality)
    tellMissed(missedCloudLightGoals(cloudLight))
    if (values.json) print(JSON.stringify({ cloudLight }, null, 2))
    else printCloudLight(cloudLight)
    return
  }
  if (values.shafts !== undefined) {
    const file = input(values.shafts || undefined, 'shafts.json')
    const air = input(values.sky, 'sky.json')
    if (file === undefined || air === undefined) throw new Error('there is nothing to compare')
    const qualities = values.quality
      .split(',')
      .map(name => choice('quality', name, lightShaftsQualities))
    const { parameters } = readSkyReference(air)
    const isReversed = values.reversed
    // More samples are the same code on either backend, and in materials.
    const [usual, ...others] = qualities
    // On WebGL materials draw what the post effect does: see the GPU tests.
    const everyWay = [
      ['webgpu', false],
      ['webgpu', true],
      ['webgl', false]
    ] as const
    const chosen = values.all
      ? everyWay.filter(([backend]) => backend === (values.backend ?? backend))
      : ([[where.backend, values.forward]] as const)
    const usualWays = chosen.map(([backend, isForward]) => ({
      backend,
      isForward,
      isReversed,
      quality: usual
    }))
    const ways = usualWays.concat(
      others.map(quality => Object.assign({}, usualWays[0], { quality }))
    )
    const all: object[] = []
    for (const [i, figures] of (await validateShafts(file, parameters, ways, every)).entries()) {
      const { errors, ...shafts } = figures
      const { backend, quality, isForward } = ways[i]
      const title = `${isForward ? 'materials' : 'post effect'}, ${backend}, ${quality}`
      tellMissed(missedShaftGoals(shafts).map(goal => `${title}: ${goal}`))
      all.push({ ...ways[i], ...shafts })
      if (!values.json) printShafts(title, { ...shafts, errors }, worst)
    }
    // One way as itself, several as a list: one text of JSON.
    if (values.json) print(JSON.stringify({ shafts: all.length === 1 ? all[0] : all }, null, 2))
    return
  }

  const skyFile = input(values.sky, 'sky.json')
  const spectralFile = input(values.spectral, 'spectral_sky.json')
  const sky = skyFile === undefined ? undefined : readSkyReference(skyFile)
  const allColors = spectralFile === undefined ? undefined : readColorReference(spectralFile)
  let colors = allColors && everyNth(allColors, every)
  if (colors?.length === 0) colors = undefined
  const requests = paths.flatMap(path => [
    ...(sky === undefined ? [] : [skyRequest(sky, { ...where, path })]),
    ...(colors === undefined ? [] : [colorRequest(colors, { ...where, path })])
  ])
  if (requests.length === 0) throw new Error('there is nothing to compare: name a file')
  const results = await evaluateInBrowser(requests)

  // The air's path makes no difference to them.
  const hasClouds = values.clouds !== undefined || paths.includes('volume')
  const cloudsFile = hasClouds ? input(values.clouds, 'cloud_slab.json') : undefined
  const clouds =
    cloudsFile === undefined ? undefined : await validateClouds(cloudsFile, where.backend)

  const all: object[] = []
  for (const [i, path] of paths.entries()) {
    const cloudsHere = i === 0 ? clouds : undefined
    let quantities: SkyComparisons = {}
    let spectral: ColorFigures | undefined
    let sun: Comparison[] = []
    if (sky !== undefined) {
      const result = results.shift()!
      quantities = compareSky(sky, result)
      sun = compareSun(sky, result)
    }
    if (colors !== undefined) spectral = compareColors(colors, results.shift()!)
    const statistics = Object.fromEntries(
      Object.entries(quantities).map(([name, list]) => [name, bandStatistics(list)])
    )
    const missed = missedGoals(quantities, statistics, spectral)
    if (cloudsHere !== undefined) missed.push(...missedCloudGoals(cloudsHere))
    tellMissed(missed)
    all.push({
      ...statistics,
      ...(spectral === undefined ? {} : { spectral }),
      ...(cloudsHere === undefined ? {} : { clouds: cloudsHere })
    })
    if (values.json) continue
    console.log(`${path} path on ${where.backend}\n`)
    printQuantities(quantities, statistics)
    printSun(sun)
    if (spectral !== undefined) printColors(spectral)
    if (cloudsHere !== undefined) printClouds(cloudsHere)
    for (const [name, list] of Object.entries(quantities)) printWorst(name, list, worst)
    console.log(missed.length === 0 ? '\nAll goals are met.\n' : '\nGoals missed:')
    for (const goal of missed) console.log(`  ${goal}`)
  }
  // One path as itself, several as a list: one text of JSON.
  if (values.json) print(JSON.stringify(all.length === 1 ? all[0] : all, null, 2))
}

try {
  await main()
} catch (error) {
  console.error(`validate: ${error instanceof Error ? error.message : String(error)}`)
  console.error('npm run validate -- --help lists the options.')
  process.exitCode = 1
}
