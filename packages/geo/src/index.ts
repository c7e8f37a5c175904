export { Ellipsoid } from './Ellipsoid'
export { Geodetic } from './Geodetic'
export type { GeodeticLike } from './Geodetic'
export { geodesicDestination, geodesicDistance, geodesicInverse } from './geodesic'
export type { GeodesicPath } from './geodesic'
export { horizonDip, horizonDistance, tangentLimbDistance, visibleDistance } from './horizon'
export type { HorizonOptions } from './horizon'
export { fitGlobeCamera } from './fitGlobeCamera'
export type { DepthKind, FitGlobeCameraOptions } from './fitGlobeCamera'
export { FloatingOrigin } from './FloatingOrigin'
export type { FloatingOriginEventMap, FloatingOriginOptions } from './FloatingOrigin'
export { ecefFromTilesGroup } from './tiles'
export { eciToECEF, siderealAngle } from './earthRotation'
export { sunDirectionECEF, sunPositionECEF } from './sun'
export { moonDirectionECEF, moonOrientation, moonPositionECEF } from './moon'
export { offsetPoint } from './tsl/offsetPoint'
export type { OffsetPoint } from './tsl/offsetPoint'
// Preconditions that Welkin's packages share; not for use elsewhere.
export {
  checkBoolean,
  checkChoice,
  checkDate,
  checkDirection,
  checkFinite,
  checkMatrix,
  checkNonNegative,
  checkOptions,
  checkPlace,
  checkPositive,
  checkVector,
  fail,
  failUnknown,
  setOptions
} from './check'
export { checkEllipsoid } from './Ellipsoid'
