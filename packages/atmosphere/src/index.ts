export { Atmosphere } from './Atmosphere'
export type { AtmosphereFrame, AtmosphereOptions } from './Atmosphere'
export { AtmosphereParameters } from './parameters/AtmosphereParameters'
export type {
  AtmosphereParametersInit,
  ScaleHeightLayers,
  SpectralMatrix,
  Spectrum
} from './parameters/AtmosphereParameters'
export { SkyBackgroundNode, skyBackground } from './sky/SkyBackgroundNode'
export { AerialPerspectiveFogNode, aerialPerspectiveFog } from './sky/AerialPerspectiveFogNode'
export { AerialPerspectiveNode, aerialPerspective } from './sky/AerialPerspectiveNode'
export { LightSource } from './view/LightSource'
export type { Sightline, SkyLayer, SkyRay, Veil } from './view/SkyLayer'
export { SunDirectionalLight } from './lights/SunDirectionalLight'
export { SkyLightProbe } from './lights/SkyLightProbe'
export type { SkyLitPlane } from './lights/SkyLightProbe'
export { skyLuminanceAt } from './sky/skyLuminance'
export { Stars } from './stars/Stars'
export type { StarsOptions } from './stars/Stars'
export { stars } from './stars/layers'
export { brightStars } from './stars/brightStars'
export { proceduralStars } from './stars/proceduralStars'
export type { ProceduralStarsOptions } from './stars/proceduralStars'
export type { Star } from './stars/starCode'
export { MilkyWay, milkyWay } from './night/MilkyWay'
export type { MilkyWayOptions } from './night/MilkyWay'
export { Airglow, airglow } from './night/Airglow'
export type { AirglowOptions } from './night/Airglow'
export { NightLightProbe } from './night/NightLightProbe'
export { StarsOverlayNode, starsOverlay } from './stars/StarsOverlayNode'
export { exposureFor, exposureOfIlluminance } from './exposure/exposureFor'
export type { ExposureOptions } from './exposure/exposureFor'
export { DayCycle } from './exposure/DayCycle'
export type { DayCycleOptions } from './exposure/DayCycle'
export { SunFlare, sunFlare } from './halo/SunFlare'
export type { FlareOptions } from './halo/HaloUniforms'
export { Moon, moon } from './moon/Moon'
export type { MoonAppearance, MoonOptions } from './moon/Moon'
export { MoonDirectionalLight } from './moon/MoonDirectionalLight'
export { moonIlluminanceAt, moonSkyIlluminanceAt } from './moon/moonIlluminance'
export { PlanetGround, planetGround } from './ground/PlanetGround'
export type { PlanetGroundOptions } from './ground/PlanetGround'
export { AtmosphereShell, atmosphereShell } from './shell/AtmosphereShell'
export type { AtmosphereShellOptions, ShellSun } from './shell/AtmosphereShell'
export {
  airlessBody,
  isAirless,
  marsAtmosphere,
  titanAtmosphere,
  venusAtmosphere
} from './parameters/planets'
export { standardAtmosphere } from './parameters/standardAtmosphere'
export type { SkyOverlay } from './environment/SkyOverlay'
export {
  ImageEnvironmentNode,
  SkyEnvironmentNode,
  skyEnvironment
} from './environment/SkyEnvironmentNode'
export type { EnvironmentOptions, SkyEnvironmentOptions } from './environment/SkyEnvironmentNode'
export { HeightFog, heightFog } from './fog/HeightFog'
export type { HeightFogOptions } from './fog/HeightFog'
export { DistanceFog, distanceFog } from './fog/DistanceFog'
export type { DistanceFogOptions } from './fog/DistanceFog'

// For shaders of one's own; `AtmosphereNode` has an example.
export { AtmosphereNode } from './view/AtmosphereNode'
export type { AtmosphereView } from './view/AtmosphereView'
export { FragmentPass, tableTarget } from './tables/FragmentPass'
export type { Table, Texels } from './tables/TableAtlas'
export { viewNodes } from './view/ViewNodes'
export type { AtmosphereUniforms } from './air/AtmosphereUniforms'
export type { ViewNodes } from './view/ViewNodes'
export { pointAlong, scatteredRadiance, scattering } from './scattering/tsl/scattering'
export type { Air, LightSources, Ray, Scattered } from './scattering/tsl/scattering'
export { marchedAir, marchedSky } from './scattering/tsl/marchedAir'
export { rayLimits } from './skyVolume/tsl/skyVolume'
export type { AirBetween, RayLimits } from './skyVolume/tsl/skyVolume'
export { aerialPerspectiveTo } from './sky/tsl/aerialPerspective'
export type { AerialPerspective } from './sky/tsl/aerialPerspective'
export { linearSRGB, transmittanceRGB } from './air/tsl/color'
export { horizontalIrradiance } from './diffuseLight/tsl/skyIrradiance'
export { sunTransmittance as transmittanceToSun } from './transmittance/tsl/transmittance'
export { octahedralDirection, octahedralPoint } from './math/tsl/octahedron'
export type { Eye, EyeScalars } from './view/tsl/eye'

// The same physics in float64, without a GPU. Rays are in the mapped, spherical space.
export { distanceToGround, distanceToTop, hitsGround } from './air/cpu/boundary'
export { spectralToLinearSRGB, xyzToLinearSRGB } from './air/cpu/color'
export type { Triple } from './air/cpu/color'
export { gaussLegendre } from './math/cpu/quadrature'
export type { DiffuseLightData } from './diffuseLight/cpu/diffuseLight'
export { cornetteShanksPhase, rayleighPhase } from './air/cpu/phase'
export { enterAir, inScatter, skyRadiance } from './scattering/cpu/scattering'
export type { RayNumbers } from './scattering/cpu/scattering'
export { skyIrradiance } from './diffuseLight/cpu/skyIrradiance'
export { solveDiffuseLight } from './diffuseLight/cpu/solveDiffuseLight'
export type { DiffuseLightQuality } from './diffuseLight/cpu/solveDiffuseLight'
export { opticalDepth, sunTransmittance, visibleSun } from './transmittance/cpu/transmittance'
export { NIGHT_ILLUMINANCE } from './night/cpu/twilight'
export { ofLuminance } from './stars/starColor'

// Preconditions that Welkin's packages share; not for use elsewhere.
export { checkOptions, checkRange, checkSource, checkSpectrum } from './check'
export { checkAtmosphere } from './view/ViewNodes'
