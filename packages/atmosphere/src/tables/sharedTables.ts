import type { Renderer } from 'three/webgpu'
import type { AtmosphereParameters } from '../parameters/AtmosphereParameters'
import { AtmosphereTables } from './AtmosphereTables'

/** Renderers share no textures, and take from one another render targets that both draw into. */
const _shared = new WeakMap<AtmosphereParameters, WeakMap<Renderer, AtmosphereTables>>()

/** The tables of all who ask for those of the same parameters on the same renderer. */
export function sharedTables(
  parameters: AtmosphereParameters,
  renderer: Renderer
): AtmosphereTables {
  const byRenderer = _shared.get(parameters) ?? new WeakMap<Renderer, AtmosphereTables>()
  _shared.set(parameters, byRenderer)
  const tables = byRenderer.get(renderer) ?? new AtmosphereTables(parameters)
  byRenderer.set(renderer, tables)
  return tables
}
