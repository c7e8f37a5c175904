import { mkdirSync, readFileSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'

/** The TypeScript blocks of a Markdown text, in order. */
export function codeBlocks(markdown: string): string[] {
  return [...markdown.matchAll(/^```ts\n([^]*?)^```$/gm)].map(([, code]) => code)
}

const documents = [
  'README.md',
  ...['geo', 'atmosphere', 'clouds'].map(p => `packages/${p}/README.md`)
]

/** Names of the quick start that the later blocks of its document go on with. */
const given = `import type { Atmosphere, SunDirectionalLight } from '@welkin/atmosphere'
import type { PerspectiveCamera, Scene } from 'three'
import type { WebGPURenderer } from 'three/webgpu'

declare global {
  const renderer: WebGPURenderer
  const scene: Scene
  const camera: PerspectiveCamera
  const atmosphere: Atmosphere
  const sun: SunDirectionalLight
}
`

/**
 * Makes the quick start of the documentation the app's main module, and every other block of code
 * a module that must compile.
 *
 * @param app - Folder of the app.
 * @returns How many blocks there are.
 */
export function writeReadmeModules(root: string, app: string): number {
  const folder = join(app, 'src', 'readme')
  mkdirSync(folder)
  writeFileSync(join(folder, 'given.d.ts'), given)
  let count = 0
  for (const document of documents) {
    const blocks = codeBlocks(readFileSync(join(root, document), 'utf8'))
    if (blocks.length === 0) throw new Error(`${document} has no block of TypeScript`)
    if (document === 'README.md') writeFileSync(join(app, 'src', 'main.ts'), blocks[0])
    blocks.forEach((code, i) => {
      const name = `${document.replaceAll(/\W/g, '-')}-${i + 1}.ts`
      writeFileSync(join(folder, name), `${code}\nexport {}\n`)
    })
    count += blocks.length
  }
  return count
}
