/** Materials of the ground that may have maps, and that a mask may paint. */
export const GROUND_KINDS = ['rock', 'scree', 'grass', 'forest', 'sand', 'snow'] as const

/** A material of the ground. */
export type GroundKind = (typeof GROUND_KINDS)[number]

/** A value for each material. */
export type OfKinds<T> = Record<GroundKind, T>

/** Makes a value for each material. */
export const ofKinds = <T>(make: (kind: GroundKind) => T): OfKinds<T> =>
  Object.fromEntries(GROUND_KINDS.map(kind => [kind, make(kind)])) as OfKinds<T>
