declare global {
  /** Set by the page's build, once clouds are loaded. */
  var setCascadeSize: ((size: number) => void) | undefined
}

/**
 * Texels along an edge of a cascade: as users have it, in pictures of stories and where shadows so coarse pass for those, where
 * shadows are not measured, and where it is enough that there are some: materials' light shafts have as little room then.
 */
const sizes = { fine: 256, half: 128, coarse: 64, least: 32 }

export type ShadowSize = keyof typeof sizes

/** Makes shadow maps of clouds, from now on, with fewer texels than users', or with as many. */
export function setShadowSize(size: ShadowSize): void {
  globalThis.setCascadeSize?.(sizes[size])
}
