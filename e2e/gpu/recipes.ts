import { readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import type { Plugin } from 'vite'
import { codeBlocks } from '../consumer/readme'

const README = fileURLToPath(new URL('../../packages/atmosphere/README.md', import.meta.url))
const SECTION = "## With three's post effects"
const NAME = 'virtual:recipes'

/** Statements and imports of a block of code. */
function split(code: string): { imports: string[]; body: string } {
  const imports = code.match(/^import .*$/gm) ?? []
  return { imports, body: code.replaceAll(/^import .*\n/gm, '') }
}

/**
 * Module of the recipes in the README, each a function that makes its pipeline. The first block of the section is the
 * beginning of all others.
 *
 * @throws Error if the README has no such section.
 */
function recipesModule(markdown: string): string {
  const section = markdown.split(SECTION)[1]?.split('\n## ')[0] ?? ''
  const [first, ...recipes] = codeBlocks(section).map(split)
  if (recipes.length === 0) throw new Error(`${SECTION} of the README must have recipes`)
  const imports = new Set([first, ...recipes].flatMap(block => block.imports))
  const named = [...imports].flatMap(line => {
    const [, names, from] = /^import \{ (.*) \} from '(.*?)'/.exec(line) ?? []
    return names.split(', ').map(name => `import { ${name} } from '${from}'`)
  })
  const functions = recipes.map(
    ({ body }) => `({ renderer, scene, camera, atmosphere }) => {
      ${first.body}
      ${body}
      return { pipeline, scenePass }
    }`
  )
  return `${[...new Set(named)].join('\n')}\nexport const recipes = [${functions.join(',\n')}]`
}

/** Has tests import the recipes for three's post effects that are in the README, from `virtual:recipes`. */
export function recipesPlugin(): Plugin {
  return {
    name: 'welkin:recipes',
    resolveId: id => (id === NAME ? `\0${NAME}` : undefined),
    load: id => (id === `\0${NAME}` ? recipesModule(readFileSync(README, 'utf8')) : undefined)
  }
}
