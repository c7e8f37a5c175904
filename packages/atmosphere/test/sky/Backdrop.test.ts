import { Color, PerspectiveCamera, Scene, Texture } from 'three'
import { pass, vec3 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { expect, it } from 'vitest'
import { Backdrop, passOf } from '../../src/sky/Backdrop'

/** A renderer that clears with grey at half opacity. */
const renderer = (alpha: boolean, backend: object): Renderer =>
  ({
    alpha,
    backend,
    getClearAlpha: () => 0.5,
    getClearColor: (target: Color) => target.setRGB(0.2, 0.4, 0.8)
  }) as unknown as Renderer

const opaque = renderer(false, { isWebGPUBackend: true })

function backdropOf(scene: Scene, drawnBy = opaque): { color: number[]; isKnown: boolean } {
  const backdrop = new Backdrop()
  backdrop.update(drawnBy, pass(scene, new PerspectiveCamera()))
  return { color: backdrop.color.value.toArray(), isKnown: backdrop.isKnown.value === 1 }
}

it('is the clear colour, which three multiplies by alpha except on an opaque canvas of WebGPU', () => {
  expect(backdropOf(new Scene()).color).toEqual([0.2, 0.4, 0.8, 0.5])
  const multiplied = [0.1, 0.2, 0.4, 0.5]
  expect(backdropOf(new Scene(), renderer(true, { isWebGPUBackend: true })).color).toEqual(
    multiplied
  )
  expect(backdropOf(new Scene(), renderer(false, {})).color).toEqual(multiplied)
})

it('is the background colour of a scene, opaque', () => {
  const scene = new Scene()
  scene.background = new Color(0.1, 0.2, 0.3)
  expect(backdropOf(scene)).toEqual({ color: [0.1, 0.2, 0.3, 1], isKnown: true })
})

it('is unknown where a picture or a node is the background, and without a pass', () => {
  const pictured = new Scene()
  pictured.background = new Texture()
  const noded = Object.assign(new Scene(), { backgroundNode: vec3(1) })
  for (const scene of [pictured, noded]) {
    expect(backdropOf(scene)).toEqual({ color: [0, 0, 0, 0], isKnown: false })
  }
  const backdrop = new Backdrop()
  backdrop.update(opaque, null)
  expect(backdrop.isKnown.value).toBe(0)
})

it('finds the pass of its colour and its depth, and none of other nodes', () => {
  const scenePass = pass(new Scene(), new PerspectiveCamera())
  for (const node of [scenePass, scenePass.getTextureNode(), scenePass.getTextureNode('depth')]) {
    expect(passOf(node)).toBe(scenePass)
  }
  expect(passOf(vec3(0))).toBeNull()
})
