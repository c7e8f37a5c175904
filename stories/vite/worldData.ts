import { createReadStream, existsSync, readdirSync, readFileSync, statSync } from 'node:fs'
import { createRequire } from 'node:module'
import { dirname, join, relative, sep } from 'node:path'
import { fileURLToPath } from 'node:url'
import type { Plugin } from 'vite'
import { ensureTerrain } from '../scripts/make-terrain.ts'

const TYPES: Record<string, string> = {
  glb: 'model/gltf-binary',
  jpg: 'image/jpeg',
  json: 'application/json',
  png: 'image/png',
  xml: 'application/xml'
}

const DATA = fileURLToPath(new URL('../data/', import.meta.url))

/** Path under the site's root of everything that the stories load. */
const PREFIX = 'world-data'

function imageryDirectory(): string {
  const engine = dirname(createRequire(import.meta.url).resolve('@cesium/engine/package.json'))
  return join(engine, 'Source/Assets/Textures/NaturalEarthII')
}

/** Files of directories that hold more: pictures of the whole Earth (colours, open water, lights; clouds), simulated clouds, heights. */
const PARTS: Record<string, string[]> = {
  earth: ['earth-blue-marble.jpg', 'earth-water.png', 'earth-night.jpg'],
  clouds: ['clouds.png'],
  simulated: ['simulated-clouds.bin'],
  heights: ['jacksboro-dem.i16.gz', 'jacksboro-dem.json']
}

function exampleDirectory(name: string): string {
  const entry = createRequire(import.meta.url).resolve('three-globe')
  return join(dirname(dirname(entry)), 'example', name)
}

function filesUnder(directory: string): string[] {
  return readdirSync(directory, { recursive: true, withFileTypes: true })
    .filter(entry => entry.isFile())
    .map(entry => join(entry.parentPath, entry.name))
}

/**
 * Serves the stories' local data in development and adds it to a build: no network is needed for either.
 *
 * `world-data/simulated/` and `world-data/heights/` are in `data/`; `world-data/earth/` and `world-data/clouds/` are pictures in the `three-globe` package; `world-data/natural-earth/` is the
 * imagery in the `@cesium/engine` package; `world-data/terrain/` is made here from the heights in `data/`, the first time and
 * whenever they or the script change.
 */
export function worldData(): Plugin {
  const directories = new Map<string, string>()
  return {
    name: 'welkin-world-data',
    buildStart() {
      directories.set('natural-earth', imageryDirectory())
      directories.set('terrain', ensureTerrain())
      directories.set('earth', exampleDirectory('img'))
      directories.set('clouds', exampleDirectory('clouds'))
      directories.set('simulated', DATA)
      directories.set('heights', DATA)
    },
    configureServer(server) {
      server.middlewares.use((request, response, next) => {
        const path = new URL(request.url ?? '/', 'http://localhost').pathname
        const match = /\/world-data\/([\w-]+)\/([\w./-]+)$/.exec(path)
        const directory = match === null ? undefined : directories.get(match[1])
        if (match === null || directory === undefined || match[2].includes('..')) {
          next()
          return
        }
        const file = join(directory, match[2])
        if (!existsSync(file) || !statSync(file).isFile()) {
          response.statusCode = 404
          response.end()
          return
        }
        response.setHeader(
          'Content-Type',
          TYPES[file.slice(file.lastIndexOf('.') + 1)] ?? 'application/octet-stream'
        )
        createReadStream(file).pipe(response)
      })
    },
    generateBundle() {
      for (const [name, directory] of directories) {
        const files = PARTS[name]?.map(picture => join(directory, picture)) ?? filesUnder(directory)
        for (const file of files) {
          const path = relative(directory, file).split(sep).join('/')
          this.emitFile({
            type: 'asset',
            fileName: `${PREFIX}/${name}/${path}`,
            source: readFileSync(file)
          })
        }
      }
    }
  }
}
