import type { CloudLayerParameters } from '@welkin/clouds'

type Form = Partial<CloudLayerParameters>

const even: Form = { shear: 0, densityGrowth: 0, edgeSoftness: 0 }

/** Stages of a cloud's form, each with what it leaves out of the finished layer. */
export const stages = {
  columns: { ...even, shapeAmount: 0, detailAmount: 0, turbulence: 0 },
  billows: { ...even, detailAmount: 0 },
  detail: even,
  cloud: {}
} as const satisfies Record<string, Form>

export type Stage = keyof typeof stages

/** Names of the stages, for controls. */
export const stageNames: Readonly<Record<Stage, string>> = {
  columns: 'Strength of columns by height',
  billows: 'with stirred billows',
  detail: 'with detail',
  cloud: 'with density: the finished cloud'
}
