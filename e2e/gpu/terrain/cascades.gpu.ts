import { Atmosphere, SunDirectionalLight } from '@welkin/atmosphere'
import { Terrain, type HeightSource } from '@welkin/terrain'
import { BoxGeometry, type Light, Mesh, MeshBasicMaterial, PerspectiveCamera, Scene } from 'three'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { SunLight } from 'three/addons/lights/SunLight.js'
import { SunLightNode } from 'three/addons/lights/SunLightNode.js'
import { vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { gpuTest } from '../harness/gpu-test'

SunLight.registerNode(SunLightNode)

const SIZE = { width: 64, height: 48 }

/** A plain. */
const plain: HeightSource = {
  lowest: 0,
  highest: 0,
  variation: () => 0,
  sampleAt(_position, target) {
    target.height = 0
    target.gradient.set(0, 0, 0)
    return target
  },
  sample: (): Node<'vec4'> => vec4(0)
}

/** Distance up to which cascades reach [m]. */
const FAR = 80

/** Elevation of the sun in the east [°]. */
const ELEVATION = 40

/** Sun whose shadow is one of three's cascades: a shadow node of `three/addons/csm`, or the light that has them by itself. */
const suns: Record<string, (atmosphere: Atmosphere) => Light> = {
  CSMShadowNode(atmosphere) {
    const sun = new SunDirectionalLight(atmosphere, 100)
    const node = new CSMShadowNode(sun, { cascades: 2, maxFar: FAR, mode: 'uniform' })
    Object.assign(sun.shadow, { shadowNode: node })
    return sun
  },
  SunLight() {
    const sun = new SunLight(0xffffff, 50_000)
    const elevation = (ELEVATION * Math.PI) / 180
    sun.position.set(Math.cos(elevation), Math.sin(elevation), 0)
    sun.shadow.camera.far = FAR
    return sun
  }
}

for (const [name, sunOf] of Object.entries(suns)) {
  gpuTest(`the ground receives the cascades of a ${name}`, async t => {
    const renderer = await t.createRenderer({ ...SIZE, reversedDepthBuffer: true })
    renderer.highPrecision = true
    renderer.shadowMap.enabled = true
    const atmosphere = new Atmosphere()
    atmosphere.place({ longitude: 12, latitude: 47 })
    atmosphere.setSunAngles(ELEVATION, 90)
    const terrain = new Terrain(atmosphere, plain, { pageMemory: 20, seaLevel: -Infinity })
    terrain.shadowDistance = 100
    terrain.receiveShadow = terrain.castShadow = true
    const sun = sunOf(atmosphere)
    sun.castShadow = true
    const scene = new Scene().add(terrain, sun)
    // From above, on a box in the air and on ground below it; its shadow falls to the west.
    const box = new Mesh(new BoxGeometry(4, 1, 4), new MeshBasicMaterial({ color: 0 }))
    box.position.y = 5
    scene.add(box)
    const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, 0.1, 1e7)
    camera.position.y = 25
    camera.rotation.x = -Math.PI / 2
    camera.updateMatrixWorld()
    terrain.update(renderer, camera, Infinity)
    const row = async (): Promise<number[]> => {
      await t.render(renderer, scene, camera, SIZE)
      const picture = await t.render(renderer, scene, camera, SIZE)
      return Array.from({ length: SIZE.width }, (_, x) => picture.at(x, SIZE.height / 2)[1])
    }
    const alone = await row()
    box.castShadow = true
    const shares = (await row()).map((value, x) => value / Math.max(alone[x], 1e-9))
    terrain.dispose()
    const shadow = shares.slice(0, 26).filter(share => share < 0.05).length
    const lit = shares.slice(38).filter(share => share > 0.95).length
    t.note(`${shadow} pixels in the shadow of a box, ${lit} in the light`)
    if (alone.slice(0, 26).some(value => value === 0)) throw new Error('the ground is black')
    if (shadow < 4) throw new Error('a box casts no shadow on the ground')
    if (lit < 24) throw new Error('the ground is dark where no shadow is')
  })
}
