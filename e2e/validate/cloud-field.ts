import { writeFileSync } from 'node:fs'
import type { ExtinctionGrid } from './form/grid'
import type { CloudFieldRequest } from './page/cloud-field'
import { withPages } from './pages'

/** Fields that the GPU draws, on regular grids: one page answers all requests. */
export async function drawCloudFields(
  requests: readonly CloudFieldRequest[],
  take: (grid: ExtinctionGrid, index: number) => void
): Promise<void> {
  await withPages('welkinOpenCloudField', async open => {
    for (const [index, request] of requests.entries()) {
      const page = await open()
      const { nx, ny, nz, z0 } = await page.evaluate(
        asked => window.welkinOpenCloudField(asked),
        request
      )
      const data = new Float32Array(nx * ny * nz)
      for (let level = 0; level < nz; level++) {
        const text = await page.evaluate(n => window.welkinCloudFieldLevel(n), level)
        const bytes = Uint8Array.from(Buffer.from(text, 'base64'))
        data.set(new Float32Array(bytes.buffer), level * nx * ny)
      }
      await page.evaluate(() => window.welkinCloseCloudField())
      await page.close()
      take({ nx, ny, nz, dx: request.cell, dz: request.cell, z0, data }, index)
    }
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
