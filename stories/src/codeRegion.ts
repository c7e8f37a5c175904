/** File beside the stories, and the name of a region in it. */
export type Region = readonly [file: string, name: string]

/** Code that stands in a region for readers alone, as a comment; and code that they do not see. */
const SHOWN = '// #shown '
const HIDDEN = ' // #hidden'

/**
 * The lines between `// #region NAME` and `// #endregion`, without their common indentation. `// #shown CODE` becomes CODE:
 * what a reader needs, and the story has from elsewhere. Lines that end in `// #hidden` are left out.
 *
 * @throws Error if the source has no such region.
 */
export function codeRegion(source: string, name: string): string {
  const lines = source.split('\n')
  const first = lines.findIndex(line => line.trim() === `// #region ${name}`) + 1
  const last = lines.findIndex((line, i) => i >= first && line.trim() === '// #endregion')
  if (first === 0 || last < 0) {
    throw new Error(`codeRegion: source must have a region '${name}'`)
  }
  const region = lines
    .slice(first, last)
    .filter(line => !line.endsWith(HIDDEN))
    .map(line => line.replace(SHOWN, ''))
  const indents = region.filter(line => line.trim() !== '').map(line => line.search(/\S/))
  const indent = Math.min(...indents)
  return region.map(line => line.slice(indent)).join('\n')
}

/** An import of names from a package. */
const IMPORT = /^import (type )?\{([^}]*)\} from '([^.'][^']*)'\n?/gm

/** Names that a source, or the code itself, imports from packages and the code mentions, by the package. */
function importsOf(source: string, code: string): Map<string, string[]> {
  const lines = `${source}\n${code}`.matchAll(IMPORT)
  const bare = code.replaceAll(IMPORT, '').replaceAll(/\/\/.*$|'[^']*'/gm, '')
  const used = new Map<string, string[]>()
  for (const [, type = '', names, from] of lines) {
    const list = names.split(',').map(name => name.trim())
    const mentioned = list.filter(name => {
      const plain = name.replace('type ', '')
      return plain !== '' && new RegExp(`(?<![.\\w])${plain}\\b(?!\\??:)`).test(bare)
    })
    const imported = mentioned.map(name => type + name.replace('type ', type === '' ? 'type ' : ''))
    if (imported.length > 0) used.set(from, [...(used.get(from) ?? []), ...imported])
  }
  return used
}

/**
 * Code of some regions, and before it what they import from packages.
 *
 * @param read - The source of a file.
 */
export function codeOf(regions: readonly Region[], read: (file: string) => string): string {
  const imports = new Map<string, Set<string>>()
  const parts = regions.map(([file, name]) => {
    const code = codeRegion(read(file), name)
    for (const [from, names] of importsOf(read(file), code)) {
      imports.set(from, new Set([...(imports.get(from) ?? []), ...names]))
    }
    return code.replaceAll(IMPORT, '').trimStart()
  })
  const lines = [...imports]
    .toSorted(([a], [b]) => a.localeCompare(b))
    .map(([from, names]) =>
      importLine(
        [...names].toSorted((a, b) => a.localeCompare(b)),
        from
      )
    )
  return [lines.join('\n'), ...parts].filter(part => part !== '').join('\n\n')
}

/** An import in lines that are short enough to be read. */
function importLine(names: readonly string[], from: string): string {
  const line = `import { ${names.join(', ')} } from '${from}'`
  return line.length <= 90 ? line : `import {\n  ${names.join(',\n  ')}\n} from '${from}'`
}
