import {
  BoxGeometry,
  CylinderGeometry,
  Group,
  Mesh,
  MeshStandardMaterial,
  PlaneGeometry,
  PointLight,
  SphereGeometry
} from 'three'
import { wetSurface, type SurfaceWater } from '@welkin/atmosphere'
import { float } from 'three/tsl'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import type { Obstacle } from '../moving/obstacles'
import { randomSequence } from '../random'

/** Luminous intensity of a street lamp [cd], 6,200 lm of sodium light to all sides; radius and height of its globe [m]. */
const LAMP = 490
const GLOBE = 0.25
const LAMP_HEIGHT = 4.6
/** Luminance of a lit window, and of a globe [cd/m²]. */
const WINDOW = 6
const GLASS = LAMP / (Math.PI * GLOBE ** 2)

/** A street between two rows of houses, towards −Z, and the lamps along it. */
export interface Houses {
  readonly object: Group
  readonly ground: Mesh
  /** Walls, for those on foot. */
  readonly obstacles: readonly Obstacle[]
  readonly lamps: readonly PointLight[]
  readonly globes: readonly Mesh[]
  /** @param share - Part of the lamps' light, in [0, 1]. */
  light(share: number, luminanceScale: number): void
  dispose(): void
}

/**
 * @param ground - Material of the street.
 * @param water - Water and snow on the roofs; left out, they stay dry.
 */
export function createHouses(
  ground: MeshStandardMaterial | MeshStandardNodeMaterial,
  water?: SurfaceWater
): Houses {
  const random = randomSequence(11)
  const object = new Group()
  const glow: { material: MeshStandardMaterial; luminance: number }[] = []
  const lamps: PointLight[] = []
  const globes: Mesh[] = []
  const obstacles: Obstacle[] = []
  const add = (mesh: Mesh, x: number, y: number, z: number): Mesh => {
    mesh.position.set(x, y, z)
    mesh.castShadow = mesh.receiveShadow = true
    object.add(mesh)
    return mesh
  }
  const street = add(new Mesh(new PlaneGeometry(400, 400).rotateX(-Math.PI / 2), ground), 0, 0, 0)
  const roofs = new MeshStandardNodeMaterial({ color: '#33261f', roughness: 0.9 })
  if (water !== undefined) Object.assign(roofs, wetSurface(water, { exposure: float(0.55) }))
  const panes = new MeshStandardMaterial({ color: '#15181b', roughness: 0.2 })
  const lit = new MeshStandardMaterial({ color: '#15181b', emissive: '#ffb066' })
  glow.push({ material: lit, luminance: WINDOW })
  const pane = new PlaneGeometry(0.9, 1.4)
  for (let i = 0; i < 14; i++) {
    const side = i % 2 === 0 ? -1 : 1
    const [width, height] = [9 + 2 * random(), 6 + 3.5 * random()]
    const z = -4 - 10.5 * Math.floor(i / 2)
    const x = side * (10.5 + random())
    const color = ['#6d6255', '#5b4a40', '#767068', '#4d4a46'][Math.floor(4 * random())]
    const walls = new MeshStandardMaterial({ color, roughness: 0.85 })
    add(new Mesh(new BoxGeometry(8, height, width), walls), x, height / 2, z)
    obstacles.push({ x, z, width: 8, depth: width, top: height })
    const roof = new CylinderGeometry(0.1, 4.6, 2.6, 4, 1).rotateY(Math.PI / 4)
    add(new Mesh(roof.scale(1.3, 1, (1.35 * width) / 8), roofs), x, height + 1.3, z)
    for (let n = 0; n < 6; n++) {
      const window = new Mesh(pane, random() < 0.35 ? lit : panes)
      window.rotation.y = (-side * Math.PI) / 2
      add(window, x - side * 4.03, 1.8 + 2.9 * Math.floor(n / 3), z + 2.8 * ((n % 3) - 1))
    }
  }
  const iron = new MeshStandardMaterial({ color: '#1c1d1e', roughness: 0.6 })
  const glass = new MeshStandardMaterial({ color: '#ffffff', emissive: '#ffc98a' })
  glow.push({ material: glass, luminance: GLASS })
  for (let i = 0; i < 4; i++) {
    const [x, z] = [(i % 2 === 0 ? -1 : 1) * 4.4, -6 - 8 * i]
    add(new Mesh(new CylinderGeometry(0.05, 0.08, LAMP_HEIGHT, 8), iron), x, LAMP_HEIGHT / 2, z)
    const globe = add(new Mesh(new SphereGeometry(GLOBE, 24, 16), glass), x, LAMP_HEIGHT, z)
    globe.castShadow = false
    globes.push(globe)
    const lamp = new PointLight('#ffc98a', 0, 60)
    lamp.position.set(x, LAMP_HEIGHT, z)
    object.add(lamp)
    lamps.push(lamp)
  }
  return {
    object,
    ground: street,
    lamps,
    globes,
    obstacles,
    light(share, luminanceScale) {
      for (const { material, luminance } of glow) {
        material.emissiveIntensity = share * luminance * luminanceScale
      }
      for (const lamp of lamps) lamp.intensity = share * LAMP * luminanceScale
    },
    dispose() {
      object.traverse(child => {
        if (!(child instanceof Mesh)) return
        child.geometry.dispose()
        for (const material of [child.material].flat()) material.dispose()
      })
    }
  }
}
