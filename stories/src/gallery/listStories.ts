/** A story, as its file has it. */
export interface ListedStory {
  /** Storybook's name of it in addresses. */
  id: string
  name: string
  /** Sentence over it in the code. */
  about: string
  /** Name of its picture, among those of visual tests or in `stories/pictures`. */
  picture: string
}

/** Words of a name in capitals and small letters. */
const words = (name: string): string =>
  name.replace(/([a-z\d])([A-Z])/g, '$1 $2').replace(/([A-Z])([A-Z][a-z])/g, '$1 $2')

const dashed = (text: string): string =>
  text
    .toLowerCase()
    .replaceAll(/[^a-z\d]+/g, '-')
    .replaceAll(/^-|-$/g, '')

/**
 * Title of a file of stories, and its stories in order.
 *
 * @param file - Path of the file.
 * @param source - Its code.
 */
export function listStories(
  file: string,
  source: string
): { title: string; stories: ListedStory[] } {
  const base = file.split('/').at(-1)!.replace('.stories.ts', '')
  const title = /^\s+title: '(.*)'/m.exec(source)?.[1] ?? base
  const exported = source.matchAll(
    /(?:\/\*\* ((?:(?!\*\/)[^])*?) \*\/\n)?export const (\w+): Story\w*(?:<\w+>)? = (\{[^]*?\})\n(?=\n|$)/g
  )
  const stories = [...exported].map(([, about = '', key, body]) => ({
    id: `${dashed(title)}--${dashed(words(key))}`,
    name: /\bname: (['"])(.*?)\1/.exec(body)?.[2] ?? words(key),
    about: about.replaceAll(/\s*\n\s*\*?\s*/g, ' ').trim(),
    picture: `${base}-${key}`.toLowerCase()
  }))
  return { title, stories }
}
