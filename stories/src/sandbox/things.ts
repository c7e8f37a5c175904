import { BoxGeometry, Mesh, MeshStandardMaterial, SphereGeometry } from 'three'

/** Balls of several materials, and a tower, on the ground about the origin. */
export function createThings(): Mesh[] {
  const ball = new SphereGeometry(1.5, 48, 32)
  const box = new BoxGeometry(1, 1, 1)
  const gray = new MeshStandardMaterial({ color: '#9a968c', roughness: 0.9 })
  const white = new MeshStandardMaterial({ color: '#e8e6e0', roughness: 0.8 })
  const glossy = new MeshStandardMaterial({ color: '#a33b2e', roughness: 0.25 })
  const dark = new MeshStandardMaterial({ color: '#2c2d30', roughness: 0.6 })
  const balls = [white, glossy, dark].map((material, i) => {
    const mesh = new Mesh(ball, material)
    mesh.position.set(-5.5 + 3.6 * i, 1.5, -3 - 1.5 * i)
    return mesh
  })
  const tower = new Mesh(box, gray)
  tower.scale.set(5, 22, 5)
  tower.position.set(11, 11, -18)
  const wall = new Mesh(box, white)
  wall.scale.set(12, 3, 0.6)
  wall.position.set(-14, 1.5, -14)
  const meshes = [...balls, tower, wall]
  for (const mesh of meshes) mesh.castShadow = mesh.receiveShadow = true
  return meshes
}
