import { existsSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { parseArgs } from 'node:util'
import type { Backend } from '../harness/backend'
import { printClouds, validateClouds } from './clouds'
import { evaluateInBrowser } from './evaluate'
import { colorRequest, compareColors, compareSky, compareSun, skyRequest } from './figures'
import type { ColorFigures, SkyComparisons } from './figures'
import { missedCloudGoals, missedGoals } from './goals'
import { printColors, printQuantities, printSun, printWorst } from './print'
import { readColorReference, readSkyReference } from './reference'
import type { Path } from './request'
import { bandStatistics, type Comparison } from './score'

const usage = `npm run validate -- [options]

  --sky FILE                 spectral radiances, by default e2e/reference/sky.json
  --spectral FILE            sky colours, by default e2e/reference/spectral_sky.json
  --clouds FILE              clouds of simple shapes, by default e2e/reference/cloud_slab.json;
                             with --path march only if named
  --backend webgpu|webgl     by default webgpu
  --path volume|march        how the air along a ray is found, by default volume
  --json                     print JSON alone; missed goals go to standard error
  --worst N                  also list the N largest errors of each quantity; not with --json
  --check                    exit with 1 if a goal is missed, with --json as without
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

/** The file named on the command line, or the default one if it is there. */
function input(named: string | undefined, standard: string): string | undefined {
  if (named !== undefined) return named
  const file = fileURLToPath(new URL(`../reference/${standard}`, import.meta.url))
  return existsSync(file) ? file : undefined
}

async function main(): Promise<void> {
  const { values } = parseArgs({
    options: {
      sky: { type: 'string' },
      spectral: { type: 'string' },
      clouds: { type: 'string' },
      backend: { type: 'string', default: 'webgpu' },
      path: { type: 'string', default: 'volume' },
      json: { type: 'boolean', default: false },
      worst: { type: 'string', default: '0' },
      check: { type: 'boolean', default: false },
      help: { type: 'boolean', default: false }
    }
  })
  if (values.help) {
    console.log(usage)
    return
  }
  const where = {
    backend: choice<Backend>('backend', values.backend, ['webgpu', 'webgl']),
    path: choice<Path>('path', values.path, ['volume', 'march'])
  }
  const worst = count('worst', values.worst)
  // What the tools on the way have to say must not get between the JSON.
  const print = console.log
  if (values.json) console.log = console.error

  const skyFile = input(values.sky, 'sky.json')
  const spectralFile = input(values.spectral, 'spectral_sky.json')
  const sky = skyFile === undefined ? undefined : readSkyReference(skyFile)
  let colors = spectralFile === undefined ? undefined : readColorReference(spectralFile)
  if (colors?.length === 0) colors = undefined
  const requests = [
    ...(sky === undefined ? [] : [skyRequest(sky, where)]),
    ...(colors === undefined ? [] : [colorRequest(colors, where)])
  ]
  if (requests.length === 0) throw new Error('there is nothing to compare: name a file')
  const results = await evaluateInBrowser(requests)

  // The air's path makes no difference to them.
  const hasClouds = values.clouds !== undefined || where.path === 'volume'
  const cloudsFile = hasClouds ? input(values.clouds, 'cloud_slab.json') : undefined
  const clouds =
    cloudsFile === undefined ? undefined : await validateClouds(cloudsFile, where.backend)

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
  if (clouds !== undefined) missed.push(...missedCloudGoals(clouds))
  if (values.check && missed.length > 0) process.exitCode = 1
  if (values.json) {
    const all = {
      ...statistics,
      ...(spectral === undefined ? {} : { spectral }),
      ...(clouds === undefined ? {} : { clouds })
    }
    print(JSON.stringify(all, null, 2))
    for (const goal of missed) console.error(`missed: ${goal}`)
    return
  }
  console.log(`${where.path} path on ${where.backend}\n`)
  printQuantities(quantities, statistics)
  printSun(sun)
  if (spectral !== undefined) printColors(spectral)
  if (clouds !== undefined) printClouds(clouds)
  for (const [name, list] of Object.entries(quantities)) printWorst(name, list, worst)
  console.log(missed.length === 0 ? '\nAll goals are met.' : '\nGoals missed:')
  for (const goal of missed) console.log(`  ${goal}`)
}

try {
  await main()
} catch (error) {
  console.error(`validate: ${error instanceof Error ? error.message : String(error)}`)
  console.error('npm run validate -- --help lists the options.')
  process.exitCode = 1
}
