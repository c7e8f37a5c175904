import { Matrix4, OrthographicCamera, PerspectiveCamera, Vector3 } from 'three'
import {
  checkChoice,
  checkFinite,
  checkMatrix,
  checkNonNegative,
  checkOptions,
  checkPositive,
  checkVector,
  fail
} from './check'
import { checkEllipsoid, Ellipsoid } from './Ellipsoid'
import { visibleDistance } from './horizon'

/** Writing of the depth buffer: the renderer's `reversedDepthBuffer`, `logarithmicDepthBuffer` or neither. */
export type DepthKind = 'standard' | 'reversed' | 'logarithmic'

/** Options of {@link fitGlobeCamera}. */
export interface FitGlobeCameraOptions {
  /** Default `Ellipsoid.WGS84`. */
  ellipsoid?: Ellipsoid
  /** World units to ECEF in metres; identity (the world is ECEF) if left out. */
  worldToECEF?: Matrix4
  /** Default: 'reversed' if the camera says so (its renderer set it), else 'standard'. */
  depth?: DepthKind
  /** Lowest ground above the ellipsoid [m], default −500. */
  minimumHeight?: number
  /** Highest ground above the ellipsoid [m], default 9000. */
  maximumHeight?: number
  /**
   * Distance from the camera to the nearest thing to be drawn [m]. Default: the camera's height
   * above `maximumHeight`, or 0 below it. Say more where it is known: standard depth gains by it.
   */
  clearance?: number
  /** Smallest near distance [m], default 0.5 for standard depth, 0.1 for the others. */
  minimumNear?: number
}

/**
 * Sets a camera's near and far planes so that they hold all of the globe that it can see, from 1 m
 * above the ground to 10 Earth radii and beyond: near is before the highest mountain beneath, far
 * is past the highest mountain that shows above the horizon. Both move smoothly with the camera.
 *
 * Satellites and aircraft are not known to it: give `clearance` (and see that they are nearer than
 * far). An orthographic camera gets the range of the whole globe.
 *
 * Call it after the camera moved. Its `updateProjectionMatrix()` is called if the planes changed.
 *
 * ```ts
 * fitGlobeCamera(camera, { worldToECEF: atmosphere.worldToECEF })
 * ```
 *
 * @param camera - Perspective or orthographic; its world matrix is brought up to date.
 * @throws Error if an option is out of range or the camera is of another kind.
 */
export function fitGlobeCamera(
  camera: PerspectiveCamera | OrthographicCamera,
  options: FitGlobeCameraOptions = {}
): void {
  const settings = resolve(camera, options)
  camera.updateWorldMatrix(true, false)
  const positionECEF = new Vector3()
    .setFromMatrixPosition(camera.matrixWorld)
    .applyMatrix4(settings.worldToECEF)
  checkVector('fitGlobeCamera', 'camera position in ECEF', positionECEF)
  const { near, far } =
    camera instanceof OrthographicCamera
      ? orthographicRange(camera, positionECEF, settings)
      : perspectiveRange(camera, positionECEF, settings)

  const metersPerUnit = settings.worldToECEF.getMaxScaleOnAxis()
  checkPositive('fitGlobeCamera', 'scale of worldToECEF', metersPerUnit)
  if (camera.near === near / metersPerUnit && camera.far === far / metersPerUnit) return
  camera.near = near / metersPerUnit
  camera.far = far / metersPerUnit
  camera.updateProjectionMatrix()
}

interface Range {
  near: number
  far: number
}

type Settings = Required<Omit<FitGlobeCameraOptions, 'clearance' | 'depth'>> & {
  clearance: number | undefined
}

function perspectiveRange(
  camera: PerspectiveCamera,
  positionECEF: Vector3,
  settings: Settings
): Range {
  const { ellipsoid, minimumHeight, maximumHeight, minimumNear } = settings
  const clearance =
    settings.clearance ?? Math.max(ellipsoid.heightAt(positionECEF) - maximumHeight, 0)
  // A point at distance D in a corner of the picture is only D cos(half diagonal) deep.
  const p = camera.projectionMatrix.elements
  const corner = Math.hypot((1 + Math.abs(p[8])) / p[0], (1 + Math.abs(p[9])) / p[5], 1)
  const near = Math.max(minimumNear, (0.99 * clearance) / corner)

  // On a spheroid the horizon is nearest and farthest along the meridian or the parallel.
  let far = 0
  for (const azimuthDegrees of [0, 90, 180, 270]) {
    const distance = visibleDistance(positionECEF, maximumHeight, minimumHeight, {
      ellipsoid,
      azimuthDegrees
    })
    far = Math.max(far, distance)
  }
  return { near, far: 1.01 * Math.max(far, near) }
}

/** Parallel rays see past the horizon of the camera's place, so this is the globe's whole depth. */
function orthographicRange(
  camera: OrthographicCamera,
  positionECEF: Vector3,
  { ellipsoid, worldToECEF, maximumHeight, minimumNear, clearance }: Settings
): Range {
  const forward = new Vector3(0, 0, -1)
    .transformDirection(camera.matrixWorld)
    .transformDirection(worldToECEF)
  const center = -positionECEF.dot(forward)
  const extent = forward.multiply(ellipsoid.grown(maximumHeight).radii).length()
  const near = Math.max(clearance ?? center - extent, minimumNear)
  return { near, far: Math.max(center + extent, 1.01 * near) }
}

function resolve(
  camera: PerspectiveCamera | OrthographicCamera,
  options: FitGlobeCameraOptions
): Settings {
  const where = 'fitGlobeCamera'
  if (!(camera instanceof PerspectiveCamera || camera instanceof OrthographicCamera)) {
    fail(where, 'camera must be a PerspectiveCamera or an OrthographicCamera', camera)
  }
  const {
    ellipsoid = Ellipsoid.WGS84,
    worldToECEF = new Matrix4(),
    depth = camera.reversedDepth ? 'reversed' : 'standard',
    minimumHeight = -500,
    maximumHeight = 9000,
    clearance,
    minimumNear = depth === 'standard' ? 0.5 : 0.1
  } = checkOptions(
    where,
    options,
    'ellipsoid',
    'worldToECEF',
    'depth',
    'minimumHeight',
    'maximumHeight',
    'clearance',
    'minimumNear'
  )
  checkEllipsoid(where, ellipsoid)
  checkMatrix(where, 'worldToECEF', worldToECEF)
  checkFinite(where, 'minimumHeight', minimumHeight)
  checkFinite(where, 'maximumHeight', maximumHeight)
  if (minimumHeight > maximumHeight) {
    fail(where, `minimumHeight must be at most maximumHeight (${maximumHeight})`, minimumHeight)
  }
  if (clearance !== undefined) checkNonNegative(where, 'clearance', clearance)
  checkPositive(where, 'minimumNear', minimumNear)
  checkChoice(where, 'depth', depth, ['standard', 'reversed', 'logarithmic'])
  return { ellipsoid, worldToECEF, minimumHeight, maximumHeight, clearance, minimumNear }
}
