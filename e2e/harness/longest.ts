/**
 * Place of a job in a queue whose longest jobs come first: none is then begun when other workers end.
 *
 * @param longest - Beginnings of the names of long jobs, the longest first.
 */
export function rankOf(longest: readonly string[], name: string): number {
  const rank = longest.findIndex(start => name.startsWith(start))
  return rank === -1 ? longest.length : rank
}
