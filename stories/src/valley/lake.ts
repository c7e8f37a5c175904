import {
  DataTexture,
  DataUtils,
  HalfFloatType,
  LinearFilter,
  RedFormat,
  RepeatWrapping
} from 'three'
import type { Light } from 'three'
import {
  atan,
  float,
  lights,
  mix,
  normalView,
  positionViewDirection,
  positionWorld,
  reflectVector,
  smoothstep,
  texture,
  vec2
} from 'three/tsl'
import type { MeshPhysicalNodeMaterial, Node } from 'three/webgpu'
import { createWater, type Water } from '../environment/water'
import { groundHeight } from './ground'
import { LAKE } from './places'
import { waterReflectance, type LakeMirror } from './LakeMirror'

/** Directions and distances in which the skyline is looked for, and the nearest and farthest of these [m]. */
const AZIMUTHS = 128
const STEPS = 40
const REACH = [250, 20_000] as const

/** Places along the lake from which it is looked for: from its shores mountains are higher than from its middle. */
const PLACES = 5

/** Brightness of land that the lake mirrors over that of the sky before it. */
const MIRRORED_LAND = 0.22
/** Height over which the skyline in the lake is blurred, as a tangent. */
const BLUR = 0.03

/** Mean square slope of the ripples. */
const SLOPE = 0.0002

/**
 * Tangent of the skyline's elevation as seen from the lake.
 *
 * @param azimuth - Direction, from x towards z [rad].
 * @param from - Place along the lake [m].
 */
export function skylineHeight(azimuth: number, from: number): number {
  let highest = 0
  for (let step = 0; step < STEPS; step++) {
    const distance = REACH[0] * (REACH[1] / REACH[0]) ** (step / (STEPS - 1))
    const x = LAKE.x + distance * Math.cos(azimuth)
    const z = from + distance * Math.sin(azimuth)
    highest = Math.max(highest, (groundHeight(x, z) - LAKE.height) / distance)
  }
  return highest
}

/** Skyline's heights by azimuth and place along the lake. */
function skyline(): DataTexture {
  const heights = Uint16Array.from({ length: AZIMUTHS * PLACES }, (_, i) => {
    const azimuth = (2 * Math.PI * ((i % AZIMUTHS) + 0.5)) / AZIMUTHS - Math.PI
    const place = (Math.floor(i / AZIMUTHS) + 0.5) / PLACES
    const from = LAKE.z + LAKE.halfLength * (2 * place - 1)
    return DataUtils.toHalfFloat(skylineHeight(azimuth, from))
  })
  const result = new DataTexture(heights, AZIMUTHS, PLACES, RedFormat, HalfFloatType)
  result.wrapS = RepeatWrapping
  result.magFilter = result.minFilter = LinearFilter
  result.needsUpdate = true
  return result
}

/**
 * The lake: it mirrors what is in the picture, and beside it sky and clouds, and mountains as dark as they are before them.
 *
 * @param environment - Sky and clouds.
 * @param mirror - Image of the picture in the lake.
 * @param directLights - Lights that glitter on it. Others light what is matte, which water is not.
 */
export function createLake(
  environment: Node,
  mirror: LakeMirror,
  directLights: readonly Light[]
): Water {
  const water = createWater(2400)
  water.mesh.position.set(LAKE.x, LAKE.height, LAKE.z)
  water.setSlope(SLOPE)
  const material = water.mesh.material as unknown as MeshPhysicalNodeMaterial
  material.envNode = environment as never
  material.lightsNode = lights([...directLights]) as never
  const heights = skyline()
  const { x, y, z } = reflectVector
  const azimuth = atan(z, x).div(2 * Math.PI)
  const elevation = y.div(vec2(x, z).length().max(1e-4))
  const along = positionWorld.z.sub(LAKE.z).div(2 * LAKE.halfLength)
  const height = texture(heights, vec2(azimuth, along).add(0.5)).level(float(0)).r
  const isSky = smoothstep(height.sub(BLUR), height.add(BLUR), elevation)
  const image = mirror.sample()
  const beside = mix(float(MIRRORED_LAND), float(1), isSky)
  material.specularIntensityNode = beside.mul(image.a.oneMinus())
  const cosView = normalView.dot(positionViewDirection)
  material.emissiveNode = image.rgb.mul(image.a.mul(waterReflectance(cosView)))
  return {
    ...water,
    dispose() {
      water.dispose()
      heights.dispose()
    }
  }
}
