import {
  aerialPerspective,
  aerialPerspectiveFog,
  airglow,
  Atmosphere,
  AtmosphereParameters,
  AtmosphereShell,
  heightFog,
  milkyWay,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  planetGround,
  skyBackground,
  skyEnvironment,
  SkyLightProbe,
  stars,
  SunDirectionalLight,
  sunFlare
} from '@welkin/atmosphere'
import { cloudEnvironment, cloudPreset, clouds, cloudShadow, cloudSkyLight } from '@welkin/clouds'
import {
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  RenderTarget,
  Scene
} from 'three'
import { pass, shadow } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'

/** Draws a frame. */
type Draw = () => void

interface LitScene {
  scene: Scene
  camera: PerspectiveCamera
  atmosphere: Atmosphere
  sun: SunDirectionalLight
  sky: SkyLightProbe
}

/** A lit ground under the sun and the sky. */
function litScene(): LitScene {
  const camera = new PerspectiveCamera(50, 16 / 9, 1, 1e5)
  camera.position.y = 2
  const atmosphere = new Atmosphere().setSunAngles(40, 120)
  const sun = new SunDirectionalLight(atmosphere, 50)
  sun.castShadow = true
  const sky = new SkyLightProbe(atmosphere)
  const material = new MeshStandardMaterial({ name: 'lit ground' })
  const ground = new Mesh(new PlaneGeometry(1000, 1000).rotateX(-Math.PI / 2), material)
  ground.receiveShadow = true
  return { scene: new Scene().add(ground, sun, sun.target, sky), camera, atmosphere, sun, sky }
}

function drawn(renderer: WebGPURenderer, render: Draw): Draw {
  const target = new RenderTarget(16, 9)
  renderer.shadowMap.enabled = true
  return () => {
    renderer.setRenderTarget(target)
    render()
    renderer.setRenderTarget(null)
  }
}

/** A lit ground under layers, as a post effect. */
function postScene(renderer: WebGPURenderer, made: LitScene, withClouds = false): Draw {
  const { scene, camera, atmosphere, sun, sky } = made
  const scenePass = pass(scene, camera, { samples: 0 })
  const depth = scenePass.getTextureNode('depth')
  const air = aerialPerspective(scenePass.getTextureNode(), depth, camera, atmosphere)
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputNode = air
  if (withClouds) {
    const node = clouds(air, depth, camera, atmosphere, cloudPreset('mixed'))
    node.field.bake(renderer)
    Object.assign(sun.shadow, { shadowNode: cloudShadow(node, shadow(sun)) })
    cloudSkyLight(sky, node)
    scene.environmentNode = skyEnvironment(atmosphere, { overlay: cloudEnvironment(node) })
    pipeline.outputNode = node
  }
  return drawn(renderer, () => pipeline.render())
}

/** Scenes whose shaders are counted, each from nothing; from the quick start on. */
export const shaderScenes: Readonly<Record<string, (renderer: WebGPURenderer) => Draw>> = {
  forward: renderer => {
    const { scene, camera, atmosphere } = litScene()
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
    return drawn(renderer, () => renderer.render(scene, camera))
  },
  post: renderer => postScene(renderer, litScene()),
  'all layers, night': renderer => {
    const made = litScene()
    const { atmosphere, scene } = made
    atmosphere.setSunAngles(-20, 120)
    const luna = moon()
    atmosphere.add(planetGround(), sunFlare(), milkyWay(), stars(), luna, airglow())
    atmosphere.add(heightFog())
    const moonlight = new MoonDirectionalLight(atmosphere, luna, 50)
    const moonSky = new SkyLightProbe(atmosphere, luna.source)
    scene.add(moonlight, moonlight.target, moonSky, new NightLightProbe(atmosphere))
    return postScene(renderer, made)
  },
  clouds: renderer => postScene(renderer, litScene(), true),
  shell: renderer => {
    const { scene, camera, sun } = litScene()
    const shell = new AtmosphereShell(new AtmosphereParameters(), 1, { sun })
    shell.position.z = -5
    scene.add(shell)
    return drawn(renderer, () => renderer.render(scene, camera))
  }
}
