export { CloudLayer, type CloudLayerParameters, type CloudWind } from './CloudLayer'
export { CloudLayers } from './CloudLayers'
