import { Atmosphere } from '@welkin/atmosphere'
import { OrthographicCamera, PerspectiveCamera, Scene } from 'three'
import { float, pass, vec4 } from 'three/tsl'
import { describe, expect, test } from 'vitest'
import {
  cloudEnvironment,
  cloudQualities,
  CloudLayers,
  clouds,
  cloudsDebug,
  cloudShadow
} from '../../src'

const atmosphere = new Atmosphere()
const [color, depth, camera] = [vec4(0), float(0), new PerspectiveCamera()]
const make = (options = {}) => clouds(color, depth, camera, atmosphere, new CloudLayers(), options)

describe('CloudsNode', () => {
  test('refuses what is missing or of the wrong kind', () => {
    const layers = new CloudLayers()
    expect(() => clouds(color, depth, camera, null as never, layers)).toThrow(/atmosphere/)
    expect(() => clouds(color, null as never, camera, atmosphere, layers)).toThrow(/depthNode/)
    expect(() => clouds(color, depth, camera, atmosphere, [] as never)).toThrow(/layers/)
    const scene = pass(new Scene(), camera)
    for (const other of [scene, scene.getTextureNode(), color]) {
      expect(() => clouds(scene, other, camera, atmosphere, layers)).toThrow(
        "CloudsNode: depthNode must be a depth texture's node, got "
      )
    }
    const node = clouds(scene, scene.getTextureNode('depth'), camera, atmosphere, layers)
    expect(node.isReady).toBe(false)
    node.dispose()
    expect(() => make({ qualty: 'low' })).toThrow(
      "CloudsNode: unknown option 'qualty', did you mean 'quality'?"
    )
    expect(() => clouds(color, depth, new OrthographicCamera(), atmosphere, layers)).toThrow(
      'CloudsNode: camera must be a PerspectiveCamera, got an OrthographicCamera'
    )
  })

  test('knows qualities by name or number, and keeps the last valid one', () => {
    const node = make({ quality: 'low' })
    expect(node.quality).toBe(cloudQualities.low)
    expect(() => (node.quality = 'best' as never)).toThrow(/'low', 'medium', 'high' or 'ultra'/)
    const wrong = { ...cloudQualities.high, steps: NaN }
    expect(() => (node.quality = wrong)).toThrow(/quality: steps must be in \[1, 1024\]/)
    const more = { ...cloudQualities.high, stps: 9 } as never
    expect(() => (node.quality = more)).toThrow(
      /CloudsNode.quality: unknown option 'stps', did you mean 'steps'\?/
    )
    const between = { ...cloudQualities.high, block: 2.5 }
    expect(() => (node.quality = between)).toThrow(
      /quality: block must be 1, 2, 3, 4, 5 or 6, got 2\.5/
    )
    expect(node.quality).toBe(cloudQualities.low)
    node.quality = { ...cloudQualities.high, steps: 20 }
    expect(node.quality).toEqual({ ...cloudQualities.high, steps: 20 })
    node.dispose()
  })

  test('changes all settings that it is given, or none', () => {
    const node = make({ time: 7, accumulates: false, nightIlluminance: 2 })
    expect([node.time, node.accumulates, node.nightIlluminance]).toEqual([7, false, 2])
    const mixed = { quality: 'low', accumulates: true, time: NaN } as const
    expect(() => node.set(mixed)).toThrow('CloudsNode: time must be a finite number or null')
    expect([node.quality, node.accumulates]).toEqual([cloudQualities.high, false])
    expect(node.set({ time: null, quality: undefined }).time).toBe(null)
    expect(node.quality).toEqual(cloudQualities.high)
    node.dispose()
  })

  test('drifts by a time that is a number, or by the clock', () => {
    const node = make()
    node.time = 7
    expect(() => (node.time = NaN)).toThrow(
      'CloudsNode: time must be a finite number or null, got NaN'
    )
    expect(node.time).toBe(7)
    node.time = null
    node.dispose()
  })

  test('shows a debug view of those it has', () => {
    const node = make()
    const debug = cloudsDebug(node, null)
    expect(debug.view).toBe(null)
    debug.view = 'history'
    expect(debug.view).toBe('history')
    expect(() => (debug.view = 'opacity' as never)).toThrow(
      "CloudsDebugNode: view must be 'density', 'steps', 'depth', 'history' or null, got 'opacity'"
    )
    expect(debug.view).toBe('history')
    node.dispose()
  })
})

describe('cloudEnvironment', () => {
  test('refuses options that it does not know', () => {
    const node = make()
    expect(() => cloudEnvironment(node, { sise: 64 } as never)).toThrow(
      "CloudEnvironment: unknown option 'sise', did you mean 'size'?"
    )
    node.dispose()
  })
})

describe('cloudShadow', () => {
  test('refuses what are no clouds', () => {
    expect(() => cloudShadow(new CloudLayers() as never)).toThrow(
      'CloudShadowNode: clouds must be a CloudsNode, got a CloudLayers'
    )
  })
})
