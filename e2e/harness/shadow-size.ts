import type { Plugin } from 'vite'

const MODULE = '/clouds/src/shadow/CascadeState.ts'
const CONSTANT = 'export const CASCADE_SIZE = 256'

/**
 * Lets `globalThis.setCascadeSize` change the size of the clouds' shadow maps that are made from then on: a
 * software renderer takes half a minute for the users' 256² texels of a scene with everything.
 */
export function shadowSizePlugin(): Plugin {
  return {
    name: 'welkin:shadow-size',
    enforce: 'pre',
    transform(code, id) {
      if (!id.replaceAll('\\', '/').endsWith(MODULE)) return undefined
      if (!code.includes(CONSTANT)) throw new Error(`no '${CONSTANT}' in ${MODULE}`)
      const changed = code.replace(
        CONSTANT,
        `${CONSTANT.replace('const', 'let')}
;(globalThis as any).setCascadeSize = (size: number) => { CASCADE_SIZE = size }`
      )
      return { code: changed, map: null }
    }
  }
}
