import type { Backend } from '../harness/backend'

/** Pictures that their stories' tag `screenshot` asks for, and where else their proof is: they are in the gallery alone. */
const leftOut: ReadonlySet<string> = new Set([
  // The bow of a fog's droplets is measured in `gpu/atmosphere/fog`, and the glory of a cloud's in `gpu/clouds/light`.
  'halos-fogbow',
  'halos-glory',
  // GPU tests descend to the clouds of a map of the world, and look for seams.
  'clouds-worldclouds',
  // The globe is in the pictures of its imagery, of its orbit, and of the terrain's.
  'globe-wholeglobe',
  // The same tiles as by day; night's light on surfaces is in `gpu/everything`.
  'photogrammetry-night',
  // Unit tests have Titan's colours, and a picture those of Mars.
  'planets-titan'
])

/** Pictures that WebGPU alone takes, and where WebGL has their shaders. */
const webgpuAlone: ReadonlySet<string> = new Set([
  // Fogs and shafts: in `gpu/everything`.
  'fogvalley-sunrise',
  // The globe: in the picture of its imagery; land and clouds: in GPU tests.
  'globe-street',
  // Light of surfaces: in `gpu/atmosphere/surface-lighting`.
  'photogrammetry-local'
])

/** True for a picture that a backend takes, of those that stories' tags ask for. */
export const isTaken = (name: string, backend: Backend): boolean =>
  !leftOut.has(name) && (backend === 'webgpu' || !webgpuAlone.has(name))
