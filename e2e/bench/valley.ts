import { AgXToneMapping, RenderTarget } from 'three'
import { writeFileSync, mkdirSync } from 'node:fs'
import { PNG } from 'pngjs'
import { HeadlessDevice, nextFrame, gpuMilliseconds, gpuPasses } from '../headless/device'
import { Valley } from '../../stories/src/valley/Valley'
import { groundHeight } from '../../stories/src/valley/ground'

const [w, h, n, quality, ...names] = process.argv.slice(2)
const size = [Number(w), Number(h)] as const
const device = await HeadlessDevice.open()
const renderer = await device.renderer(...size)
renderer.toneMapping = AgXToneMapping
renderer.shadowMap.enabled = true
const out = process.env.OUT ?? '/tmp/valley'
mkdirSync(out, { recursive: true })
const base = { weather: 'fair', latitude: 46, season: 0.2, hour: 10, dayLength: 3600, paused: true, quality, clouds: true, shafts: true, mist: true, nightSky: true, trees: true, village: true, water: true, bloom: true } as any
const shots: any = {
  noon: { hour: 11.5 },
  afternoon: { hour: 16.5, weather: 'broken' },
  dawn: { hour: 4.9, weather: 'mist' },
  sunset: { hour: 19.1 },
  dusk: { hour: 19.9, weather: 'broken' },
  night: { hour: 23.5, season: 0.225 },
  overcast: { hour: 13, weather: 'overcast' },
  high: { hour: 9, at: [-900, 1250, 3200], to: [0, 300, -3000] },
  lake: { hour: 8.2, at: [120, 1.7, -330], to: [60, 120, -3000] }
}
const valley = new Valley(renderer, base)
const home = valley.camera.position.clone()
valley.camera.aspect = size[0] / size[1]
valley.camera.updateProjectionMatrix()
const target = new RenderTarget(...size)
await valley.bake(renderer)
valley.time = 100
for (const name of names.length ? names : Object.keys(shots)) {
  const { at, to, ...state } = shots[name]
  valley.set({ ...base, ...state }, true)
  valley.camera.position.set(...((at ?? home.toArray()) as [number, number, number]))
  if (at) valley.camera.position.y = Math.max(at[1], groundHeight(at[0], at[2]) + 1.7)
  valley.camera.lookAt(...((to ?? [330, 75, -1500]) as [number, number, number]))
  let ms = 0
  for (let i = 0; i < Number(n); i++) {
    nextFrame()
    renderer.setRenderTarget(target)
    valley.render(0.016)
    renderer.setRenderTarget(null)
    ms = await gpuMilliseconds(renderer)
    if (i < 12) await valley.exposure.settle()
  }
  console.log(name, 'ms', ms.toFixed(2), gpuPasses(renderer).map(p => p.toFixed(2)).join(' '))
  const data = (await renderer.readRenderTargetPixelsAsync(target, 0, 0, ...size)) as Uint8Array
  const png = new PNG({ width: size[0], height: size[1] })
  png.data = Buffer.from(data)
  for (let i = 3; i < png.data.length; i += 4) png.data[i] = 255
  writeFileSync(`${out}/${name}.png`, PNG.sync.write(png))
}
valley.dispose()
process.exit(0)
