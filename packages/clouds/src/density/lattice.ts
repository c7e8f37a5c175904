import { Quaternion, Vector3 } from 'three'

/** A rotation without a simple relation to the axes, different for each number. */
function seededRotation(n: number): Quaternion {
  const axis = new Vector3(
    Math.cos(1 + 2.399963 * n),
    Math.sin(1 + 2.399963 * n),
    Math.cos(2 + 1.324718 * n)
  )
  return new Quaternion().setFromAxisAngle(axis.normalize(), 0.7 + 1.754878 * n)
}

/** A turn about the planet's axis, different for each number, and a lean away from it [rad]. */
function seededTilt(n: number, lean: number): Quaternion {
  const axis = new Vector3(Math.cos(2.399963 * n), Math.sin(2.399963 * n), 0)
  const spin = new Quaternion().setFromAxisAngle(new Vector3(0, 0, 1), 0.7 + 1.754878 * n)
  return new Quaternion().setFromAxisAngle(axis, lean).multiply(spin)
}

/**
 * How the lattices of the noise look-ups lie in the planet: each askew to the planet's axes and to the
 * others, so that rows of one never fall on rows of another. The weather leans but a little: what it draws
 * out across its third axis, the ground cuts in streaks from west to east.
 */
export const latticeRotations = {
  weather: /*#__PURE__*/ seededTilt(0, 0.22),
  fields: /*#__PURE__*/ seededTilt(4, 0.3),
  region: /*#__PURE__*/ seededRotation(1),
  shape: /*#__PURE__*/ seededRotation(2),
  detail: /*#__PURE__*/ seededRotation(3)
}

/** How a layer's noise is turned against another's before any wind. */
export const layerRotation = (index: number): Quaternion => seededTilt(10 + index, 0.12)
