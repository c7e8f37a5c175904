import { AirStyle, Airglow, MilkyWay, Moon, Stars, SunFlare } from '@welkin/atmosphere'
import type { InstancedMesh, Object3D } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { expect, it, vi } from 'vitest'
import { openingState } from '../src/valley/openingState'
import { Valley, type ValleyState } from '../src/valley/Valley'

// Nothing is drawn: `npm run bench -- --only switches` compares pictures, on a GPU.
const renderer = { initRenderTarget: () => undefined } as unknown as WebGPURenderer
const valley = new Valley(renderer, { ...openingState, quality: 'low' })
const { air, atmosphere, pipeline, scene } = valley
const layers = () => [...air.clouds.field.layers].map(({ parameters }) => parameters)

const layerOf = <T extends object>(type: abstract new (...args: never[]) => T): T =>
  atmosphere.layers.find(layer => layer instanceof type) as unknown as T

/** Names of the types of nodes that the pipeline draws. */
function nodeTypes(): Set<string> {
  const types = new Set<string>()
  pipeline.outputNode.traverse(node => {
    types.add((node.constructor as unknown as { type: string }).type)
  })
  return types
}

const visible = (): Object3D[] => {
  const found: Object3D[] = []
  scene.traverseVisible(object => found.push(object))
  return found
}

/** Part of what is drawn that a switch turns off: its strength, 0 where it is off. */
const strengths: Partial<Record<keyof ValleyState, () => number>> = {
  clouds: () => Math.max(...layers().map(({ coverage }) => coverage)),
  cloudShadows: () => layers().filter(({ shadow }) => shadow).length,
  shafts: () => air.shafts.strength,
  haze: () => layerOf(AirStyle).haze,
  precipitation: () => Math.max(...layers().map(({ precipitation }) => precipitation?.rate ?? 0)),
  mist: () => Math.max(...layers().map(each => (each.topAltitude < 700 ? each.coverage : 0))),
  moon: () => layerOf(Moon).strength,
  stars: () => Math.max(layerOf(Stars).intensity, layerOf(MilkyWay).intensity),
  airglow: () => layerOf(Airglow).intensity,
  flare: () => Math.max(layerOf(SunFlare).innerStrength, layerOf(SunFlare).outerStrength),
  environment: () => scene.environmentIntensity,
  occlusion: () => Number(air.scenePass.contextNode !== null),
  bloom: () => Number(nodeTypes().has('BloomNode')),
  depthOfField: () => Number(nodeTypes().has('DepthOfFieldNode'))
}

it.each(Object.entries(strengths))('%s is switched on and off', (name, strength) => {
  const weather = ({ mist: 'mist', precipitation: 'storm' } as const)[name] ?? 'fair'
  // `nodeTypes` does not see past the texture that smooth edges read.
  const plain = { ...openingState, antialiasing: 'none' } as const
  valley.set({ ...plain, weather, quality: 'low', [name]: true }, true)
  const on = strength()
  expect(on).toBeGreaterThan(0)
  valley.set({ [name]: false }, true)
  expect(strength()).toBe(0)
  valley.set({ [name]: true }, true)
  expect(strength()).toBe(on)
})

it.each(['trees', 'village', 'water'] as const)('%s go and come', name => {
  valley.set({ ...openingState, quality: 'low' }, true)
  const before = visible()
  valley.set({ [name]: false })
  const without = visible()
  expect(without.length).toBeLessThan(before.length)
  valley.set({ [name]: true })
  expect(visible()).toEqual(before)
})

it.each([
  ['edges', 'SmoothEdgesNode'],
  ['fxaa', 'FXAANode'],
  ['smaa', 'SMAANode'],
  ['traa', 'TRAANode'],
  ['taau', 'TAAUNode']
] as const)('edges are smoothed by %s alone', (antialiasing, type) => {
  vi.stubGlobal('Image', EventTarget) // SMAA loads its tables as pictures
  valley.set({ ...openingState, quality: 'low', antialiasing })
  const all = ['SmoothEdgesNode', 'FXAANode', 'SMAANode', 'TRAANode', 'TAAUNode']
  expect(all.filter(each => nodeTypes().has(each))).toEqual([type])
  valley.set({ antialiasing: 'none' })
  expect(all.filter(each => nodeTypes().has(each))).toEqual([])
})

it('is finer by another quality, while it is shown', () => {
  const fineness = () => {
    let trees = 0
    scene.traverse(object => (trees += (object as Partial<InstancedMesh>).count ?? 0))
    return { trees, steps: air.clouds.quality.steps, shafts: air.shafts.quality }
  }
  valley.set({ ...openingState, quality: 'low' }, true)
  const low = fineness()
  valley.set({ quality: 'medium' })
  const medium = fineness()
  expect(medium.trees).toBeGreaterThan(low.trees)
  expect(medium.steps).toBeGreaterThan(low.steps)
  valley.set({ quality: 'low' })
  expect(fineness()).toEqual(low)
})
