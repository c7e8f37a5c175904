import { aerialPerspective } from '@welkin/atmosphere'
import { clouds } from '@welkin/clouds'
import { BoxGeometry, Mesh, MeshBasicMaterial } from 'three'
import { convertToTexture, pass, uv, vec4 } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { drawToFloat, expectLight } from '../harness/atmosphere'
import { coarse, inFog, middle, viewSize } from '../harness/cloud-view'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'

/** A black wall across the view. */
function wall(distance: number, parameters: object = {}): Mesh<BoxGeometry, MeshBasicMaterial> {
  const material = new MeshBasicMaterial({ color: 0, ...parameters })
  const mesh = new Mesh(new BoxGeometry(2 * distance, 2 * distance, distance / 100), material)
  mesh.position.set(0, 1500, -distance)
  return mesh
}

for (const depth of ['standard', 'reversed', 'logarithmic'] as const) {
  gpuTest(
    `in a cloud what is near hides it, and what is far is hidden by it: ${depth} depth`,
    t =>
      inFog(
        t,
        async view => {
          view.node.quality = { ...coarse, block: 1 }
          const light: number[] = []
          const distances = [20, 100, 400, 6000]
          for (const distance of distances) {
            const black = wall(distance)
            view.scene.add(black)
            const picture = await view.draw(3)
            expectLight(picture, `a wall at ${distance} m`)
            light.push(middle(picture))
            view.scene.remove(black)
            black.geometry.dispose()
            black.material.dispose()
          }
          const open = middle(await view.draw(3))
          const parts = light.map(value => value / open)
          t.note(`light before a wall ${parts.map(part => part.toFixed(3)).join(', ')}`)
          const [near, close, far, farthest] = parts
          // Even fog, of mean extinction 0.004/m, lets e^{−0.004 d} through at the least.
          expectTrue(near > 0 && near < 0.1, `fog before a wall at 20 m has ${near} of all light`)
          expectTrue(close > 2 * near && close < 0.4, `at 100 m it has ${close}`)
          expectTrue(far > 1.5 * close && far < 0.95, `at 400 m it has ${far}`)
          expectTrue(Math.abs(farthest - 1) < 0.05, `at 6 km it has ${farthest}`)
        },
        {
          reversedDepthBuffer: depth === 'reversed',
          logarithmicDepthBuffer: depth === 'logarithmic'
        }
      ),
    // WebGL has the depth that it clips by anew; the others are written and read by the same functions on both.
    { backends: depth === 'reversed' ? ['webgpu', 'webgl'] : ['webgpu'] }
  )
}

gpuTest(
  'a pole between the rays of a frame keeps the fog before it',
  t =>
    inFog(t, async view => {
      const distance = 100
      const pixel = (2 * distance * Math.tan(Math.PI / 6)) / viewSize.height
      // Each pixel has one sample of its own by then.
      const light: number[] = []
      for (const width of [1, 2 * viewSize.width]) {
        view.node.quality = { ...coarse, block: 4 }
        const black = wall(distance)
        black.scale.x = (width * pixel) / (2 * distance)
        black.position.x = pixel / 2
        view.scene.add(black)
        light.push(middle(await view.draw(22)))
        view.scene.remove(black)
        black.geometry.dispose()
        black.material.dispose()
        await view.draw(1)
      }
      const [pole, whole] = light
      t.note(`light before a pole over that before a wall ${(pole / whole).toFixed(3)}`)
      expectTrue(Math.abs(pole / whole - 1) < 0.1, `a pole has ${pole / whole} of a wall's fog`)
    }),
  // History is the same on both.
  { backends: ['webgpu'] }
)

gpuTest(
  'a slit one pixel wide shows the clouds behind it, whatever the rays around it meet',
  t =>
    inFog(t, async view => {
      const { camera, renderer, scene, node } = view
      node.quality = { ...coarse, block: 4 }
      camera.position.y = 100
      camera.rotation.x = 0.5
      const distance = 20
      const pixel = (2 * distance * Math.tan(Math.PI / 6)) / viewSize.height
      const walls = [-distance, distance + pixel].map(x => {
        const black = wall(distance)
        black.position.set(x, 0, -distance)
        camera.add(black)
        return black
      })
      scene.add(camera)
      const kept = new RenderPipeline(renderer)
      kept.outputColorTransform = false
      const { light } = node.passes.accumulated
      kept.outputNode = vec4(light.sample(uv()).level(0).aaa, 1)
      const passed: number[] = []
      // The column has a sample of its own in each round of 16 frames.
      for (const frames of [22, 32]) {
        await view.draw(frames)
        await nextFrame()
        passed.push(middle(await drawToFloat(renderer, () => kept.render())))
      }
      t.note(`${passed.map(part => part.toFixed(4)).join(', ')} of the sky's light passes`)
      // Clouds of an optical depth of 8 let next to nothing through.
      for (const part of passed) expectTrue(part < 0.02, `${part} of the sky's light passes`)
      for (const { geometry, material } of walls) {
        geometry.dispose()
        material.dispose()
      }
      kept.dispose()
    }),
  // History is the same on both.
  { backends: ['webgpu'] }
)

gpuTest(
  'transparent things are where their depth is, or else that of what is behind them',
  t =>
    inFog(t, async view => {
      view.node.quality = { ...coarse, block: 1 }
      const open = middle(await view.draw(2))
      const seen: number[] = []
      for (const depthWrite of [true, false]) {
        const glass = wall(20, { transparent: true, opacity: 0.9, depthWrite })
        view.scene.add(glass)
        seen.push(middle(await view.draw(2)) / open)
        view.scene.remove(glass)
        glass.geometry.dispose()
        glass.material.dispose()
      }
      const [written, unwritten] = seen
      t.note(
        `light before black glass at 20 m: ${written.toFixed(3)}, without depth ${unwritten.toFixed(3)}`
      )
      expectTrue(written < 0.2, `glass that writes depth shows ${written} of the fog's light`)
      expectTrue(Math.abs(unwritten - 1) < 0.05, `glass that writes none shows ${unwritten}`)
    }),
  // Which depth there is, and what is laid over what, is decided without a backend.
  { backends: ['webgpu'] }
)

gpuTest(
  'transparent things are over the clouds in a pass of their own',
  t =>
    inFog(t, async view => {
      const { renderer, scene, camera, atmosphere } = view
      const open = middle(await view.draw(2))
      const opaque = pass(scene, camera, { samples: 0 })
      opaque.transparent = false
      const depth = opaque.getTextureNode('depth')
      const air = aerialPerspective(opaque.getTextureNode(), depth, camera, atmosphere)
      const { field, light } = view.node
      const { noise } = field
      const quality = { ...coarse, block: 1 }
      const node = clouds(air, depth, camera, atmosphere, field.layers, { quality, noise, light })
      const depthTexture = opaque.renderTarget.depthTexture!
      const panes = pass(scene, camera, { samples: 0, depthTexture, autoClearDepth: false })
      panes.opaque = false
      const over = panes.getTextureNode()
      const pipeline = new RenderPipeline(renderer)
      pipeline.outputColorTransform = false
      pipeline.outputNode = vec4(node.rgb.mul(over.a.oneMinus()).add(over.rgb), 1)
      const draw = async (): Promise<number> => {
        let value = 0
        for (let i = 0; i < 2; i++) {
          await nextFrame()
          value = middle(await drawToFloat(renderer, () => pipeline.render())) / open
        }
        return value
      }
      const seen: number[] = []
      for (const depthWrite of [true, false]) {
        const glass = wall(20, { transparent: true, opacity: 0.75, depthWrite })
        scene.add(glass)
        seen.push(await draw())
        const before = wall(10)
        glass.material.color.setScalar(100)
        scene.add(before)
        seen.push(await draw())
        for (const mesh of [glass, before]) {
          scene.remove(mesh)
          mesh.geometry.dispose()
          mesh.material.dispose()
        }
      }
      t.note(`light before glass and a wall: ${seen.map(value => value.toFixed(3)).join(', ')}`)
      for (const i of [0, 2]) {
        expectTrue(Math.abs(seen[i] - 0.25) < 0.02, `glass shows ${seen[i]} of the clouds`)
        expectTrue(seen[i + 1] < 0.1, `before bright glass a black wall has ${seen[i + 1]}`)
      }
      pipeline.dispose()
      panes.dispose()
      node.dispose()
      opaque.dispose()
    }),
  // Which depth there is, and what is laid over what, is decided without a backend.
  { backends: ['webgpu'] }
)

gpuTest(
  'air in a texture is whole in the first frame, and in the first that clouds no longer hide',
  t =>
    inFog(t, async view => {
      const { node } = view
      const layer = node.field.layers.at(0)
      node.set({ quality: { ...coarse, block: 1 }, accumulates: false })
      node.colorNode = convertToTexture(node.colorNode)
      layer.set({ coverage: 0 })
      const first = await view.draw()
      layer.set({ coverage: 1, density: 0.1 })
      await view.draw(2)
      layer.set({ coverage: 0 })
      const after = await view.draw()
      const settled = await view.draw(2)
      for (let i = 0; i < settled.data.length; i++) {
        for (const [name, { data }] of [
          ['first', first],
          ['after clouds', after]
        ] as const) {
          expectClose(
            data[i],
            settled.data[i],
            { relative: 0.01, absolute: 1e-4 },
            `${name}: number ${i}`
          )
        }
      }
      expectTrue(middle(settled) > 0.05, `the sky is dark: ${middle(settled)}`)
    }),
  // What is built is the same on both.
  { backends: ['webgpu'] }
)
