import { EventDispatcher, Matrix4, Vector3 } from 'three'
import type { Object3D } from 'three'
import { checkMatrix, checkOptions, checkPositive, checkVector, fail } from './check'

/** Options of {@link FloatingOrigin}. */
export interface FloatingOriginOptions {
  /** World units to ECEF in metres at the start; identity (the world is ECEF) if left out. Copied. */
  worldToECEF?: Matrix4
  /** Distance of the camera from the world's origin at which `update` rebases [world units], default 10,000. */
  threshold?: number
}

/** Events of {@link FloatingOrigin}. */
export interface FloatingOriginEventMap {
  /** Fired after a rebase: what stands at `offset` in the old world frame is at the origin in the new one. */
  rebase: { offset: Vector3 }
}

/**
 * Keeps the world's origin near the camera, so that float32 positions on the GPU keep their digits.
 *
 * Rebasing subtracts one offset from the root objects and the camera, which changes no picture, and
 * multiplies it into `worldToECEF`, so that the same ECEF position is known by new coordinates.
 * Offsets are whole numbers of world units: with roots that stand in the scene itself the float64
 * arithmetic is exact, and a thousand rebases add no error.
 *
 * Keep what you move by hand in world coordinates (a controls' target, a physics engine) in step
 * through the `rebase` event.
 *
 * ```ts
 * const origin = new FloatingOrigin([world], camera)
 * origin.addEventListener('rebase', ({ offset }) => {
 *   controls.target.sub(offset)
 *   atmosphere.worldToECEF.copy(origin.worldToECEF)
 * })
 * // each frame, before rendering
 * origin.update()
 * ```
 */
export class FloatingOrigin extends EventDispatcher<FloatingOriginEventMap> {
  /** World units to ECEF in metres; kept up to date by rebasing. */
  readonly worldToECEF: Matrix4
  readonly #roots: readonly Object3D[]
  readonly #camera: Object3D
  #threshold = 10_000

  /**
   * @param roots - Objects that together hold the scene; none inside another.
   * @param camera - In one of the roots, elsewhere, or without a parent.
   * @throws Error if a root is inside another root or the threshold is not positive.
   */
  constructor(
    roots: Object3D | readonly Object3D[],
    camera: Object3D,
    options: FloatingOriginOptions = {}
  ) {
    super()
    checkOptions('FloatingOrigin', options, 'worldToECEF', 'threshold')
    const { worldToECEF = new Matrix4(), threshold = 10_000 } = options
    this.threshold = threshold
    this.#roots = Array.isArray(roots) ? [...roots] : [roots as Object3D]
    for (const root of this.#roots) {
      if (!root?.isObject3D) {
        fail('FloatingOrigin', 'roots must be an Object3D or an array of such', roots)
      }
      if (this.#roots.some(other => other !== root && isInside(root, other))) {
        fail('FloatingOrigin', 'roots must not be inside one another', root)
      }
    }
    if (!camera?.isObject3D) fail('FloatingOrigin', 'camera must be an Object3D', camera)
    this.#camera = camera
    checkMatrix('FloatingOrigin', 'worldToECEF', worldToECEF)
    this.worldToECEF = worldToECEF.clone()
  }

  /** Distance of the camera from the world's origin at which `update` rebases, > 0 [world units]. */
  get threshold(): number {
    return this.#threshold
  }

  set threshold(value: number) {
    checkPositive('FloatingOrigin', 'threshold', value)
    this.#threshold = value
  }

  /**
   * Rebases to the camera if it is farther than `threshold` from the world's origin.
   *
   * @returns True if it did.
   */
  update(): boolean {
    this.#camera.updateWorldMatrix(true, false)
    const position = new Vector3().setFromMatrixPosition(this.#camera.matrixWorld)
    if (position.length() <= this.threshold) return false
    this.rebase(position)
    return true
  }

  /**
   * Moves the world's origin to a position, rounded to whole world units.
   *
   * @param positionWorld - In the present world frame [world units].
   * @throws Error if a component is not finite.
   */
  rebase(positionWorld: Vector3): void {
    checkVector('FloatingOrigin.rebase', 'positionWorld', positionWorld)
    const offset = positionWorld.clone().round()
    for (const root of this.#roots) shift(root, offset)
    if (!this.#roots.some(root => isInside(this.#camera, root))) shift(this.#camera, offset)
    this.worldToECEF.multiply(new Matrix4().makeTranslation(offset))
    this.dispatchEvent({ type: 'rebase', offset })
  }
}

function isInside(object: Object3D, ancestor: Object3D): boolean {
  let at: Object3D | null = object
  while (at !== null && at !== ancestor) at = at.parent
  return at === ancestor
}

/** Moves an object by −offset in the world, whatever its parent is. */
function shift(object: Object3D, offset: Vector3): void {
  const local = offset.clone()
  if (object.parent !== null) {
    object.parent.updateWorldMatrix(true, false)
    const { elements } = object.parent.matrixWorld
    // Left alone under an identity: inverting it would not change the digits, but dividing could.
    if (elements.some((value, i) => value !== (i % 5 === 0 ? 1 : 0))) {
      const inverse = object.parent.matrixWorld.clone().setPosition(0, 0, 0).invert()
      local.applyMatrix4(inverse)
    }
  }
  if (object.matrixAutoUpdate) {
    object.position.sub(local)
    object.updateMatrix()
  } else {
    // Its matrix is the truth: position may be stale.
    const m = object.matrix.elements
    object.matrix.setPosition(m[12] - local.x, m[13] - local.y, m[14] - local.z)
    object.position.setFromMatrixPosition(object.matrix)
    object.matrixWorldNeedsUpdate = true
  }
  object.updateWorldMatrix(false, true)
}
