import { writeFileSync } from 'node:fs'
import type { ExtinctionGrid } from './form/grid'
import type { CloudFieldRequest } from './page/cloud-field'
import { withPages } from './pages'

/** Levels that the page draws at a time. */
const LEVELS = 4

/**
 * Fields that the GPU draws, on regular grids: one page answers all requests.
 *
 * @param take - Takes each grid; no further one is drawn after it has returned true.
 */
export async function drawCloudFields(
  requests: readonly CloudFieldRequest[],
  take: (grid: ExtinctionGrid, index: number) => boolean | void
): Promise<void> {
  await withPages('welkinOpenCloudField', async open => {
    const page = await open()
    for (const [index, request] of requests.entries()) {
      const { nx, ny, nz, z0 } = await page.evaluate(
        asked => window.welkinOpenCloudField(asked),
        request
      )
      const data = new Float32Array(nx * ny * nz)
      for (let first = 0; first < nz; first += LEVELS) {
        const text = await page.evaluate(n => window.welkinCloudFieldLevels(n), first)
        const levels = new Float32Array(Uint8Array.from(Buffer.from(text, 'base64')).buffer)
        for (let level = 0; level < Math.min(LEVELS, nz - first); level++) {
          const start = (first + level) * nx * ny
          for (let i = 0; i < nx * ny; i++) data[start + i] = levels[i * LEVELS + level]
        }
      }
      const grid = { nx, ny, nz, dx: request.cell, dz: request.cell, z0, data }
      if (take(grid, index) === true) break
    }
    await page.evaluate(() => window.welkinCloseCloudField())
  })
}

/** Fraction of columns with a vertical optical depth above 1/2. */
export function coverOf({ nx, ny, nz, dz, data }: ExtinctionGrid): number {
  const level = nx * ny
  let covered = 0
  for (let column = 0; column < level; column++) {
    let depth = 0
    for (let k = 0; k < nz; k++) depth += data[k * level + column] * dz
    if (depth > 0.5) covered++
  }
  return covered / level
}

/**
 * Writes a grid for other programs: float32 extinction [1/m] in z, y, x order as `NAME.raw`, and its
 * extents as `NAME.json`.
 */
export function writeGrid(name: string, grid: ExtinctionGrid): void {
  const { data, ...extents } = grid
  writeFileSync(`${name}.raw`, new Uint8Array(data.buffer, data.byteOffset, data.byteLength))
  writeFileSync(
    `${name}.json`,
    `${JSON.stringify({ ...extents, cover: coverOf(grid) }, null, 2)}\n`
  )
}
