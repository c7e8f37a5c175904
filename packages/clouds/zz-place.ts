import { Vector3 } from 'three'
import { CloudLayer } from './src/CloudLayer'
import { weatherAt } from './src/cpu/density'
import { NoiseTextures } from './src/cpu/noiseTextures'
import { layerTurn } from './src/lattice'
import { cloudPreset } from './src/presets'
const noise = new NoiseTextures()
for (const [n, lon, lat] of [['meadow', -84.178, 36.622], ['terrain', -84.15, 36.45], ['20,45', 20, 45],['-120,45',-120,45]] as any) {
  const out: string[] = []
  for (const preset of ['fairWeather', 'stratocumulus', 'cumulonimbus', 'cirrus'] as const) {
    const p = cloudPreset(preset).at(0).parameters
    const state = { layers: [new CloudLayer(p).parameters], turns: [layerTurn(0)], bottomRadius: 6_360_000, pixelAngle: 0.001 }
    const a = lon * Math.PI / 180, b = lat * Math.PI / 180
    const at = new Vector3(Math.cos(a) * Math.cos(b), Math.sin(a) * Math.cos(b), Math.sin(b)).multiplyScalar(6_360_000)
    out.push(`${preset} ${p.coverage}: ${[3e6, 1e7, 4e7].map(d => weatherAt(state, noise, 0, at, d).cover.toFixed(2))}`)
  }
  console.log(n, out.join('; '))
}
