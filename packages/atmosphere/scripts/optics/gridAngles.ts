import { angleAt, type PhaseGrid } from '../../src/optics/cpu/phaseGrid'

/** Angles of a grid's samples from their ends, and if that is the point opposite the light [rad]. */
export function gridAngles({ forward, backward }: PhaseGrid): { angle: number; isBack: boolean }[] {
  return [forward, backward].flatMap((count, i) =>
    Array.from({ length: count }, (_, k) => ({ angle: angleAt(k / (count - 1)), isBack: i > 0 }))
  )
}
