export { CloudLayer, type CloudLayerParameters, type CloudWind } from './layers/CloudLayer'
export type { CloudPrecipitation } from './layers/precipitation'
export { CloudLayers } from './layers/CloudLayers'
export { cloudLayersFromMETAR, visibilityFromMETAR, type METAROptions } from './layers/metar'
export { CloudField, type CloudFieldOptions } from './density/CloudField'
export { CloudWorldMap, cloudWorldMap } from './density/CloudWorldMap'
export type { CloudWorldMapOptions, MapBounds } from './density/CloudWorldMap'
export type { CloudSample } from './density/CloudSample'
export { CloudNoise } from './noise/CloudNoise'
export type { CloudNoiseOptions, NoiseFunction } from './noise/CloudNoise'
export { noiseVolume } from './noise/noiseVolume'
export { cloudPreset, cloudPresetNames, type CloudPresetName } from './layers/presets'
export { CloudLightTable } from './light/CloudLightTable'
export type { CloudLight, FineSampleNodes } from './light/CloudLightTable'
export { DropletLightTable, type DropletLightOptions } from './light/DropletLightTable'
export type { CloudPhaseParameters } from './light/cpu/cloudPhase'
export { CloudsNode, clouds, type CloudsOptions } from './march/CloudsNode'
export {
  PrecipitationShafts,
  precipitationShafts,
  type PrecipitationShaftsOptions
} from './precipitation/PrecipitationShafts'
export { PrecipitationGauge } from './precipitation/PrecipitationGauge'
export { Lightning, lightning } from './lightning/Lightning'
export type {
  LightningEvent,
  LightningEventMap,
  LightningOptions,
  StrikeOptions
} from './lightning/LightningOptions'
export { CloudVelocityNode, cloudVelocity } from './temporal/CloudVelocityNode'
export { CloudsDebugNode, cloudsDebug, type CloudsDebug } from './march/CloudsDebugNode'
export { cloudQualities, type CloudQuality, type CloudQualityName } from './march/quality'
export { CloudAirShadow, cloudAirShadow } from './shadow/CloudAirShadow'
export { CloudShadowNode, cloudShadow } from './shadow/CloudShadowNode'
export {
  CloudEnvironment,
  cloudEnvironment,
  type CloudEnvironmentOptions
} from './environment/CloudEnvironment'
export { CloudSkyLight, cloudSkyLight } from './environment/CloudSkyLight'
export { CloudFogLight, cloudFogLight } from './environment/CloudFogLight'
export { CloudCover, type CloudCoverOptions } from './environment/CloudCover'
