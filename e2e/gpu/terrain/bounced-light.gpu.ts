import {
  DirectionalLight,
  FloatType,
  Mesh,
  PerspectiveCamera,
  PlaneGeometry,
  RenderTarget,
  Scene
} from 'three'
import { float, vec4 } from 'three/tsl'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import * as onCPU from '../../../packages/terrain/src/surface/cpu/bouncedLight'
import { bouncedLight } from '../../../packages/terrain/src/surface/tsl/bouncedLight'
import { GroundMaterial } from '../../../packages/terrain/src/surface/GroundMaterial'
import { gpuTest } from '../harness/gpu-test'

gpuTest('a shader finds the light between the sides of a hollow that the CPU does', async t => {
  const inputs = Array.from({ length: 400 }, (_, i) => {
    const albedo = (0.95 * (i % 20)) / 19
    return [albedo, albedo / 2, albedo ** 2, (1 + Math.floor(i / 20)) / 20].map(Math.fround)
  })
  const results = await t.evaluate(inputs, input => vec4(bouncedLight(input.xyz, input.w), 1))
  let worst = 0
  for (const [i, [red, green, blue, share]] of inputs.entries()) {
    for (const [n, albedo] of [red, green, blue].entries()) {
      const expected = onCPU.bouncedLight(albedo, share)
      worst = Math.max(worst, Math.abs(results[4 * i + n] / expected - 1))
    }
  }
  t.note(`within ${worst.toExponential(1)}`)
  if (!(worst < 1e-5)) throw new Error(`light differs by ${worst}`)
})

gpuTest('light of the sun that a hollow keeps is drawn, in its colours', async t => {
  const renderer = await t.createRenderer({ width: 8, height: 8 })
  const albedo = [0.8, 0.4, 0.1] as const
  const share = 0.3
  const elevation = 0.6
  const scene = new Scene()
  const sun = new DirectionalLight('white', 2)
  sun.position.set(Math.cos(elevation), 0, Math.sin(elevation))
  scene.add(sun)
  const camera = new PerspectiveCamera(40, 1, 0.1, 10)
  camera.position.z = 1
  const picture = new RenderTarget(8, 8, { type: FloatType })
  const draw = async (
    material: MeshStandardNodeMaterial,
    ao: number
  ): Promise<ArrayLike<number>> => {
    material.metalness = 0
    material.colorNode = vec4(...albedo, 1)
    material.aoNode = float(ao)
    const mesh = new Mesh(new PlaneGeometry(4, 4), material)
    scene.add(mesh)
    renderer.setRenderTarget(picture)
    renderer.render(scene, camera)
    renderer.setRenderTarget(null)
    scene.remove(mesh)
    return renderer.readRenderTargetPixelsAsync(picture, 4, 4, 1, 1)
  }
  const bounced = await draw(new GroundMaterial(), share)
  const plain = await draw(new GroundMaterial(), 1)
  // Highlights of ground are of single scattering.
  const standard = await draw(new MeshStandardNodeMaterial(), 1)
  const light = 2 * Math.sin(elevation)
  for (const [n, reflectance] of albedo.entries()) {
    const kept = share * (onCPU.bouncedLight(reflectance, share) - 1) * light
    const expected = (kept * reflectance) / Math.PI
    const found = bounced[n] - plain[n]
    if (!(Math.abs(found - expected) < 1e-4)) throw new Error(`${found} in place of ${expected}`)
    const change = Math.abs(plain[n] / standard[n] - 1)
    if (!(change < 0.01)) throw new Error(`${plain[n]} without hollows, by three ${standard[n]}`)
  }
})
