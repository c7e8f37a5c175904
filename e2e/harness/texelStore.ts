import { createHash } from 'node:crypto'
import {
  createWriteStream,
  mkdirSync,
  readdirSync,
  readFileSync,
  renameSync,
  rmSync,
  statSync
} from 'node:fs'
import type { IncomingMessage, ServerResponse } from 'node:http'
import { join } from 'node:path'
import { fileURLToPath } from 'node:url'
import { describeChromium } from './browser'
import { outputFolder } from './report'

/** Longest that a run takes [ms]. */
const LONGEST_RUN = 2 * 3_600_000

const root = fileURLToPath(new URL('../..', import.meta.url))

/** Files and folders that texels are baked with. */
const makers = ['packages', 'e2e/gpu/harness', 'package-lock.json']

/** Paths of all sources in a folder, or of a file. */
function sourcesOf(path: string): string[] {
  if (/\.\w+$/.test(path)) return [path]
  return readdirSync(join(root, path), { recursive: true, encoding: 'utf8' })
    .map(file => `${path}/${file.replaceAll('\\', '/')}`)
    .filter(file => file.endsWith('.ts') && !/\/(node_modules|dist|test)\//.test(file))
    .toSorted()
}

/**
 * Folder of texels that pages of tests have baked, for other browsers, steps and runs: a new one where sources, packages or the
 * browser have changed. Those before it are removed as soon as no run can need them.
 */
export function texelFolder(): string {
  const hash = createHash('sha256').update(describeChromium())
  for (const file of makers.flatMap(sourcesOf)) {
    hash.update(file).update(readFileSync(join(root, file)))
  }
  const name = hash.digest('hex').slice(0, 16)
  const all = join(outputFolder, 'texels')
  mkdirSync(join(all, name), { recursive: true })
  for (const other of readdirSync(all)) {
    const isOld = Date.now() - statSync(join(all, other)).mtimeMs > LONGEST_RUN
    if (other !== name && isOld) rmSync(join(all, other), { recursive: true, force: true })
  }
  return join(all, name)
}

const PART = '.part'

/**
 * Answers a page that asks for the names of a store's files, or gives it a new one.
 *
 * @param name - Name of a file; empty for the list.
 * @returns False if it asks for something else.
 */
export function answerFromStore(
  folder: string,
  name: string,
  request: IncomingMessage,
  response: ServerResponse
): boolean {
  if (request.method === 'GET' && name === '') {
    const files = readdirSync(folder).filter(file => !file.endsWith(PART))
    response.writeHead(200, { 'Content-Type': 'application/json' }).end(JSON.stringify(files))
    return true
  }
  if (request.method !== 'PUT' || !/^[\w-]+$/.test(name)) return false
  const file = join(folder, name)
  // Nobody reads half of one.
  const part = createWriteStream(file + PART)
  part.on('error', () => response.writeHead(500).end())
  part.on('finish', () => {
    renameSync(file + PART, file)
    response.writeHead(204).end()
  })
  request.pipe(part)
  return true
}
