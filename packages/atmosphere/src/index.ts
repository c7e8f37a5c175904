export { Atmosphere } from './Atmosphere'
export type { AtmosphereOptions } from './Atmosphere'
export type { AtmosphereFrame } from './ScenePlanet'
export type { AtmosphereTables } from './tables/AtmosphereTables'
export { AtmosphereParameters } from './parameters/AtmosphereParameters'
export type {
  AtmosphereParametersFields,
  AtmosphereParametersInit,
  ScaleHeightLayers,
  SpectralMatrix,
  Spectrum
} from './parameters/AtmosphereParameters'
export { SkyBackgroundNode, skyBackground } from './sky/SkyBackgroundNode'
export type { SkyBackgroundOptions } from './sky/SkyBackgroundNode'
export { AerialPerspectiveFogNode, aerialPerspectiveFog } from './sky/AerialPerspectiveFogNode'
export { AerialPerspectiveNode, aerialPerspective } from './sky/AerialPerspectiveNode'
export { whereSeen } from './sky/whereSeen'
export { AirStyle, airStyle } from './sky/AirStyle'
export type { AirStyleOptions } from './sky/AirStyle'
export { SkyVelocityNode, skyVelocity } from './sky/SkyVelocityNode'
export { LightShafts, lightShafts } from './shafts/LightShafts'
export type { LightShaftsOptions } from './shafts/LightShafts'
export { HeightFieldShadow, heightFieldShadow } from './shafts/HeightFieldShadow'
export type { HeightField, HeightFieldShadowOptions } from './shafts/HeightFieldShadow'
export { TerrainShadowNode, terrainShadow } from './shafts/TerrainShadowNode'
export type { TargetedLight } from './shafts/TerrainShadowNode'
export type { LightShaftsQuality } from './shafts/quality'
export type {
  AirOccluder,
  AirPoint,
  AirViewRay,
  AirShadow,
  ShadowedShafts
} from './shafts/AirOccluder'
export type { AirOptions, AirShadows, ScreenShadows, ForegroundLayer } from './view/AirShadows'
export { LightSource } from './view/LightSource'
export type { LayerRay, PointRay, ShadowedMedium, SkyLayer, SkyRay } from './view/SkyLayer'
export { SunDirectionalLight } from './lights/SunDirectionalLight'
export { SkyLightProbe } from './lights/SkyLightProbe'
export type { SkyLitPlane } from './lights/SkyLightProbe'
export { SurfaceLightingNode, surfaceLighting } from './lights/SurfaceLightingNode'
export type { SurfaceLightingOptions } from './lights/SurfaceLightingNode'
export { moonIlluminanceAt, skyIlluminanceAt, sunIlluminanceAt } from './queries/illuminance'
export type { IlluminanceOptions, SkyIlluminanceOptions } from './queries/illuminance'
export type { CloudedPoint, CloudedSky } from './queries/CloudedSky'
export { skyLuminanceAt } from './queries/skyLuminance'
export type { SkyLuminanceOptions } from './queries/skyLuminance'
export { Stars } from './stars/Stars'
export type { StarsOptions } from './stars/Stars'
export { stars } from './stars/nakedEyeStars'
export { brightStars } from './stars/brightStars'
export { proceduralStars } from './stars/proceduralStars'
export type { ProceduralStarsOptions } from './stars/proceduralStars'
export type { Star } from './stars/starEncoding'
export { MilkyWay, milkyWay } from './night/MilkyWay'
export type { MilkyWayOptions } from './night/MilkyWay'
export { Airglow, airglow } from './night/Airglow'
export type { AirglowOptions } from './night/Airglow'
export { NightLightProbe } from './night/NightLightProbe'
export { StarsOverlayNode, starsOverlay } from './stars/StarsOverlayNode'
export { exposureFor, exposureOfIlluminance } from './exposure/exposureFor'
export type { ExposureOptions } from './exposure/exposureFor'
export { AutoExposureNode, autoExposure } from './exposure/AutoExposureNode'
export type { AutoExposureOptions } from './exposure/AutoExposureNode'
export { DayCycle } from './exposure/DayCycle'
export type { DayCycleOptions } from './exposure/DayCycle'
export { SunFlare, sunFlare } from './halo/SunFlare'
export { Flare, type FlareOptions } from './halo/Flare'
export { Moon, moon } from './moon/Moon'
export type { MoonAppearance, MoonOptions } from './moon/MoonOptions'
export { MoonDirectionalLight } from './moon/MoonDirectionalLight'
export { PlanetGround, planetGround } from './ground/PlanetGround'
export type { PlanetGroundOptions } from './ground/PlanetGround'
export { AtmosphereShell } from './shell/AtmosphereShell'
export type { AtmosphereShellOptions } from './shell/AtmosphereShell'
export type { ShellSun } from './shell/ShellSun'
export {
  airlessParameters,
  marsParameters,
  titanParameters,
  venusParameters
} from './parameters/planets'
export { standardEarthParameters } from './parameters/standardEarth'
export type { SkyOverlay } from './environment/SkyOverlay'
export { SkyEnvironmentNode, skyEnvironment } from './environment/SkyEnvironmentNode'
export type { SkyEnvironmentOptions } from './environment/SkyEnvironmentNode'
export { ImageEnvironmentNode, imageEnvironment } from './environment/ImageEnvironmentNode'
export type { EnvironmentOptions } from './environment/ImageEnvironmentNode'
export { HeightFog, heightFog } from './fog/HeightFog'
export type { HeightFogOptions } from './fog/HeightFog'
export { DistanceFog, distanceFog } from './fog/DistanceFog'
export type { DistanceFogOptions } from './fog/DistanceFog'
export type { FogOvercast } from './fog/FogOvercast'
export { Droplets, droplets } from './optics/Droplets'
export type { DropletsOptions } from './optics/Droplets'
export { Raindrops, raindrops } from './optics/Raindrops'
export type { RaindropsOptions } from './optics/Raindrops'
export { IceCrystals, iceCrystals } from './optics/IceCrystals'
export type { IceCrystalsOptions } from './optics/IceCrystals'
export { rainfall } from './precipitation/rainfall'
export { snowfall } from './precipitation/snowfall'
export type { Precipitation } from './precipitation/Precipitation'
export type { PrecipitationOptions } from './precipitation/PrecipitationOptions'
export type { PrecipitationWind } from './precipitation/FallingLattice'
export { PrecipitationShelter } from './precipitation/PrecipitationShelter'
export type { PrecipitationShelterOptions } from './precipitation/PrecipitationShelter'
export {
  PrecipitationOverlayNode,
  precipitationOverlay
} from './precipitation/PrecipitationOverlayNode'
export type { ScatteringAngles, ScatteringPhase } from './optics/ScatteringPhase'

// For shaders of one's own; `AtmosphereNode` has an example.
export { AtmosphereNode } from './view/AtmosphereNode'
export type { AtmosphereView } from './view/AtmosphereView'
export { FragmentPass, outputs, tableTarget } from './tables/FragmentPass'
export type { Outputs } from './tables/FragmentPass'
export type { Table, Texels } from './tables/TableAtlas'
export { viewNodes } from './view/ViewNodes'
export type { AtmosphereUniforms } from './air/AtmosphereUniforms'
export type { ViewNodes } from './view/ViewNodes'
export type { ViewUniforms } from './view/ViewUniforms'
export { pointAlong } from './scattering/tsl/ray'
export { scatteredRadiance, scattering } from './scattering/tsl/scattering'
export type { Air, Ray } from './scattering/tsl/ray'
export type { LightParts, Scattered } from './scattering/tsl/segment'
export { marchedAir, marchedSky } from './scattering/tsl/marchedAir'
export { rayLimits } from './skyVolume/tsl/rayLimits'
export type { MediumSegment } from './skyVolume/tsl/skyVolume'
export type { RayLimits } from './skyVolume/tsl/rayLimits'
export { aerialPerspectiveTo } from './sky/tsl/aerialPerspective'
export type { AerialPerspective } from './sky/tsl/aerialPerspective'
export { linearSRGB, transmittanceRGB } from './air/tsl/color'
export { horizontalIrradiance } from './diffuseLight/tsl/skyIrradiance'
export { lightTransmittance as transmittanceToLight } from './transmittance/tsl/transmittance'
export { octahedralDirection, octahedralPoint } from './math/tsl/octahedron'
export type { Viewpoint, ViewpointScalars } from './view/tsl/viewpoint'

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
export { opticalDepth, lightTransmittance, visibleDisc } from './transmittance/cpu/transmittance'
export { NIGHT_ILLUMINANCE } from './night/cpu/twilight'
export { scaleToLuminance } from './parameters/photometry'

// Preconditions and uniforms that Welkin's packages share; not for use elsewhere.
export { checkRange, checkSpectrum, withDefaults } from './check'
export { checkSource } from './view/LightSource'
export { checkAtmosphere } from './view/ViewNodes'
export { checkOwner, checkRenderer } from './view/renderers'
export { unjitteredProjection } from './view/cpu/unjittered'
export { nameTexture } from './tables/AtlasTexture'
export {
  matrix3 as matrix3Uniform,
  matrix4 as matrix4Uniform,
  number as numberUniform,
  vector2 as vector2Uniform,
  vector3 as vector3Uniform,
  vector4 as vector4Uniform
} from './uniforms'
