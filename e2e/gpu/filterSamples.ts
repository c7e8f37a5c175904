import type { Plugin } from 'vite'

/** Uses of the numbers of samples in three's filter of environments, as its bundle of nodes has them. */
const USES = [
  'uint( GGX_SAMPLES )',
  '6 / ( GGX_SAMPLES *',
  'uniform( INTEGRATION_SIZE,',
  'size / INTEGRATION_SIZE'
]

/**
 * Has three's filter of environments take its number of samples, and the edge of the faces that it sums up for what is rough, from
 * `globalThis.filterSamples`.
 */
export function filterSamplesPlugin(): Plugin {
  return {
    name: 'welkin:filter-samples',
    transform(code, id) {
      if (!id.includes('/three/build/') || !USES.every(use => code.includes(use))) return undefined
      const changed = USES.reduce((made, use) => {
        const chosen = use
          .replace('GGX_SAMPLES', '( globalThis.filterSamples?.samples ?? GGX_SAMPLES )')
          .replace('INTEGRATION_SIZE', '( globalThis.filterSamples?.edge ?? INTEGRATION_SIZE )')
        return made.replace(use, chosen)
      }, code)
      return { code: changed, map: null }
    }
  }
}
