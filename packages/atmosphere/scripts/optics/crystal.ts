/** Vector in the frame of a crystal, whose axis is z. */
export type Vector = [number, number, number]

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
const along = (a: Vector, s: number, b: Vector, t: number): Vector => [
  a[0] * s + b[0] * t,
  a[1] * s + b[1] * t,
  a[2] * s + b[2] * t
]

/** Hexagonal prism of ice, its hexagon inscribed into a circle of radius 1. */
export interface Prism {
  /** Half its length along the axis, over the radius of its hexagon. */
  readonly halfLength: number
}

/** Distance from the axis to a side. */
const APOTHEM = Math.sqrt(3) / 2

/** Outward normals of the faces: six sides, top, bottom. */
const normals: readonly Vector[] = [
  ...Array.from({ length: 6 }, (_, i): Vector => {
    const angle = ((i + 0.5) * Math.PI) / 3
    return [Math.cos(angle), Math.sin(angle), 0]
  }),
  [0, 0, 1],
  [0, 0, -1]
]

/** Area of a hexagonal face, and of a side per half length. */
const HEXAGON = (3 * Math.sqrt(3)) / 2

const areaOf = (face: number, { halfLength }: Prism): number =>
  face < 6 ? 2 * halfLength : HEXAGON

/** Area of the prism's shadow in light of a direction. */
export function shadowArea(prism: Prism, direction: Vector): number {
  let area = 0
  normals.forEach((normal, face) => {
    area += Math.max(-dot(normal, direction), 0) * areaOf(face, prism)
  })
  return area
}

/** Mean shadow of a prism all ways: a quarter of its surface (Cauchy). */
export const meanShadow = ({ halfLength }: Prism): number => (12 * halfLength + 2 * HEXAGON) / 4

/** Share of a prism's surface that is its sides. */
export const sideShare = (prism: Prism): number => (3 * prism.halfLength) / meanShadow(prism)

/** Random point of a face. */
function pointOn(face: number, { halfLength }: Prism, random: () => number): Vector {
  if (face >= 6) {
    for (;;) {
      const [x, y] = [2 * random() - 1, 2 * random() - 1]
      const inside = normals.slice(0, 6).every(([a, b]) => a * x + b * y <= APOTHEM)
      if (inside) return [x, y, face === 6 ? halfLength : -halfLength]
    }
  }
  const [nx, ny] = normals[face]
  const aside = random() - 0.5
  return [nx * APOTHEM - ny * aside, ny * APOTHEM + nx * aside, (2 * random() - 1) * halfLength]
}

/**
 * Reflectance of unpolarised light.
 *
 * @param cosine - Cosine of the angle of incidence, > 0.
 * @param ratio - Refractive index on the near side over that on the far side.
 * @returns And the cosine of the refracted ray; 1 and 0 for total reflection.
 * @see Born & Wolf 1999, "Principles of optics", 7th ed., §1.5.2
 */
function fresnel(cosine: number, ratio: number): [reflectance: number, refracted: number] {
  const square = 1 - ratio * ratio * (1 - cosine * cosine)
  if (square <= 0) return [1, 0]
  const refracted = Math.sqrt(square)
  const across = (ratio * cosine - refracted) / (ratio * cosine + refracted)
  const within = (cosine - ratio * refracted) / (cosine + ratio * refracted)
  return [(across * across + within * within) / 2, refracted]
}

/** Reflections inside after which a ray is let go. */
const MOST_REFLECTIONS = 30

/**
 * Direction in which a ray of light leaves a prism: reflected and refracted at its faces by chance, as often as light is.
 *
 * @param index - Refractive index.
 * @param direction - Direction of the light, unit length; points are spread over the prism's shadow.
 */
export function traceRay(
  prism: Prism,
  index: number,
  direction: Vector,
  random: () => number
): Vector {
  let choice = random() * shadowArea(prism, direction)
  let face = -1
  while (choice >= 0 && face < 7) {
    face++
    choice -= Math.max(-dot(normals[face], direction), 0) * areaOf(face, prism)
  }
  let point = pointOn(face, prism, random)
  let normal = normals[face]
  const incidence = -dot(normal, direction)
  const [reflected, refracted] = fresnel(incidence, 1 / index)
  if (random() < reflected) return along(direction, 1, normal, 2 * incidence)
  let ray = along(direction, 1 / index, normal, incidence / index - refracted)
  for (let i = 0; i < MOST_REFLECTIONS; i++) {
    let distance = Infinity
    let next = 0
    normals.forEach((each, k) => {
      const towards = dot(each, ray)
      if (towards <= 1e-12) return
      const to = ((k < 6 ? APOTHEM : prism.halfLength) - dot(each, point)) / towards
      if (to < distance) [distance, next] = [to, k]
    })
    point = along(point, 1, ray, distance)
    normal = normals[next]
    const cosine = dot(normal, ray)
    const [share, outside] = fresnel(cosine, index)
    if (random() >= share) return along(ray, index, normal, outside - index * cosine)
    ray = along(ray, 1, normal, -2 * cosine)
  }
  return direction
}

/** Rotation of the crystal's frame by random angles: columns are its axes in the frame of the light. */
export type Axes = [Vector, Vector, Vector]

/** Random orientation, all alike. @see Shoemake 1992, "Uniform random rotations" */
export function randomAxes(random: () => number): Axes {
  const [a, b, c] = [random(), 2 * Math.PI * random(), 2 * Math.PI * random()]
  const [s, t] = [Math.sqrt(1 - a), Math.sqrt(a)]
  const [x, y, z, w] = [s * Math.sin(b), s * Math.cos(b), t * Math.sin(c), t * Math.cos(c)]
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
    [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
    [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)]
  ]
}

/** Vector in the crystal's frame, of one in the frame of the light. */
export const toCrystal = (axes: Axes, v: Vector): Vector => [
  dot(axes[0], v),
  dot(axes[1], v),
  dot(axes[2], v)
]
