import { AtmosphereParameters, AtmosphereShell } from '@welkin/atmosphere'
import { Scene, Vector3 } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { expectLight, relativeDifferences } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'
import { cameraAt, draw, size } from '../harness/shell'

/** Count of a renderer's draws of the pass of this name. */
function countPasses(renderer: WebGPURenderer, name: string): () => number {
  let count = 0
  const render = renderer.render.bind(renderer)
  renderer.render = (scene, camera) => {
    if (scene.name === name) count++
    render(scene, camera)
  }
  return () => count
}

gpuTest(
  'bakes once for all shells of the same parameters',
  async t => {
    const [renderer, other] = [await t.createRenderer(size), await t.createRenderer(size)]
    const baked = countPasses(renderer, 'Welkin.Transmittance')
    const camera = cameraAt(3, 1, -Math.PI / 2)
    const parameters = new AtmosphereParameters()
    const sun = new Vector3(0.3, 1, 0.2)
    const make = (shared = parameters) => {
      const shell = new AtmosphereShell(shared, 1, { sun })
      if (shell === null) throw new Error('the Earth has air')
      return shell
    }
    const textures = (): number => renderer.info.memory.textures
    const scene = new Scene()
    const first = make()
    scene.add(first)
    const before = await draw(renderer, new Scene(), camera).then(textures)
    const alone = await draw(renderer, scene, camera)
    expectLight(alone, 'one shell')
    const withOne = textures()
    expectTrue(baked() === 1, `${baked()} bakes for the first`)

    // Each with another part of its body towards the camera: they share no volume.
    const others = [1.5, 2, 3].map((radius, i) => {
      const shell = make()
      shell.scale.setScalar(radius)
      shell.position.set(0, -1e3 * (i + 1), 0)
      return shell
    })
    const cameras = others.map(({ position, scale }) => {
      const eye = cameraAt(3, scale.x, -Math.PI / 2)
      eye.position.add(position)
      eye.updateMatrixWorld()
      return eye
    })
    scene.add(...others)
    const drawn: Picture[] = []
    for (const eye of [camera, ...cameras]) drawn.push(await draw(renderer, scene, eye))
    expectTrue(baked() === 1, `${baked()} bakes for four`)
    const each = (textures() - withOne) / 3
    t.note(`the first takes ${withOne - before} textures, each other ${each}`)
    expectTrue(each <= 3, `each other shell takes ${each} textures`)
    const expectSame = (picture: Picture, what: string): void => {
      const differences = relativeDifferences(alone, picture)
      // The last pixels are the silhouette's.
      const most = differences[Math.floor(0.98 * differences.length)]
      expectTrue(most < 5e-3, `${what} differs from one alone by ${most}`)
    }
    drawn.forEach((picture, i) => expectSame(picture, `shell ${i}`))
    expectSame(await draw(other, scene, camera), 'one on another renderer')
    await draw(renderer, scene, camera)
    expectTrue(baked() === 1, `${baked()} bakes for two renderers in turn`)

    for (const shell of [first, others[0], others[2]]) {
      scene.remove(shell)
      shell.dispose()
      shell.dispose()
    }
    const left = await draw(renderer, scene, cameras[1])
    const change = relativeDifferences(drawn[2], left)
    expectTrue(change.at(-1)! < 1e-6, 'the last shell suffers from what others dispose of')
    expectTrue(baked() === 1, `${baked()} bakes with one left`)
    // Air that other tests bake, too.
    parameters.set({ groundAlbedo: [0, 0, 0, 0] })
    const hazier = await draw(renderer, scene, cameras[1])
    expectTrue(baked() === 2, `${baked()} bakes after a change`)
    expectTrue(relativeDifferences(left, hazier).at(-1)! > 0.01, 'a change is not to be seen')

    scene.remove(others[1])
    others[1].dispose()
    await draw(renderer, scene, camera)
    expectTrue(textures() <= before, `${textures()} textures left, before ${before}`)
    const next = make()
    scene.add(next)
    await draw(renderer, scene, camera)
    expectTrue(baked() === 3, `${baked()} bakes after all were disposed of`)
    next.dispose()
  },
  { backends: ['webgpu'] }
)
