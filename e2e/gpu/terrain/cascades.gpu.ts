import { Atmosphere, SunDirectionalLight } from '@welkin/atmosphere'
import { Terrain } from '@welkin/terrain'
import { type Light, Scene } from 'three'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { SunLight } from 'three/addons/lights/SunLight.js'
import { SunLightNode } from 'three/addons/lights/SunLightNode.js'
import { gpuTest } from '../harness/gpu-test'
import { boxFromAbove, expectBoxShadow, levelGround } from '../harness/ground'

SunLight.registerNode(SunLightNode)

const SIZE = { width: 64, height: 48 }

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
  gpuTest(
    `the ground receives the cascades of a ${name}`,
    async t => {
      const renderer = await t.createPlanetRenderer(SIZE)
      renderer.shadowMap.enabled = true
      const atmosphere = new Atmosphere()
      atmosphere.place({ longitude: 12, latitude: 47 })
      atmosphere.setSunAngles(ELEVATION, 90)
      const terrain = new Terrain(atmosphere, levelGround, { pageMemory: 20, seaLevel: -Infinity })
      terrain.shadowDistance = 100
      terrain.receiveShadow = terrain.castShadow = true
      const sun = sunOf(atmosphere)
      sun.castShadow = true
      const scene = new Scene().add(terrain, sun)
      const { box, camera } = boxFromAbove(SIZE.width / SIZE.height)
      scene.add(box)
      terrain.update(renderer, camera, Infinity)
      const row = async (): Promise<number[]> => {
        await t.render(renderer, scene, camera, SIZE)
        const picture = await t.render(renderer, scene, camera, SIZE)
        return Array.from({ length: SIZE.width }, (_, x) => picture.at(x, SIZE.height / 2)[1])
      }
      const alone = await row()
      box.castShadow = true
      expectBoxShadow(t, await row(), alone)
      terrain.dispose()
    },
    // Those of a `CSMShadowNode` WebGL has in `everything`.
    { backends: name === 'SunLight' ? ['webgpu', 'webgl'] : ['webgpu'] }
  )
}
