/**
 * The lines between `// #region NAME` and `// #endregion`, without their common indentation.
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
  const region = lines.slice(first, last)
  const indents = region.filter(line => line.trim() !== '').map(line => line.search(/\S/))
  const indent = Math.min(...indents)
  return region.map(line => line.slice(indent)).join('\n')
}
