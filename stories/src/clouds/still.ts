import { cloudQualities } from '@welkin/clouds'
import type { CloudQuality } from '@welkin/clouds'

/** Quality of a still, which marches every pixel in every frame, coarsely: a few frames converge. */
export const STILL_QUALITY: CloudQuality = { ...cloudQualities.low, block: 1 }
