import { aerialPerspective, Atmosphere } from '@welkin/atmosphere'
import {
  Color,
  DepthTexture,
  FloatType,
  Mesh,
  MeshBasicMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  RenderTarget,
  Scene,
  SphereGeometry,
  type ColorRepresentation
} from 'three'
import { pass, texture, vec4 } from 'three/tsl'
import { RenderPipeline, type Node, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'

const size = { width: 64, height: 36 }
/** Pixels of the bare sky, of the ball, of the white and the black pane, and of the label, from the left. */
const places = {
  sky: [32, 4],
  ball: [32, 28],
  white: [8, 8],
  black: [20, 8],
  label: [50, 8]
} as const
const opacity = 0.4

/** A ball under the sky, and before the sky what writes no depth. */
class View {
  readonly camera = new PerspectiveCamera(60, size.width / size.height, 1, 1e5)
  readonly scene = new Scene()
  readonly atmosphere = new Atmosphere().setSunAngles(40, 60)
  readonly #panes: Mesh[] = []

  constructor() {
    const ball = new Mesh(new SphereGeometry(40), new MeshBasicMaterial({ color: 0x804020 }))
    ball.position.set(0, -40, -150)
    this.scene.add(ball)
    this.#addPane(places.white, { color: 0xffffff, opacity })
    this.#addPane(places.black, { color: 0, opacity })
    this.#addPane(places.label, { color: 0xff8000, opacity: 1 })
    this.camera.position.y = 200
    this.scene.children.forEach(child => (child.position.y += 200))
  }

  #addPane(
    [x, y]: readonly [number, number],
    { color, opacity }: { color: number; opacity: number }
  ) {
    const material = new MeshBasicMaterial({ color, opacity, transparent: true, depthWrite: false })
    const pane = new Mesh(new PlaneGeometry(8, 8), material)
    const pixel = (2 * 60 * Math.tan(Math.PI / 6)) / size.height
    pane.position.set((x + 0.5 - size.width / 2) * pixel, (size.height / 2 - y - 0.5) * pixel, -60)
    this.#panes.push(pane)
    this.scene.add(pane)
  }

  set showsPanes(value: boolean) {
    for (const pane of this.#panes) pane.visible = value
  }

  /** Draws by the post effect, after a pass and what comes between. */
  async draw(renderer: WebGPURenderer, between = (color: Node): Node => color): Promise<Picture> {
    const scenePass = pass(this.scene, this.camera, { samples: 0, type: FloatType })
    const color = between(scenePass.getTextureNode())
    const picture = await this.finish(renderer, color, scenePass.getTextureNode('depth'))
    scenePass.dispose()
    return picture
  }

  async finish(renderer: WebGPURenderer, color: Node, depth: Node): Promise<Picture> {
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = aerialPerspective(color, depth, this.camera, this.atmosphere)
    await nextFrame()
    const picture = await drawToFloat(renderer, () => pipeline.render())
    pipeline.dispose()
    return picture
  }
}

type Place = keyof typeof places

function at(picture: Picture, place: Place): number[] {
  const [x, y] = places[place]
  return picture.at(x, y).slice(0, 3)
}

function expectPlaces(actual: Picture, expected: Picture, label: string, ...names: Place[]): void {
  for (const name of names) {
    expectClose(at(actual, name), at(expected, name), { relative: 2e-3 }, `${label}: ${name}`)
  }
}

for (const depth of ['standard', 'reversed', 'logarithmic'] as const) {
  gpuTest(
    `draws the sky over any backdrop with ${depth} depth`,
    async t => {
      const buffers = {
        reversedDepthBuffer: depth === 'reversed',
        logarithmicDepthBuffer: depth === 'logarithmic'
      }
      const view = new View()
      const { scene } = view
      const renderer = await t.createRenderer({ ...size, ...buffers })
      // What is right: nothing was there, and alpha tells what covers the sky.
      const right = await view.draw(renderer)
      view.showsPanes = false
      const bare = await view.draw(renderer)
      view.showsPanes = true
      const sky = (place: Place): number[] => at(bare, place)
      expectTrue(sky('sky')[2] > 0.05, `the sky is dark: ${sky('sky').join(' ')}`)
      expectTrue(at(bare, 'ball')[0] > 1.5 * at(bare, 'ball')[2], 'the ball is not there')
      const mixed = sky('white').map(value => opacity + (1 - opacity) * value)
      expectClose(at(right, 'white'), mixed, { relative: 2e-3 }, 'the white pane')
      const dimmed = sky('black').map(value => (1 - opacity) * value)
      expectClose(at(right, 'black'), dimmed, { relative: 2e-3 }, 'the black pane')

      const opaque = await view.draw(renderer, color => vec4((color as Node<'vec4'>).rgb, 1))
      expectPlaces(opaque, right, 'alpha made 1', 'sky', 'ball', 'white', 'black', 'label')

      renderer.setClearColor(0x336699, 0.5)
      const half = await view.draw(renderer)
      expectPlaces(half, right, 'half a clear colour', 'sky', 'ball', 'white', 'black', 'label')

      /** Objects over an opaque backdrop: white adds its light, black dims where it can be seen to. */
      const expectOver = (picture: Picture, backdrop: ColorRepresentation, label: string): void => {
        expectPlaces(picture, right, label, 'sky', 'ball')
        const color = new Color(backdrop).toArray()
        const white = sky('white').map((value, k) => value + opacity * (1 - color[k]))
        expectClose(at(picture, 'white'), white, { relative: 2e-3 }, `${label}: white`)
        const isBlack = color.every(value => value === 0)
        expectPlaces(picture, isBlack ? bare : right, label, 'black')
        const changes = at(picture, 'label').map((value, k) => value - sky('label')[k])
        expectTrue(changes[0] > 0.3, `${label}: the label is not seen: ${changes.join(' ')}`)
      }
      renderer.setClearColor(0x336699)
      expectOver(await view.draw(renderer), 0x336699, 'setClearColor')
      renderer.setClearColor(0, 0)
      scene.background = new Color(0x87ceeb)
      expectOver(await view.draw(renderer), 0x87ceeb, 'scene.background')
      scene.background = null
      const solid = await t.createRenderer({ ...size, ...buffers, alpha: false })
      const second = new View()
      expectOver(await second.draw(solid), 0, 'alpha: false')
      for (const each of [view, second]) each.atmosphere.dispose()
    },
    // Other depths WebGL has in `cameras`.
    { backends: depth === 'reversed' ? ['webgpu', 'webgl'] : ['webgpu'] }
  )
}

gpuTest("draws the sky in a target of one's own, whatever its alpha", async t => {
  const view = new View()
  const renderer = await t.createRenderer(size)
  const right = await view.draw(renderer)
  const target = new RenderTarget(size.width, size.height, {
    type: FloatType,
    depthTexture: new DepthTexture(size.width, size.height)
  })
  const draw = async (): Promise<Picture> => {
    renderer.setRenderTarget(target)
    renderer.render(view.scene, view.camera)
    renderer.setRenderTarget(null)
    return view.finish(renderer, texture(target.texture), texture(target.depthTexture!))
  }
  expectPlaces(await draw(), right, 'clear', 'sky', 'ball', 'white', 'black')
  view.scene.background = new Color(0x87ceeb)
  expectPlaces(await draw(), right, 'scene.background', 'sky', 'ball')
  target.dispose()
  view.atmosphere.dispose()
})
