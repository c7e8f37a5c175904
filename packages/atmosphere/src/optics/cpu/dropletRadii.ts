/** Effective radii of the stored phase functions of droplets [µm]. */
export const DROPLET_RADII: readonly number[] = /*#__PURE__*/ Array.from(
  { length: 11 },
  (_, i) => 3 * 10 ** (i / 10)
)
