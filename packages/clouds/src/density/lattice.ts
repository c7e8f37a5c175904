import { Quaternion, Vector3 } from 'three'

/** Rotation about an axis of any length. */
const rotation = (x: number, y: number, z: number, angle: number): Quaternion =>
  new Quaternion().setFromAxisAngle(new Vector3(x, y, z).normalize(), angle)

/** Rotation without a simple relation to the axes, different for each seed. */
function seededRotation(seed: number): Quaternion {
  const azimuth = 1 + 2.399963 * seed
  const z = Math.cos(2 + 1.324718 * seed)
  return rotation(Math.cos(azimuth), Math.sin(azimuth), z, 0.7 + 1.754878 * seed)
}

/** Turn about the planet's axis, different for each seed, and a tilt away from it [rad]. */
function seededTilt(seed: number, tilt: number): Quaternion {
  const azimuth = 2.399963 * seed
  const spin = rotation(0, 0, 1, 0.7 + 1.754878 * seed)
  return rotation(Math.cos(azimuth), Math.sin(azimuth), 0, tilt).multiply(spin)
}

/**
 * Rotations of the lattices that noise is looked up in, from the frame of a layer: each rotated against
 * the planet's axes and the others, so that rows of one never fall on rows of another. The weather is tilted
 * but a little: the ground cuts what lies flat in it, as cirrus does, into streaks from west to east.
 */
export const latticeRotations = {
  weather: /*#__PURE__*/ seededTilt(0, 0.22),
  fields: /*#__PURE__*/ seededTilt(4, 0.3),
  mesoscale: /*#__PURE__*/ seededTilt(6, 0.5),
  region: /*#__PURE__*/ seededRotation(1),
  shape: /*#__PURE__*/ seededRotation(2),
  detail: /*#__PURE__*/ seededRotation(3)
}

/** Rotation of a layer's noise before any wind: no two layers have their clouds at the same places. */
export const layerRotation = (index: number): Quaternion => seededTilt(10 + index, 0.12)
