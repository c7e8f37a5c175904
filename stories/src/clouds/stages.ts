import type { CloudLayerParameters } from '@welkin/clouds'

type Form = Partial<CloudLayerParameters>

const even: Form = { shear: 0, densityGrowth: 0, edgeSoftness: 0 }

const smooth: Form = { ...even, shapeAmount: 0, detailAmount: 0, turbulence: 0 }

/** Stages of a cloud's form, each with what it leaves out of the finished layer. */
export const stages = {
  // All columns reach nearly the same height.
  columns: { ...smooth, profileExponent: 8 },
  profile: smooth,
  billows: { ...even, detailAmount: 0 },
  detail: even,
  density: {},
  cloud: {}
} as const satisfies Record<string, Form>

export type Stage = keyof typeof stages

/** Factor on the light of sky and ground at a stage: the last one adds it to the sun's. */
export const ambientAt = (stage: Stage): number => (stage === 'cloud' ? 1 : 0)

/** Names of the stages, for controls. */
export const stageNames: Readonly<Record<Stage, string>> = {
  columns: 'Columns of cloud, by the weather’s noise',
  profile: 'with a profile: the stronger, the taller',
  billows: 'with stirred billows',
  detail: 'with detail',
  density: 'with density',
  cloud: 'with the light of sky and ground: the finished cloud'
}
