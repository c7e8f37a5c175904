/**
 * Names of a part's rows that are asked for; all of them if there is no word.
 *
 * @param part - Name of the part.
 * @param isNamed - True if a word names a row; by default it is the name.
 * @throws If a word names none.
 */
export function rowsOf<Name extends string>(
  part: string,
  names: readonly Name[],
  words: readonly string[],
  isNamed: (name: Name, word: string) => boolean = (name, word) => name === word
): ReadonlySet<Name> {
  const unknown = words.find(word => !names.some(name => isNamed(name, word)))
  if (unknown !== undefined) {
    const all = [...new Set(names)].join('; ')
    throw new Error(`bench: --rows of ${part} are ${all}; got '${unknown}'`)
  }
  const isAsked = (name: Name): boolean =>
    words.length === 0 || words.some(word => isNamed(name, word))
  return new Set(names.filter(isAsked))
}
