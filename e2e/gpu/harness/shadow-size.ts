declare global {
  /** Set by the page's build, once clouds are loaded. */
  var setCascadeSize: ((size: number) => void) | undefined
  var setWeatherSize: ((size: number) => void) | undefined
}

/**
 * Texels along an edge of a cascade, and of a layer's map of the weather: as users have them, in pictures of stories and where shadows so
 * coarse pass for those, where shadows are not measured, and where it is enough that there are some: materials' light shafts have as
 * little room then.
 */
const sizes = {
  fine: [256, 384],
  half: [128, 384],
  coarse: [64, 192],
  least: [32, 192]
} as const

export type ShadowSize = keyof typeof sizes

/** Makes shadow maps and maps of the weather of clouds, from now on, with fewer texels than users', or with as many. */
export function setShadowSize(size: ShadowSize): void {
  const [cascade, weather] = sizes[size]
  globalThis.setCascadeSize?.(cascade)
  globalThis.setWeatherSize?.(weather)
}
