/** Power at each pair of frequencies of a square picture, seen through a Hann window: a direct transform. */
export function powerSpectrum(picture: readonly number[], size: number): number[] {
  const mean = picture.reduce((a, b) => a + b) / picture.length
  const window = (i: number): number => Math.sin((Math.PI * (i + 0.5)) / size) ** 2
  const real = picture.map((v, i) => (v - mean) * window(i % size) * window(Math.floor(i / size)))
  const imaginary = real.map(() => 0)
  const line = (start: number, stride: number): void => {
    const re: number[] = []
    const im: number[] = []
    for (let k = 0; k < size; k++) {
      let [a, b] = [0, 0]
      for (let n = 0; n < size; n++) {
        const angle = (-2 * Math.PI * ((k * n) % size)) / size
        const [c, s] = [Math.cos(angle), Math.sin(angle)]
        const [x, y] = [real[start + n * stride], imaginary[start + n * stride]]
        a += x * c - y * s
        b += x * s + y * c
      }
      re.push(a)
      im.push(b)
    }
    for (let k = 0; k < size; k++) {
      real[start + k * stride] = re[k]
      imaginary[start + k * stride] = im[k]
    }
  }
  for (let row = 0; row < size; row++) line(row * size, 1)
  for (let column = 0; column < size; column++) line(column, size)
  return real.map((x, i) => x * x + imaginary[i] ** 2)
}
