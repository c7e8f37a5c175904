import { IcosahedronGeometry, Plane, Vector3 } from 'three'
import type { BufferGeometry } from 'three'

/** Triangle mesh around a sphere at the origin: no triangle cuts the sphere. */
export function circumscribedSphere(radius: number): BufferGeometry {
  const mesh = new IcosahedronGeometry(1, 6)
  const position = mesh.getAttribute('position')
  const plane = new Plane()
  const corners = [new Vector3(), new Vector3(), new Vector3()] as const
  let inscribedRadius = 1
  for (let i = 0; i < position.count; i += 3) {
    corners.forEach((corner, k) => corner.fromBufferAttribute(position, i + k))
    const distance = Math.abs(plane.setFromCoplanarPoints(...corners).constant)
    inscribedRadius = Math.min(inscribedRadius, distance)
  }
  mesh.deleteAttribute('normal')
  mesh.deleteAttribute('uv')
  const scale = radius / inscribedRadius
  mesh.scale(scale, scale, scale)
  return mesh
}
