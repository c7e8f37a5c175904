/** A view of the valley: position and target of the camera [m]. */
interface ValleyView {
  readonly label: string
  readonly position: readonly [number, number, number]
  readonly target: readonly [number, number, number]
}

export const VIEWS = {
  village: { label: 'Village', position: [300, 34, 520], target: [330, 80, -1500] },
  shore: { label: 'Shore', position: [120, 2.5, -330], target: [60, 150, -3000] },
  west: { label: 'Over the lake', position: [1500, 420, -300], target: [-2000, 250, -1900] },
  slope: { label: 'From a slope', position: [1150, 330, 900], target: [-300, 60, -2200] },
  above: { label: 'Above the clouds', position: [-900, 3900, 5200], target: [0, 1500, -4000] }
} satisfies Record<string, ValleyView>

export type ValleyName = keyof typeof VIEWS
