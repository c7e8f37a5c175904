import { OrthographicCamera, PerspectiveCamera, Texture } from 'three'
import { texture } from 'three/tsl'
import { describe, expect, it } from 'vitest'
import { skyVelocity } from '@welkin/atmosphere'

const picture = texture(new Texture())
const wrong = (value: unknown): never => value as never

describe('skyVelocity', () => {
  it('throws for what it can not use', () => {
    const camera = new PerspectiveCamera()
    expect(() => skyVelocity(picture, picture, camera)).not.toThrow()
    expect(() => skyVelocity(wrong(null), picture, camera)).toThrow(
      'SkyVelocityNode: velocityNode must be a node, got null'
    )
    expect(() => skyVelocity(picture, wrong(undefined), camera)).toThrow(
      'SkyVelocityNode: depthNode must be a node, got undefined'
    )
    expect(() => skyVelocity(picture, picture, new OrthographicCamera())).toThrow(
      'SkyVelocityNode: camera must be a perspective camera, got an OrthographicCamera'
    )
  })
})
