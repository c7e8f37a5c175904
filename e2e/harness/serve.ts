import { createReadStream, statSync } from 'node:fs'
import { createServer } from 'node:http'
import type { AddressInfo } from 'node:net'
import { extname, join, normalize } from 'node:path'
import { answerFromStore, texelFolder } from './texelStore'

const contentTypes: Record<string, string> = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
  '.json': 'application/json',
  '.png': 'image/png',
  '.jpg': 'image/jpeg',
  '.jpeg': 'image/jpeg',
  '.glb': 'model/gltf-binary',
  '.wasm': 'application/wasm',
  '.svg': 'image/svg+xml'
}

/** A folder, and the URL path under which its files are served. */
export interface Mount {
  path: string
  folder: string
  /** True where pages may list files, and write new ones. */
  isStore?: boolean
}

export interface StaticServer {
  origin: string
  close: () => Promise<void>
}

const isFile = (path: string): boolean =>
  statSync(path, { throwIfNoEntry: false })?.isFile() ?? false

function resolveFile(mounts: Mount[], pathname: string): string | undefined {
  for (const { path, folder } of mounts) {
    const prefix = path.endsWith('/') ? path : `${path}/`
    if (!pathname.startsWith(prefix)) continue
    const relative = normalize(decodeURIComponent(pathname.slice(prefix.length)))
    if (relative.startsWith('..')) continue
    const file = join(folder, relative === '.' ? 'index.html' : relative)
    if (isFile(file)) return file
  }
  return undefined
}

/** Mount of texels that pages of tests keep for each other. */
export const texelMount = (): Mount => ({ path: '/texels/', folder: texelFolder(), isStore: true })

/** Serves folders on a free port of the loopback interface; the first mount with the file wins. */
export async function serveStatic(mounts: Mount[]): Promise<StaticServer> {
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url ?? '/', 'http://localhost')
    const store = mounts.find(({ isStore, path }) => isStore && pathname.startsWith(path))
    if (store !== undefined) {
      const name = pathname.slice(store.path.length)
      if (answerFromStore(store.folder, name, request, response)) return
    }
    const file = resolveFile(mounts, pathname)
    if (file === undefined) {
      response.writeHead(pathname === '/favicon.ico' ? 204 : 404).end()
      return
    }
    response.writeHead(200, {
      'Content-Type': contentTypes[extname(file)] ?? 'application/octet-stream',
      'Cache-Control': 'no-store'
    })
    createReadStream(file).pipe(response)
  })
  await new Promise<void>(resolve => {
    server.listen(0, '127.0.0.1', resolve)
  })
  const { port } = server.address() as AddressInfo
  return {
    origin: `http://127.0.0.1:${port}`,
    close: () =>
      new Promise(resolve => {
        server.close(() => resolve())
        server.closeAllConnections()
      })
  }
}
