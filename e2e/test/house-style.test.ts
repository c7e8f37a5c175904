import { readFileSync, readdirSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { expect, it } from 'vitest'

const root = fileURLToPath(new URL('../..', import.meta.url))

/** TypeScript files of the repository by path, with their text. */
const sources = ['packages', 'stories', 'e2e', 'scripts'].flatMap(folder =>
  readdirSync(`${root}/${folder}`, { recursive: true, encoding: 'utf8' })
    .filter(file => file.endsWith('.ts') && !/(^|\/)(node_modules|dist|output)\//.test(file))
    .map(file => {
      const path = `${folder}/${file.replaceAll('\\', '/')}`
      return { path, text: readFileSync(`${root}/${path}`, 'utf8') }
    })
)
const published = sources.filter(({ path }) => /^packages\/[^/]+\/src\//.test(path))

/** Lines that a file may have: shader functions about 200, nodes about 350, anything 500. */
function mostLines(path: string): number {
  if (!path.includes('/src/')) return 500
  return path.includes('/tsl/') ? 210 : 350
}

it('no file is longer than a reader takes in', () => {
  const long = sources
    .map(({ path, text }) => ({ path, lines: text.split('\n').length - 1 }))
    .filter(({ path, lines }) => lines > mostLines(path))
    .map(({ path, lines }) => `${path}: ${lines} lines of ${mostLines(path)}`)
  expect(long).toEqual([])
})

it('docs name their thing first', () => {
  const start = /\/\*\*[\s*]*|@param [\w.[\]]+ - |@returns /.source
  const first =
    /(?:Of|By|What|Where|Whether|Whose|How|Which|So|The same|From|Among|Is|Those)\b[^\n]*/.source
  const opening = new RegExp(`(?:${start})${first}`, 'g')
  const hidden = sources.flatMap(({ path, text }) =>
    [...text.matchAll(opening)].map(([doc]) => `${path}: ${doc.replaceAll(/\s+/g, ' ')}`)
  )
  expect(hidden).toEqual([])
})

it('tests and twins stay out of what is published', () => {
  const crossing = published.flatMap(({ path, text }) =>
    [...text.matchAll(/from '(\.[^']*)'/g)]
      .filter(([, name]) => /(^|\/)(test|scripts|e2e|stories)\//.test(name))
      .map(([, name]) => `${path} imports ${name}`)
  )
  expect(crossing).toEqual([])
})

it('what only tests use stays out of what is published', () => {
  const codes = published.map(({ path, text }) => ({
    path,
    code: text.replaceAll(/\/\*[^]*?\*\/|\/\/.*/g, '')
  }))
  const uses = new Map<string, number>()
  for (const { code } of codes) {
    for (const [word] of code.matchAll(/\w+/g)) uses.set(word, (uses.get(word) ?? 0) + 1)
  }
  const unused = codes.flatMap(({ path, code }) =>
    [...code.matchAll(/^export (?:async )?(?:const|function\*?|class) (\w+)/gm)]
      .filter(([, name]) => uses.get(name) === 1)
      .map(([, name]) => `${path}: ${name}`)
  )
  // The catalogue of stars is written by a script, with what reads it beside.
  expect(unused).toEqual(['packages/atmosphere/src/stars/starEncoding.ts: encodeStar'])
})

it('imports only public entry points of three', () => {
  const entries = /^three(\/webgpu|\/tsl|\/addons\/.*)?$/
  const inner = sources.flatMap(({ path, text }) =>
    [...text.matchAll(/from '(three[^']*)'/g)]
      .filter(([, name]) => !entries.test(name))
      .map(([, name]) => `${path} imports ${name}`)
  )
  expect(inner).toEqual([])
})

/** Papers of which nobody here has looked up the place yet; none may be added. */
const unplaced = [
  'Baumbach 1937',
  'Pollack et al. 1995',
  'Sneep & Ubachs 2005',
  'Tomasko et al. 1999'
]

/**
 * Section, equation, table, figure, page or slide; a heading, which is a second title in quotes; a function. Bruneton's
 * paper of 2017 is code with headings.
 */
const place =
  /§|\b(eqs?|fig|vol)\. |\bpp?\. \d|\b([Tt]able|slide|chapter|appendix|part|supplement)s?\b|"[^"]*"[^"]*"|`|^Bruneton 2017, "/

it('papers are cited with the place in them', () => {
  const cited = published.flatMap(({ path, text }) =>
    [...text.matchAll(/@see ([^]*?)(?=\*\/|\n\s*\* @|\n\s*\*\n)/g)]
      // "After" those from whom the source has it.
      .flatMap(([, see]) => see.replaceAll(/\s*\n\s*\*\s*/g, ' ').split(/; |, after [^;]*/))
      .map(source => ({ path, source: source.trim() }))
  )
  // A paper is an author and a year.
  const papers = cited.filter(({ source }) => /^\p{Lu}[^"§]*\b(1[6-9]|20)\d\d\b/u.test(source))
  const lacking = papers.filter(({ source }) => !place.test(source))
  const added = lacking.filter(({ source }) => !unplaced.some(name => source.startsWith(name)))
  expect(added).toEqual([])
  const found = unplaced.filter(name => !lacking.some(({ source }) => source.startsWith(name)))
  expect(found).toEqual([])
})
