import { SurfaceWater } from '@welkin/atmosphere'
import { FrontSide, type Mesh } from 'three'
import { expect, it } from 'vitest'
import { createGround } from '../src/valley/ground'
import { Relief } from '../src/valley/relief'

it('casts its shadow by the side that the light falls on: fog on a shaded slope is dark', () => {
  const ground = createGround(64, new SurfaceWater(), new Relief(64))
  for (const { material } of ground.children as Mesh[]) {
    expect(material).toHaveProperty('shadowSide', FrontSide)
  }
})
