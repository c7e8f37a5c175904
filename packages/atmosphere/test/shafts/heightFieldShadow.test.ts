import { Atmosphere, heightFieldShadow, type LightShafts } from '@welkin/atmosphere'
import { Group, Matrix4, PerspectiveCamera, Texture, Vector3 } from 'three'
import type { Renderer } from 'three/webgpu'
import { expect, it } from 'vitest'
import { AtmosphereView } from '../../src/view/AtmosphereView'

it('takes the direction to the light from where a camera in a rig is in the world', () => {
  const atmosphere = new Atmosphere()
  const rig = new Group()
  rig.position.set(5000, 20, -300)
  const camera = new PerspectiveCamera()
  camera.position.y = 2
  rig.add(camera).updateMatrixWorld(true)
  const asked: Vector3[] = []
  const source = {
    direction(_target: Vector3, position: Vector3): Vector3 {
      asked.push(position.clone())
      throw new Error('nothing is drawn here')
    }
  }
  const shafts = { source, light: {} } as unknown as LightShafts
  const shadow = heightFieldShadow(new Texture(), new Matrix4()).castInto(shafts)
  const view = new AtmosphereView(atmosphere, camera, atmosphere.sun)
  expect(() => shadow.update!(view, {} as Renderer)).toThrow('nothing is drawn here')
  expect(asked).toEqual([new Vector3(5000, 22, -300)])
})
