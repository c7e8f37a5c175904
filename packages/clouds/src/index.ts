export { CloudLayer, type CloudLayerParameters, type CloudWind } from './CloudLayer'
export { CloudLayers } from './CloudLayers'
export { CloudField, type CloudFieldOptions } from './CloudField'
export { CloudNoise } from './CloudNoise'
