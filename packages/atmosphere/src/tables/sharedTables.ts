import type { Renderer } from 'three/webgpu'
import type { AtmosphereParameters } from '../parameters/AtmosphereParameters'
import { AtmosphereTables } from './AtmosphereTables'

interface Shared {
  readonly tables: AtmosphereTables
  readonly users: Set<object>
}

/** Renderers share no textures, and take from one another render targets that both draw into. */
const _shared = new WeakMap<AtmosphereParameters, WeakMap<Renderer, Shared>>()

/** The tables of all who take those of the same parameters on the same renderer. */
export function takeTables(
  parameters: AtmosphereParameters,
  renderer: Renderer,
  user: object
): AtmosphereTables {
  const byRenderer = _shared.get(parameters) ?? new WeakMap<Renderer, Shared>()
  _shared.set(parameters, byRenderer)
  const shared = byRenderer.get(renderer) ?? { tables: new AtmosphereTables(), users: new Set() }
  byRenderer.set(renderer, shared)
  shared.users.add(user)
  return shared.tables
}

/** Frees the tables if nobody else has taken them. */
export function giveTablesBack(
  parameters: AtmosphereParameters,
  renderer: Renderer,
  user: object
): void {
  const shared = _shared.get(parameters)?.get(renderer)
  if (shared?.users.delete(user) === true && shared.users.size === 0) shared.tables.dispose()
}
