import { fileURLToPath } from 'node:url'
import type { Plugin } from 'vite'

const given = new URL('../gpu/harness/given-clouds.ts', import.meta.url)

/** The clouds' sampler, in whose place tests can put clouds of their own. */
const sampler = { '/density/tsl/sampler': given, '/density/tsl/samplePair': given }

/** Modules of the packages, by the end of their imports, and what pages of tests have in their place. */
const everything: Record<string, URL> = {
  '/diffuseLight/DiffuseLightTable': new URL('../gpu/harness/reuse-tables.ts', import.meta.url),
  '/noise/CloudNoise': new URL('../gpu/harness/reuse-noise.ts', import.meta.url),
  ...sampler
}

/**
 * Has the packages import classes of the tests' instead of their own, which extend them: tables and noise that
 * earlier tests have baked are taken over, by scenes of the stories, too, which know nothing of it.
 *
 * @param which - The sampler alone, for pages that bake what they need.
 */
export function replaceModules(which: 'all' | 'sampler' = 'all'): Plugin {
  const replacements: Record<string, URL> = which === 'all' ? everything : sampler
  const files = new Set(Object.values(replacements).map(url => fileURLToPath(url)))
  return {
    name: 'welkin:replace-modules',
    enforce: 'pre',
    resolveId(id, importer) {
      // The class that is extended is the package's own.
      if (importer === undefined || files.has(importer)) return undefined
      const end = Object.keys(replacements).find(name => id.endsWith(name))
      return end === undefined ? undefined : fileURLToPath(replacements[end])
    }
  }
}
