import { Matrix3, Matrix4, Quaternion, Vector3 } from 'three'

/** A rotation without a simple relation to the axes, different for each number. */
function askew(n: number): Quaternion {
  const axis = new Vector3(
    Math.cos(1 + 2.399963 * n),
    Math.sin(1 + 2.399963 * n),
    Math.cos(2 + 1.324718 * n)
  )
  return new Quaternion().setFromAxisAngle(axis.normalize(), 0.7 + 1.754878 * n)
}

const matrix = (n: number): Matrix3 =>
  new Matrix3().setFromMatrix4(new Matrix4().makeRotationFromQuaternion(askew(n)))

/**
 * How the lattices of the noise look-ups lie in the planet: each askew to the planet's axes and to the
 * others, so that rows of one never fall on rows of another.
 */
export const latticeRotation = {
  weather: /*#__PURE__*/ matrix(0),
  weatherAgain: /*#__PURE__*/ matrix(4),
  region: /*#__PURE__*/ matrix(1),
  shape: /*#__PURE__*/ matrix(2),
  detail: /*#__PURE__*/ matrix(3)
}

/** How a layer's noise is turned against another's before any wind. */
export const layerTurn = (index: number): Quaternion => askew(10 + index)
