import type { Plugin } from 'vite'

/** Sizes of maps, by the end of their module's path: the line that has it, and what changes it. */
const sizes = [
  {
    module: '/clouds/src/shadow/CascadeState.ts',
    line: 'export const CASCADE_SIZE = 256',
    setter: 'setCascadeSize'
  },
  {
    module: '/clouds/src/density/WeatherMap.ts',
    line: 'const SIZE = 384',
    setter: 'setWeatherSize'
  }
]

/**
 * Lets `globalThis.setCascadeSize` and `globalThis.setWeatherSize` change the sizes of the clouds' shadow maps and of their map of the
 * weather that are made from then on: a software renderer takes half a minute for the users' 256² texels of shadows of a scene with
 * everything, and seconds for a map of rain.
 */
export function shadowSizePlugin(): Plugin {
  return {
    name: 'welkin:shadow-size',
    enforce: 'pre',
    transform(code, id) {
      const path = id.replaceAll('\\', '/')
      const found = sizes.find(({ module }) => path.endsWith(module))
      if (found === undefined) return undefined
      const { module, line, setter } = found
      if (!code.includes(line)) throw new Error(`no '${line}' in ${module}`)
      const name = /const (\w+)/.exec(line)![1]
      const changed = code.replace(
        line,
        `${line.replace('const', 'let')}
;(globalThis as any).${setter} = (size: number) => { ${name} = size }`
      )
      return { code: changed, map: null }
    }
  }
}
