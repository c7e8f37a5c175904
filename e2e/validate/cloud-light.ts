import { readFileSync } from 'node:fs'
import { dirname, join } from 'node:path'
import { gunzipSync } from 'node:zlib'
import type { CloudQualityName } from '@welkin/clouds'
import type { Backend } from '../harness/backend'
import type { CloudLightCase, CloudLightFigures } from './cloud-figures'
import { cloudLightGoal } from './goals'
import type { CloudLightRequest } from './page/cloud-light'
import { withPages } from './pages'
import { quantile } from './score'

/** Blocks along an edge of a picture. */
const BLOCKS = 12

/** Blocks darker than this part of a picture's brightest are left out. */
const NEGLIGIBLE = 0.02

/** Extinction that the largest byte of a field stands for [1/m]. */
const EXTINCTION = /^0\.16 v \/ 255,/
const LARGEST = 0.16

/** A file like `reference/cloud_light.json`. */
interface CloudLightFile {
  meta: {
    field: { file: string; extinction_per_m: string } & Record<
      'nx' | 'ny' | 'nz' | 'cell_m',
      number
    >
  }
  pictures: {
    sun_elevation_deg: number
    view_azimuth_deg: number
    view_down_deg: number
    half_width_m: number
    radiance: number[]
    stderr: number[]
  }[]
}

const sumOf = (values: readonly number[]): number => values.reduce((sum, value) => sum + value, 0)

/** Reads the pictures and the voxels beside them. @throws If the field is of another format. */
function readCloudLight(file: string): {
  pictures: CloudLightFile['pictures']
  voxels: CloudLightRequest['voxels']
} {
  const { meta, pictures } = JSON.parse(readFileSync(file, 'utf8')) as CloudLightFile
  const { field } = meta
  if (!EXTINCTION.test(field.extinction_per_m)) {
    throw new Error(`${file}: extinction must be 0.16 v / 255, got '${field.extinction_per_m}'`)
  }
  const { nx, ny, nz, cell_m: cell } = field
  const cells = gunzipSync(readFileSync(join(dirname(file), field.file)))
  if (cells.length !== nx * ny * nz) {
    throw new Error(`${field.file}: must have ${nx} × ${ny} × ${nz} cells, got ${cells.length}`)
  }
  for (const { radiance, stderr } of pictures) {
    if (radiance.length !== BLOCKS ** 2 || stderr.length !== BLOCKS ** 2) {
      throw new Error(`${file}: pictures must have ${BLOCKS} × ${BLOCKS} blocks`)
    }
  }
  return { pictures, voxels: { text: cells.toString('base64'), nx, ny, nz, cell, scale: LARGEST } }
}

/** Marches a cloud of voxels with the lighting code on the GPU. */
export async function validateCloudLight(
  file: string,
  backend: Backend,
  quality: CloudQualityName
): Promise<CloudLightFigures> {
  const { pictures, voxels } = readCloudLight(file)
  const request: CloudLightRequest = {
    backend,
    quality,
    voxels,
    blocks: BLOCKS,
    pictures: pictures.map(picture => ({
      sun: picture.sun_elevation_deg,
      azimuth: picture.view_azimuth_deg,
      down: picture.view_down_deg,
      halfWidth: picture.half_width_m
    }))
  }
  const drawn = await withPages('welkinCloudLight', async open =>
    (await open()).evaluate(asked => window.welkinCloudLight(asked), request)
  )
  const errors: number[] = []
  const noise: number[] = []
  const cases = pictures.map((picture, i): CloudLightCase => {
    const { radiance, stderr } = picture
    const least = NEGLIGIBLE * Math.max(...radiance)
    const scored = radiance.flatMap((value, k) => (value > least ? [k] : []))
    const signed = scored.map(k => drawn[i][k] / radiance[k] - 1)
    const absolute = signed.map(Math.abs)
    errors.push(...absolute)
    noise.push(...scored.map(k => stderr[k] / radiance[k]))
    return {
      sun: picture.sun_elevation_deg,
      view: { azimuth: picture.view_azimuth_deg, down: picture.view_down_deg },
      n: scored.length,
      median: quantile(absolute, 0.5),
      p90: quantile(absolute, 0.9),
      bias: quantile(signed, 0.5),
      total: sumOf(drawn[i]) / sumOf(radiance)
    }
  })
  return {
    n: errors.length,
    median: quantile(errors, 0.5),
    p90: quantile(errors, 0.9),
    stderr: quantile(noise, 0.5),
    cases
  }
}

const percent = (value: number): string => `${(100 * value).toFixed(1)} %`.padStart(9)

/** Prints the scores of all pictures. */
export function printCloudLight({ n, median, p90, stderr, cases }: CloudLightFigures): void {
  console.log('Light of a simulated cumulus, blocks of 12 × 12')
  console.log(`  ${'sun  view'.padEnd(28)}    n   median      p90     bias    total`)
  for (const { sun, view, ...row } of cases) {
    const name = `${String(sun).padStart(2)}°  ${view.azimuth}°, ${view.down}° down`
    const figures = [row.median, row.p90, row.bias, row.total].map(percent).join('')
    console.log(`  ${name.padEnd(28)}${String(row.n).padStart(5)}${figures}`)
  }
  console.log(`  ${'all'.padEnd(28)}${String(n).padStart(5)}${percent(median)}${percent(p90)}`)
  console.log(`  standard error of the reference ${percent(stderr).trim()}`)
  const worst = Math.max(...cases.map(one => one.median))
  const goals: [string, number, number][] = [
    ['median', median, cloudLightGoal.median],
    ['p90', p90, cloudLightGoal.p90],
    ['largest median of a picture', worst, cloudLightGoal.pictureMedian]
  ]
  for (const [name, value, limit] of goals) {
    console.log(`  goal: ${name} ≤ ${percent(limit).trim()} ${value <= limit ? '✓' : '✗'}`)
  }
  console.log()
}
