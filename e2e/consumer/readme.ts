import { mkdirSync, readFileSync, writeFileSync } from 'node:fs'
import { join } from 'node:path'

/** The blocks of a Markdown text in a language, in order. */
export function codeBlocks(markdown: string, language = 'ts'): string[] {
  const blocks = markdown.matchAll(/^```(\w+)\n([^]*?)^```$/gm)
  return [...blocks].flatMap(([, name, code]) => (name === language ? [code] : []))
}

const documents = [
  'README.md',
  ...['geo', 'atmosphere', 'clouds', 'terrain'].map(p => `packages/${p}/README.md`)
]

/** Modules of the app's pages that are the first block of a document. */
const pages: Record<string, string | undefined> = {
  'README.md': 'main.ts',
  'packages/clouds/README.md': 'clouds.ts',
  'packages/terrain/README.md': 'terrain.ts'
}

/**
 * The document whose block of TSX is the module of the app's page with React. Those of others are modules that a page of the
 * app mounts.
 */
const fiberDocument = 'packages/atmosphere/README.md'

/** Names of the quick starts that the later blocks of their documents go on with. */
const given = `import type { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import type { CloudLayers, CloudsNode } from '@welkin/clouds'
import type { Terrain } from '@welkin/terrain'
import type { PerspectiveCamera, Scene } from 'three'
import type { Node, PassNode, RenderPipeline, TextureNode, WebGPURenderer } from 'three/webgpu'

declare global {
  const renderer: WebGPURenderer
  const scene: Scene
  const camera: PerspectiveCamera
  const atmosphere: Atmosphere
  const sun: SunDirectionalLight
  const sky: SkyLightProbe
  const layers: CloudLayers
  const cloudsNode: CloudsNode
  const scenePass: PassNode
  const depth: TextureNode
  const air: Node
  const picture: TextureNode
  const pipeline: RenderPipeline
  const terrain: Terrain
}
`

/**
 * Makes the quick starts of the documentation modules of the app's pages, and every block of code
 * a module that must compile.
 *
 * @param app - Folder of the app.
 * @returns Number of blocks.
 */
export function writeReadmeModules(root: string, app: string): number {
  const folder = join(app, 'src', 'readme')
  mkdirSync(folder)
  writeFileSync(join(folder, 'given.d.ts'), given)
  let count = 0
  for (const document of documents) {
    const markdown = readFileSync(join(root, document), 'utf8')
    const blocks = codeBlocks(markdown)
    if (blocks.length === 0) throw new Error(`${document} has no block of TypeScript`)
    const page = pages[document]
    if (page !== undefined) writeFileSync(join(app, 'src', page), blocks[0])
    blocks.forEach((code, i) => {
      const name = `${document.replaceAll(/\W/g, '-')}-${i + 1}.ts`
      writeFileSync(join(folder, name), `${code}\nexport {}\n`)
    })
    count += blocks.length
    const fiber = codeBlocks(markdown, 'tsx')
    count += fiber.length
    if (document !== fiberDocument) {
      fiber.forEach(code =>
        writeFileSync(join(folder, `${document.replaceAll(/\W/g, '-')}.tsx`), code)
      )
    } else {
      if (fiber.length !== 1) throw new Error(`${document} must have one block of TSX`)
      writeFileSync(join(app, 'src', 'fiber.tsx'), fiber[0])
      // The quick start has no types of its own: to a bundler it is JavaScript.
      writeFileSync(join(app, 'webpack-entry.js'), blocks[0])
    }
  }
  return count
}
