/** Hour as a clock shows it, such as 9:05. */
export function clockOf(hour: number): string {
  const minutes = Math.floor((hour % 1) * 60)
  return `${Math.floor(hour)}:${String(minutes).padStart(2, '0')}`
}
