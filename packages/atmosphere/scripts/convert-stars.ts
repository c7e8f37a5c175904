// Makes src/stars/brightStarData.ts from the star catalogue of d3-celestial, 5,044 stars to magnitude 6.
// Run it with: npm pack d3-celestial@0.7.35 && tar xzf d3-celestial-0.7.35.tgz
//   && npx tsx packages/atmosphere/scripts/convert-stars.ts package/data/stars.6.json
import { readFileSync, writeFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { BYTES_PER_STAR, encodeStar } from '../src/stars/starEncoding'

interface Feature {
  properties: { mag: number; bv: string }
  geometry: { coordinates: [longitude: number, latitude: number] }
}

/** Of the two stars of the catalogue with no colour index, which are white as most are [mag]. */
const USUAL_COLOR_INDEX = 0.3

const input = process.argv[2]
if (input === undefined) throw new Error('convert-stars: the path of stars.6.json is missing')
const { features } = JSON.parse(readFileSync(input, 'utf8')) as { features: Feature[] }
// The brightest first, so that a shorter catalogue is the front of this one.
const sorted = features.toSorted((a, b) => a.properties.mag - b.properties.mag)
const bytes = new Uint8Array(sorted.length * BYTES_PER_STAR)
sorted.forEach(({ properties: { mag, bv }, geometry: { coordinates } }, i) => {
  const star = {
    ascension: ((coordinates[0] + 360) % 360) * (Math.PI / 180),
    declination: coordinates[1] * (Math.PI / 180),
    magnitude: mag,
    colorIndex: bv === '' ? USUAL_COLOR_INDEX : Number(bv)
  }
  encodeStar(star, bytes, i)
})
const text = Buffer.from(bytes).toString('base64')
const file = fileURLToPath(new URL('../src/stars/brightStarData.ts', import.meta.url))
writeFileSync(
  file,
  `/*! Star catalogue of d3-celestial, Copyright (c) 2015, Olaf Frohn, BSD-3-Clause: see src/stars/LICENSE-d3-celestial.txt */

/** Made by scripts/convert-stars.ts; \`starCode.ts\` says how to read it. Base64. */
export const brightStarData =
  '${text}'
`
)
console.log(`${sorted.length} stars, ${(text.length / 1000).toFixed(1)} kB`)
