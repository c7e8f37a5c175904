import { airStyle, Atmosphere, moon } from '@welkin/atmosphere'
import { BoxGeometry, Mesh, MeshBasicMaterial, PerspectiveCamera, Scene, Vector3 } from 'three'
import { vec4 } from 'three/tsl'
import { denserAir } from '../../../packages/atmosphere/src/sky/tsl/airStyle'
import { drawForward, expectLight, postPath } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const size = { width: 32, height: 18 }
const luminance = ([r, g, b]: readonly number[]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b

/** Largest difference of two pictures, over the first one's brightest number. */
function difference(a: Picture, b: Picture): number {
  const most = a.data.reduce((max, value) => Math.max(max, value), 0)
  return a.data.reduce((max, value, i) => Math.max(max, Math.abs(value - b.data[i])), 0) / most
}

gpuTest('makes air denser as float64 does, thin and thick', async t => {
  const inputs = Array.from({ length: 200 }, (_, i) => [10 ** ((i % 40) / 6 - 5), (i % 7) / 2])
  const found = await t.evaluate(inputs, ({ x, y }) => {
    const air = denserAir({ depth: vec4(x), radiance: vec4(1) }, y)
    return vec4(air.depth.x, air.radiance.x, 0, 0)
  })
  inputs.forEach(([depth, strength], i) => {
    const light = Math.expm1(-strength * depth) / Math.expm1(-depth)
    const label = `τ ${depth} × ${strength}`
    expectClose(found[4 * i], strength * depth, { relative: 1e-6 }, label)
    expectClose(found[4 * i + 1], light, { relative: 1e-4, absolute: 1e-7 }, label)
  })
})

gpuTest(
  'changes nothing at 1, and by 0 and 2 haze and twilight as it says',
  async t => {
    const renderer = await t.createRenderer(size)
    const atmosphere = new Atmosphere().place({ longitude: 8, latitude: 46 })
    const scene = new Scene()
    const camera = new PerspectiveCamera(50, size.width / size.height, 1, 1e6)
    camera.position.y = 30
    const things = [0, 0.5].map((color, i) => {
      const material = new MeshBasicMaterial()
      material.color.setScalar(color)
      const box = new Mesh(new BoxGeometry(6000, 8000, 100), material)
      box.position.set((i - 0.5) * 9000, 0, -20_000)
      return box
    })
    scene.add(...things)
    const draw = () => drawForward(renderer, scene, camera, atmosphere)
    const post = postPath(renderer, scene, camera, atmosphere)
    const style = airStyle()
    /** Pixels of both boxes and of the sky above. */
    const look = (picture: Picture) => [11, 21, 16].map((x, i) => picture.at(x, i < 2 ? 8 : 1))

    atmosphere.setSunAngles(30, 160)
    const plain = [await draw(), await post.draw()]
    atmosphere.add(style)
    post.refresh()
    const same = [await draw(), await post.draw()]
    same.forEach((picture, i) => {
      expectLight(picture, 'at 1')
      expectTrue(
        difference(plain[i], picture) === 0,
        `at 1 off by ${difference(plain[i], picture)}`
      )
    })
    const [black, grey, sky] = look(plain[0])
    style.haze = 0
    const [clearBlack, clearGrey, sameSky] = look(await draw())
    expectTrue(
      clearBlack.slice(0, 3).every(value => value === 0),
      `no haze: ${clearBlack}`
    )
    expectClose(clearGrey.slice(0, 3), [0.5, 0.5, 0.5], { relative: 1e-3 }, 'no haze')
    expectClose(sameSky, sky, { absolute: 0 }, 'sky')
    style.haze = 2
    const [hazyBlack, hazyGrey] = look(await post.draw())
    for (const k of [0, 1, 2]) {
      const [once, twice] = [grey[k] - black[k], hazyGrey[k] - hazyBlack[k]].map(
        value => value / 0.5
      )
      expectTrue(once > 0.1 && once < 0.98, `transmittance ${once}`)
      // Exact at each wavelength; colours mix them, green the least.
      if (k === 1) expectClose(twice, once ** 2, { absolute: 0.05 }, 'twice the haze')
      expectTrue(twice < 0.8 * once, `transmittance ${once}, of twice the haze ${twice}`)
      expectTrue(hazyBlack[k] > 1.1 * black[k], `light of twice the haze ${hazyBlack[k]}`)
    }
    style.set({ haze: 1, twilightSaturation: 2 })
    expectTrue(difference(plain[0], await draw()) === 0, 'twilight by day')

    atmosphere.setSunAngles(-2, 0)
    atmosphere.luminanceScale = 1e-2
    const skyOf = async (saturation: number): Promise<number[]> => {
      style.twilightSaturation = saturation
      return look(await draw())[2].slice(0, 3)
    }
    const [none, once, twice] = [await skyOf(0), await skyOf(1), await skyOf(2)]
    const [a, b, c] = [none, once, twice].map(luminance)
    expectClose([a, c], [b, b], { relative: 5e-3 }, 'luminance')
    const chroma = [0, 1, 2].map(k => (twice[k] - none[k]) / (once[k] - none[k]))
    t.note(`sky at dusk ${once}, grey ${none}`)
    expectClose(chroma, [2, 2, 2], { relative: 0.02 }, 'distance from grey')
    expectTrue(Math.abs(once[2] / once[0] - none[2] / none[0]) > 0.2, 'the sky has a colour')
    post.dispose()
    for (const { geometry, material } of things) {
      geometry.dispose()
      material.dispose()
    }
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'scales earthshine alone, and a moon without light has none',
  async t => {
    const renderer = await t.createRenderer({ width: 32, height: 32 })
    const atmosphere = new Atmosphere({ luminanceScale: 0.1 }).setSunAngles(-40, 180)
    const luna = moon({ direction: new Vector3(0, 0.6, -1), phase: 0.12, mapSize: 64 })
    luna.flare.set({ innerStrength: 0, outerStrength: 0 })
    atmosphere.add(luna)
    const scene = new Scene()
    const camera = new PerspectiveCamera(0.7, 1, 1, 1e6)
    camera.lookAt(0, 0.6, -1)
    camera.updateMatrixWorld()
    const light = async (): Promise<{ dark: number; lit: number }> => {
      const picture = await drawForward(renderer, scene, camera, atmosphere)
      expectLight(picture, 'moon')
      const all = Array.from({ length: 32 * 32 }, (_, i) =>
        luminance(picture.at(i % 32, Math.floor(i / 32)))
      )
      return { dark: luminance(picture.at(16, 16)), lit: Math.max(...all) }
    }
    const once = await light()
    luna.earthshine = 2
    const twice = await light()
    luna.earthshine = 0
    const none = await light()
    luna.set({ earthshine: 1, strength: 0 })
    const off = await light()
    atmosphere.remove(luna)
    const without = await light()
    luna.dispose()
    t.note(`dark ${once.dark.toPrecision(3)}, lit ${once.lit.toPrecision(3)}`)
    expectTrue(once.lit > 100 * once.dark && once.dark > 4 * none.dark, `${none.dark} without`)
    expectClose(twice.dark - once.dark, once.dark - none.dark, { relative: 0.01 }, 'earthshine')
    expectClose([twice.lit, none.lit], [once.lit, once.lit], { relative: 1e-3 }, 'sunlit side')
    expectTrue(off.lit <= without.lit, `a moon without light has ${off.lit}`)
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)
