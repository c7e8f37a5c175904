import type { Vector3 } from 'three'

type Axis = 'x' | 'y' | 'z'
const axes: readonly Axis[] = ['z', 'y', 'x']

/**
 * Unit outward normal at the point of an ellipsoid that is nearest to a position.
 *
 * The foot point q satisfies pᵢ = qᵢ (1 + t / rᵢ²) for one t, which the surface equation fixes:
 * F(t) = Σ (rᵢ pᵢ / (t + rᵢ²))² − 1 = 0. On t > −min rᵢ² F is convex and falls, so Newton's method
 * started where F ≥ 0 climbs to the root without overshooting. The unknown here is u = t + min rᵢ²,
 * which keeps its digits near the centre, where t + min rᵢ² would cancel. Lengths are in units of
 * the smallest radius.
 *
 * On the part of the plane or axis inside the evolute (for the Earth, the disc of 42.8 km around the
 * centre) two or more points are nearest: the one with the non-negative coordinate is returned, so
 * the centre has the north pole as its foot.
 *
 * @param position - Relative to the centre, finite; any frame whose axes are the ellipsoid's [m].
 * @param radii - Along the three axes, positive [m].
 * @param target - Receives the normal; may be `position`.
 * @see Eberly, 2013, "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", "Distance from a
 *   Point to an Ellipsoid".
 */
export function footPointNormal(position: Vector3, radii: Vector3, target: Vector3): Vector3 {
  const smallest = Math.min(radii.x, radii.y, radii.z)
  const px = withoutDenormals(position.x / smallest)
  const py = withoutDenormals(position.y / smallest)
  const pz = withoutDenormals(position.z / smallest)
  const rx = radii.x / smallest
  const ry = radii.y / smallest
  const rz = radii.z / smallest
  const gapX = (rx - 1) * (rx + 1)
  const gapY = (ry - 1) * (ry + 1)
  const gapZ = (rz - 1) * (rz + 1)

  // Where one of F's squares is 1; the largest of them has F ≥ 0.
  let u = Math.max(rx * Math.abs(px) - gapX, ry * Math.abs(py) - gapY, rz * Math.abs(pz) - gapZ, 0)
  for (let i = 0; i < 64; ++i) {
    const x = ratio(rx * px, u + gapX)
    const y = ratio(ry * py, u + gapY)
    const z = ratio(rz * pz, u + gapZ)
    const excess = x * x + y * y + z * z - 1
    // At u = 0 a negative F has no root: the position is on the evolute's plane or axis.
    if (!(excess > 0)) break
    const slope = 2 * (ratio(x * x, u + gapX) + ratio(y * y, u + gapY) + ratio(z * z, u + gapZ))
    const next = u + excess / slope
    if (!(next > u)) break
    u = next
  }

  target.set(ratio(px, u + gapX), ratio(py, u + gapY), ratio(pz, u + gapZ))
  if (u === 0) addNormalOfSmallestAxis(target, radii, smallest)
  return target.normalize()
}

/** The coordinate that F leaves free on the evolute's plane: what the surface equation has over. */
function addNormalOfSmallestAxis(target: Vector3, radii: Vector3, smallest: number): void {
  const axis = axes.find(name => radii[name] === smallest) ?? 'z'
  const x = (target.x * radii.x) / smallest
  const y = (target.y * radii.y) / smallest
  const z = (target.z * radii.z) / smallest
  target[axis] = Math.sqrt(Math.max(1 - x * x - y * y - z * z, 0))
}

/** 0 / 0 is 0 here: a coordinate that is zero stays zero on the foot point. */
function ratio(numerator: number, denominator: number): number {
  return numerator === 0 ? 0 : numerator / denominator
}

/** Squares of such coordinates would underflow; at this scale they are 0 in any unit of length. */
function withoutDenormals(value: number): number {
  return Math.abs(value) < 1e-140 ? 0 : value
}
