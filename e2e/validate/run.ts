import { existsSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { parseArgs } from 'node:util'
import type { Backend } from '../gpu/harness/gpu-test'
import { printClouds, validateClouds } from './clouds'
import { evaluateInBrowser } from './evaluate'
import { colorRequest, compareColors, compareSky, compareSun, skyRequest } from './figures'
import type { ColorFigures, SkyComparisons } from './figures'
import { printColors, printQuantities, printSun, printWorst } from './print'
import { readColorReference, readSkyReference } from './reference'
import type { Path } from './request'
import { bandStatistics, type Comparison } from './score'

const usage = `npm run validate -- [options]

  --sky FILE                 spectral radiances, by default e2e/reference/sky.json
  --spectral FILE            sky colours, by default e2e/reference/spectral_sky.json
  --clouds FILE              clouds of simple shapes, by default e2e/reference/cloud_slab.json
  --backend webgpu|webgl     by default webgpu
  --path volume|march        how the air along a ray is found, by default volume
  --json                     print JSON alone
  --worst N                  also list the N largest errors of each quantity
  --check                    exit with 1 if a goal is missed`

function choice<T extends string>(name: string, value: string, choices: readonly T[]): T {
  if (choices.includes(value as T)) return value as T
  throw new Error(`--${name} must be ${choices.join(' or ')}, got '${value}'`)
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
  const results = await evaluateInBrowser(requests)

  const cloudsFile = input(values.clouds, 'cloud_slab.json')
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
  if (values.json) {
    const all = {
      ...statistics,
      ...(spectral === undefined ? {} : { spectral }),
      ...(clouds === undefined ? {} : { clouds })
    }
    print(JSON.stringify(all, null, 2))
    return
  }
  console.log(`${where.path} path on ${where.backend}\n`)
  let missed = printQuantities(quantities, statistics)
  printSun(sun)
  if (spectral !== undefined) missed += printColors(spectral)
  if (clouds !== undefined) missed += printClouds(clouds)
  for (const [name, list] of Object.entries(quantities)) printWorst(name, list, +values.worst)
  console.log(missed === 0 ? '\nAll goals are met.' : `\nGoals missed: ${missed}.`)
  if (values.check && missed > 0) process.exitCode = 1
}

try {
  await main()
} catch (error) {
  console.error(`validate: ${error instanceof Error ? error.message : String(error)}`)
  process.exitCode = 1
}
