// CommonJS, as older tools and servers have it. Prints what the packages answer.
const { Atmosphere } = require('@welkin/atmosphere')
const { cloudPreset } = require('@welkin/clouds')
const { sunDirectionECEF } = require('@welkin/geo')
const { MountainHeights, Terrain } = require('@welkin/terrain')

const date = new Date('2026-06-21T12:00:00Z')
const atmosphere = new Atmosphere().place({ longitude: 0, latitude: 23.4 })
atmosphere.date = date
const answers = {
  sunHeight: atmosphere.sunDirection.y,
  sunDeclination: Math.asin(sunDirectionECEF(date).z),
  layers: cloudPreset('mixed').length,
  ground: new Terrain(atmosphere, new MountainHeights({ seed: 513 })).heightAt(1, 47)
}
console.log(JSON.stringify(answers))
