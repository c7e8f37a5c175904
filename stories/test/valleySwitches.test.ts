import { AirStyle, Airglow, MilkyWay, Moon, Stars, SunFlare } from '@welkin/atmosphere'
import { Texture } from 'three'
import type { InstancedMesh, Object3D } from 'three'
import type { TextureNode, WebGPURenderer } from 'three/webgpu'
import { expect, it, vi } from 'vitest'
import { FadingBow } from '../src/valley/FadingBow'
import { openingState } from '../src/valley/openingState'
import { Valley, type ValleyState } from '../src/valley/Valley'
import type { ValleyFactors } from '../src/valleyFactors'

// Nothing is drawn: `npm run bench -- --only switches` compares pictures, on a GPU.
const renderer = { initRenderTarget: () => undefined } as unknown as WebGPURenderer
const bow = vi.spyOn(FadingBow.prototype, 'strength', 'set')
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

/** Names of the textures that the pipeline reads: a target's, and which of its textures. */
function textureNames(): Set<string> {
  const names = new Set<string>()
  pipeline.outputNode.traverse(node => {
    const { value } = node as Partial<TextureNode>
    if (value instanceof Texture) names.add(value.name)
  })
  return names
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
  rainbow: () => bow.mock.lastCall![0],
  mist: () => Math.max(...layers().map(each => (each.topAltitude < 700 ? each.coverage : 0))),
  moon: () => layerOf(Moon).strength,
  stars: () => layerOf(Stars).intensity,
  milkyWay: () => layerOf(MilkyWay).intensity,
  airglow: () => layerOf(Airglow).intensity,
  flare: () => Math.max(layerOf(SunFlare).innerStrength, layerOf(SunFlare).outerStrength),
  environment: () => scene.environmentIntensity,
  occlusion: () => Number(air.scenePass.contextNode !== null),
  localExposure: () => Number(textureNames().has('LocalExposure.0')),
  bloom: () => Number(nodeTypes().has('BloomNode')),
  depthOfField: () => Number(nodeTypes().has('DepthOfFieldNode')),
  // Bloom, which is on, reads the blurred picture.
  motionBlur: () => Number(textureNames().has('MotionBlur.0'))
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

/** Artistic factors, and what each of them sets. */
const factors: Record<keyof ValleyFactors, () => number> = {
  hazeStrength: () => layerOf(AirStyle).haze,
  twilightSaturation: () => layerOf(AirStyle).twilightSaturation,
  shaftStrength: () => air.shafts.strength,
  starlight: () => layerOf(Stars).intensity + layerOf(MilkyWay).intensity,
  airglowStrength: () => layerOf(Airglow).intensity,
  earthshine: () => layerOf(Moon).earthshine,
  ambient: () => air.clouds.ambient,
  purkinjeShift: () => air.exposure.purkinjeShift
}

it.each(Object.entries(factors))('%s is a factor, alone', (name, value) => {
  valley.set({ ...openingState, quality: 'low', [name]: 1 }, true)
  const others = Object.values(factors).filter(other => other !== value)
  const [one, before] = [value(), others.map(other => other())]
  expect(one).toBeGreaterThan(0)
  valley.set({ [name]: 0.25 })
  expect(value()).toBeCloseTo(0.25 * one, 9)
  expect(others.map(other => other())).toEqual(before)
})

it('opens as physics has it', () => {
  // Sight by night is a matter of the eye.
  const physical = (Object.keys(factors) as (keyof ValleyFactors)[]).filter(
    name => name !== 'purkinjeShift'
  )
  expect(physical.map(name => openingState[name])).toEqual(physical.map(() => 1))
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
