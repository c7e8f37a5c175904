import { CloudLayer, cloudQualities } from '@welkin/clouds'
import { existsSync, readdirSync, readFileSync } from 'node:fs'
import { dirname, resolve } from 'node:path'
import { fileURLToPath } from 'node:url'
import { describe, expect, it } from 'vitest'
import { fillCloudLight } from '../../packages/clouds/src/light/cpu/cloudLightTable'
import { slabTableForm } from '../../packages/clouds/src/light/cpu/slabTableForm'
import { CloudLightTable } from '../../packages/clouds/src/light/CloudLightTable'
import { brightStars } from '../../packages/atmosphere/src/stars/brightStars'

const root = fileURLToPath(new URL('../..', import.meta.url))
const read = (file: string): string => readFileSync(resolve(root, file), 'utf8')
const pages = [
  'README.md',
  'CONTRIBUTING.md',
  ...['geo', 'atmosphere', 'clouds', 'terrain'].flatMap(name =>
    [`packages/${name}/README.md`, `packages/${name}/src/README.md`].filter(file =>
      existsSync(resolve(root, file))
    )
  )
]

const { scripts } = JSON.parse(read('package.json')) as { scripts: Record<string, string> }

/** Rows of the table below a heading, each a list of cells. */
function tableBelow(markdown: string, heading: string): string[][] {
  const section = markdown.split(`\n${heading}\n`)[1]?.split('\n## ')[0] ?? ''
  const rows = section.split('\n').filter(line => line.startsWith('|'))
  // The first two are its head.
  return rows.slice(2).map(row =>
    row
      .split('|')
      .slice(1, -1)
      .map(cell => cell.trim())
  )
}

describe.each(pages)('%s', file => {
  const text = read(file)

  it('names commands that exist', () => {
    const names = [...text.matchAll(/\bnpm run (?:--silent |-s )?([\w:-]+)/g)].map(
      ([, name]) => name
    )
    expect(names.filter(name => !(name in scripts))).toEqual([])
  })

  it('points at files that exist', () => {
    const links = [...text.matchAll(/\]\((?!https?:|#)([^)#]+)(?:#[^)]*)?\)/g)].map(([, to]) => to)
    const missing = links.filter(to => !existsSync(resolve(root, dirname(file), to)))
    expect(missing).toEqual([])
  })

  it('points at headings that exist', () => {
    const anchors = (markdown: string): string[] =>
      [...markdown.matchAll(/^#+ (.*)$/gm)].map(([, heading]) =>
        heading
          .toLowerCase()
          .replace(/[^\w\s-]/g, '')
          .replace(/\s/g, '-')
      )
    const links = [...text.matchAll(/\]\(([^)#:]*)#([^)]+)\)/g)]
    const broken = links.filter(([, to, anchor]) => {
      const target = to === '' ? file : resolve(root, dirname(file), to)
      const page = resolve(root, target)
      const markdown = page.endsWith('.md') ? page : resolve(page, 'README.md')
      return !anchors(readFileSync(markdown, 'utf8')).includes(anchor)
    })
    expect(broken.map(([link]) => link)).toEqual([])
  })
})

describe('figures of the root README', () => {
  const rows = tableBelow(read('README.md'), '## How good, how fast')

  it('name the command that prints them', () => {
    expect(rows.length).toBeGreaterThan(5)
    const without = rows.filter(cells => {
      const name = /^`npm run ([\w:-]+)/.exec(cells.at(-1)!)?.[1]
      return cells.length !== 3 || name === undefined || !(name in scripts)
    })
    expect(without).toEqual([])
  })
})

describe('stories', () => {
  const files = readdirSync(resolve(root, 'stories/src'))
    .filter(file => file.endsWith('.stories.ts'))
    .map(file => `stories/src/${file}`)

  it('are those of the root README', () => {
    const titles = files.map(file => /^\s+title: '(.*)'/m.exec(read(file))?.[1] ?? file)
    const listed = tableBelow(read('README.md'), '## Try it').map(([name]) => name)
    expect(listed.toSorted()).toEqual(titles.toSorted())
  })

  it('stand as high as their names say', () => {
    const code = files.map(read).join('\n')
    const pattern = /name: '[^']* from ([\d,]+) km',[^]*?altitude: ([\d_]+)/g
    const named = [...code.matchAll(pattern)]
    expect(named.length).toBeGreaterThan(0)
    for (const [, kilometres, metres] of named) {
      expect(Number(metres.replaceAll('_', ''))).toBe(1000 * Number(kilometres.replaceAll(',', '')))
    }
  })
})

describe('numbers that pages take from the code', () => {
  const clouds = read('packages/clouds/README.md')

  it('has the steps of the cloud light table', () => {
    const { positions, thicknesses, layers } = slabTableForm
    const data = new Float32Array(4 * positions * thicknesses * layers)
    const steps = [...fillCloudLight(new CloudLightTable().phase, data)].length
    expect(/in (\d+) steps of 2 to 5 ms/.exec(read('README.md'))?.[1]).toBe(`${steps}`)
    expect(/on the CPU meanwhile, in (\d+) steps of 2–5 ms/.exec(clouds)?.[1]).toBe(`${steps}`)
  })

  it('has the stars of the catalogue', () => {
    const stated = /has ([\d,]+) stars/.exec(read('packages/atmosphere/README.md'))?.[1]
    expect(stated).toBe(brightStars().length.toLocaleString('en'))
  })

  it('has the qualities as they are', () => {
    const rows = tableBelow(clouds, '## Quality and cost').filter(([name]) => /^`\w+`$/.test(name))
    const stated = Object.fromEntries(rows.map(([name, ...cells]) => [name, cells.slice(0, 4)]))
    const { low, medium, high, ultra } = cloudQualities
    for (const name of Object.keys(high) as (keyof typeof high)[]) {
      const values = [low, medium, high, ultra].map(quality => `${quality[name]}`)
      expect(stated[`\`${name}\``]).toEqual(values)
    }
  })

  it('has the defaults of layers and of the phase function', () => {
    const { wind, precipitation, ...layer } = new CloudLayer().parameters
    const own = { wind: `${wind.east} east`, precipitation: precipitation && 'some' }
    const parameters = { ...layer, ...new CloudLightTable().phase, ...own }
    const cells = [...tableBelow(clouds, '## Layers'), ...tableBelow(clouds, '## Droplets')]
    const defaults = Object.fromEntries(cells.map(row => [row[0], row.at(-2)!.replace('−', '-')]))
    const texts = Object.entries(parameters).map(([name, value]) => [
      `\`${name}\``,
      Array.isArray(value) ? value.join(', ') : `${value}`
    ])
    expect(defaults).toMatchObject(Object.fromEntries(texts))
  })

  it('has the blocks of the qualities', () => {
    const { low, medium, high, ultra } = cloudQualities
    expect([low.block, medium.block, high.block, ultra.block]).toEqual([6, 6, 5, 2])
    expect(clouds).toContain('6×6 (`low`, `medium`), 5×5 (`high`) or 2×2 (`ultra`)')
    expect(clouds).toContain('36 at `low` and `medium`, 25 at `high`, 4 at `ultra`')
  })
})
