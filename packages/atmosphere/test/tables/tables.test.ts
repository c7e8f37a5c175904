import { afterEach, beforeEach, describe, expect, it } from 'vitest'
import type { Renderer } from 'three/webgpu'
import { AtmosphereParameters } from '@welkin/atmosphere'
import { diffuseTexel } from '../../src/diffuseLight/cpu/diffuseLight'
import { AtmosphereTables } from '../../src/tables/AtmosphereTables'

/** A renderer that draws nothing, and whose reads end when the test says so. */
function fakeRenderer() {
  const reads: { resolve: (pixels: Uint16Array) => void; reject: (error: Error) => void }[] = []
  const known: Record<string, unknown> = {
    isRenderer: true,
    backend: { isWebGPUBackend: true },
    readRenderTargetPixelsAsync: () =>
      new Promise((resolve, reject) => {
        reads.push({ resolve, reject })
      })
  }
  const renderer = new Proxy(known, {
    get: (target, name) => target[name as string] ?? (() => undefined)
  })
  return { renderer: renderer as unknown as Renderer, reads }
}

describe('AtmosphereTables', () => {
  const unhandled: unknown[] = []
  const note = (error: unknown): void => void unhandled.push(error)
  const settle = (): Promise<void> => new Promise(resolve => setTimeout(resolve, 5))

  beforeEach(() => {
    unhandled.length = 0
    process.on('unhandledRejection', note)
  })

  afterEach(() => {
    process.off('unhandledRejection', note)
  })

  const baked = () => {
    const { renderer, reads } = fakeRenderer()
    const tables = new AtmosphereTables()
    tables.update(renderer, new AtmosphereParameters(), 1, Infinity)
    expect(reads).toHaveLength(1)
    return { tables, read: reads[0] }
  }

  it('keeps quiet about a read that fails because they were disposed of', async () => {
    const { tables, read } = baked()
    const reading = tables.read()
    tables.dispose()
    read.reject(new Error('device lost'))
    await reading
    await settle()
    expect(tables.data).toBeNull()
    expect(unhandled).toEqual([])
  })

  it('tells whoever waits for a read that fails, and nobody else', async () => {
    const { tables, read } = baked()
    read.reject(new Error('device lost'))
    await settle()
    expect(unhandled).toEqual([])
    await expect(tables.read()).rejects.toThrow('device lost')
  })

  it('has numbers once they were read', async () => {
    const { tables, read } = baked()
    // Two tiles abreast and four down in the texture: the second row of the fourth begins with a 2.
    const [columns, rows, tiles] = [96, 16, 8]
    const texels = new Uint16Array(4 * columns * rows * tiles).fill(0x3c00)
    const texel = (rows + 1) * 2 * columns + columns
    expect(diffuseTexel(3, 0, 1)).toBe(texel)
    texels[4 * texel] = 0x4000
    read.resolve(texels)
    await tables.read()
    const values = new Float32Array(4 * columns * rows * tiles).fill(1)
    values[4 * texel] = 2
    expect(tables.data).toEqual({ values })
  })

  it('finishes a bake with what it began with, then bakes what changed meanwhile', () => {
    const { renderer, reads } = fakeRenderer()
    const tables = new AtmosphereTables()
    const parameters = new AtmosphereParameters()
    tables.update(renderer, parameters, 1, 3)
    parameters.set({ mieScaleHeight: 900 })
    tables.update(renderer, parameters, 1, 3)
    expect(tables.uniforms.mieScaleHeight.value).toBe(1200)
    expect(tables.version).toBe(0)
    tables.update(renderer, parameters, 1, Infinity)
    expect(tables.uniforms.mieScaleHeight.value).toBe(900)
    expect(tables.version).toBe(2)
    expect(reads).toHaveLength(2)
  })
})
