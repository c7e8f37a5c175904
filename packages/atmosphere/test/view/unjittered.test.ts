import fc from 'fast-check'
import { OrthographicCamera, PerspectiveCamera } from 'three'
import { expect, it } from 'vitest'
import { unjitteredProjection } from '../../src/view/cpu/unjittered'
import { number } from '../arbitraries'

const [width, height] = [640, 360]

it('takes an offset within a pixel off a projection, and no other', () => {
  fc.assert(
    fc.property(number(-0.99, 0.99), number(-0.99, 0.99), number(20, 120), (x, y, fov) => {
      const camera = new PerspectiveCamera(fov, width / height, 0.5, 1e5)
      const expected = camera.projectionMatrix.clone()
      camera.setViewOffset(width, height, x, y, width, height)
      const found = unjitteredProjection(camera)
      found.elements.forEach((value, i) => expect(value).toBeCloseTo(expected.elements[i], 12))
    })
  )
})

it('leaves tiles of a picture, larger shifts, and cameras without perspective as they are', () => {
  const camera = new PerspectiveCamera(50, width / height, 0.5, 1e5)
  for (const [x, y, w, h] of [
    [0.3, 0.3, width / 2, height],
    [2, 0, width, height]
  ]) {
    camera.setViewOffset(width, height, x, y, w, h)
    expect(unjitteredProjection(camera)).toEqual(camera.projectionMatrix)
  }
  const flat = new OrthographicCamera(-1, 1, 1, -1)
  flat.setViewOffset(width, height, 0.3, 0.3, width, height)
  expect(unjitteredProjection(flat)).toEqual(flat.projectionMatrix)
})
