import { fileURLToPath } from 'node:url'
import type { Plugin } from 'vite'

/** Modules of the packages, by the end of their imports, and what pages of tests have in their place. */
const replacements: Record<string, URL> = {
  '/diffuseLight/DiffuseLightTable': new URL('../gpu/harness/reuse-tables.ts', import.meta.url),
  '/transmittance/TransmittanceTable': new URL('../gpu/harness/reuse-tables.ts', import.meta.url),
  '/noise/CloudNoise': new URL('../gpu/harness/reuse-noise.ts', import.meta.url),
  '/MoonSurfaceMap': new URL('../gpu/harness/reuse-moon.ts', import.meta.url)
}

const files = new Set(Object.values(replacements).map(url => fileURLToPath(url)))

/**
 * Has the packages import classes of the tests' instead of their own, which extend them: tables and noise that
 * earlier tests have baked are taken over, by scenes of the stories, too, which know nothing of it.
 */
export function replaceModules(): Plugin {
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
