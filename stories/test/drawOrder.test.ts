import { Mesh, PlaneGeometry, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { drawFromNear, tileIndex } from '../src/valley/drawOrder'

const SIZE = 16

/** A tile of quads of 1 m about the origin. */
function tile(): Mesh {
  const geometry = new PlaneGeometry(SIZE, SIZE, SIZE, SIZE).rotateX(-Math.PI / 2)
  return new Mesh(geometry.setIndex(tileIndex(SIZE)))
}

/** Triangles that are drawn, each by its vertices from the least on: the same for every way to begin. */
function drawn({ geometry }: Mesh): string[] {
  const { start, count } = geometry.drawRange
  const corners = [...geometry.index!.array].slice(start, start + count)
  return Array.from({ length: count / 3 }, (_, i) => {
    const triangle = corners.slice(3 * i, 3 * i + 3)
    const least = triangle.indexOf(Math.min(...triangle))
    return [...triangle.slice(least), ...triangle.slice(0, least)].join()
  })
}

describe('drawFromNear', () => {
  const places = [
    [0, 50],
    [0, -50],
    [50, 3],
    [-50, 3]
  ] as const

  it('draws the triangles of a plane, each once and facing as it does, from everywhere', () => {
    const plane = new Mesh(new PlaneGeometry(SIZE, SIZE, SIZE, SIZE))
    plane.geometry.setDrawRange(0, plane.geometry.index!.count)
    for (const [x, z] of places) {
      const mesh = tile()
      drawFromNear(mesh, new Vector3(x, 10, z))
      expect(drawn(mesh).toSorted()).toEqual(drawn(plane).toSorted())
    }
  })

  it('begins with the edge that is nearest to the camera', () => {
    for (const [x, z] of places) {
      const mesh = tile()
      drawFromNear(mesh, new Vector3(x, 10, z))
      const { geometry } = mesh
      const { position } = geometry.attributes
      const order = geometry.index!.array.slice(geometry.drawRange.start)
      const distances = Array.from(order.slice(0, 6 * SIZE * SIZE), vertex =>
        Math.hypot(position.getX(vertex) - x, position.getZ(vertex) - z)
      )
      const [first, last] = [distances.slice(0, 24), distances.slice(-24)]
      expect(Math.max(...first)).toBeLessThan(Math.min(...last))
    }
  })
})
