// Scattering by the dust of Mars and the droplets of Venus's haze: Mie theory for spheres of a gamma
// distribution of sizes, Bohren & Huffman 1983, "Absorption and scattering of light by small particles".
// Run it with: npx tsx packages/atmosphere/scripts/mie.ts

type Complex = readonly [number, number]
const add = (a: Complex, b: Complex): Complex => [a[0] + b[0], a[1] + b[1]]
const sub = (a: Complex, b: Complex): Complex => [a[0] - b[0], a[1] - b[1]]
const mul = (a: Complex, b: Complex): Complex => [
  a[0] * b[0] - a[1] * b[1],
  a[0] * b[1] + a[1] * b[0]
]
const scale = (a: Complex, s: number): Complex => [a[0] * s, a[1] * s]
const conjugate = (a: Complex): Complex => [a[0], -a[1]]
const divide = (a: Complex, b: Complex): Complex =>
  scale(mul(a, conjugate(b)), 1 / (b[0] ** 2 + b[1] ** 2))
const real = (n: number): Complex => [n, 0]

/**
 * Efficiencies of extinction and scattering of a sphere, and its asymmetry.
 *
 * @param x - Size parameter, 2πr/λ.
 * @param m - Refractive index n + ik.
 */
function sphere(
  x: number,
  m: Complex
): { extinction: number; scattering: number; asymmetry: number } {
  const terms = Math.floor(x + 4 * Math.cbrt(x) + 2)
  const mx = scale(m, x)
  const start = Math.floor(Math.max(terms, Math.hypot(...mx)) + 16)
  // Logarithmic derivative, downwards.
  const D: Complex[] = Array.from({ length: start + 1 }, () => real(0))
  for (let n = start; n > 0; n--) {
    const ratio = divide(real(n), mx)
    D[n - 1] = sub(ratio, divide(real(1), add(D[n], ratio)))
  }
  let [psi0, psi1, chi0, chi1] = [Math.cos(x), Math.sin(x), -Math.sin(x), Math.cos(x)]
  let [extinction, scattering, asymmetry] = [0, 0, 0]
  let [aBefore, bBefore] = [real(0), real(0)]
  for (let n = 1; n <= terms; n++) {
    const psi = ((2 * n - 1) * psi1) / x - psi0
    const chi = ((2 * n - 1) * chi1) / x - chi0
    const [xi, xi1]: Complex[] = [
      [psi, -chi],
      [psi1, -chi1]
    ]
    const coefficient = (factor: Complex): Complex => {
      const sum = add(factor, real(n / x))
      return divide(sub(scale(sum, psi), real(psi1)), sub(mul(sum, xi), xi1))
    }
    const a = coefficient(divide(D[n], m))
    const b = coefficient(mul(D[n], m))
    extinction += (2 * n + 1) * (a[0] + b[0])
    scattering += (2 * n + 1) * (a[0] ** 2 + a[1] ** 2 + b[0] ** 2 + b[1] ** 2)
    asymmetry += ((2 * n + 1) / (n * (n + 1))) * mul(a, conjugate(b))[0]
    const neighbours = add(mul(aBefore, conjugate(a)), mul(bBefore, conjugate(b)))
    asymmetry += (((n - 1) * (n + 1)) / n) * neighbours[0]
    ;[aBefore, bBefore, psi0, psi1, chi0, chi1] = [a, b, psi1, psi, chi1, chi]
  }
  return {
    extinction: (2 / x ** 2) * extinction,
    scattering: (2 / x ** 2) * scattering,
    asymmetry: (2 * asymmetry) / scattering
  }
}

/**
 * Efficiencies of a gamma distribution of spheres: number of radius r ∝ r^((1 − 3v)/v) e^{−r/(av)}.
 *
 * @param wavelength - [µm].
 * @param radius - a, the effective radius [µm].
 * @param variance - v, the effective variance.
 * @see Hansen & Travis 1974, "Light scattering in planetary atmospheres"
 */
function cloud(wavelength: number, m: Complex, radius: number, variance: number) {
  let [area, extinction, scattering, asymmetry] = [0, 0, 0, 0]
  const steps = 160
  for (let i = 0; i < steps; i++) {
    const r = radius * 0.05 * 80 ** (i / (steps - 1))
    const number = r ** ((1 - 3 * variance) / variance) * Math.exp(-r / (radius * variance))
    // Steps are even in ln r.
    const weight = number * r * r ** 2
    const one = sphere((2 * Math.PI * r) / wavelength, m)
    area += weight
    extinction += weight * one.extinction
    scattering += weight * one.scattering
    asymmetry += weight * one.scattering * one.asymmetry
  }
  return {
    extinction: extinction / area,
    albedo: scattering / extinction,
    asymmetry: asymmetry / scattering
  }
}

const report = (name: string, values: ReturnType<typeof cloud>): void => {
  const { extinction, albedo, asymmetry } = values
  console.log(
    `${name}: extinction efficiency ${extinction.toFixed(3)}, ` +
      `single-scattering albedo ${albedo.toFixed(3)}, asymmetry ${asymmetry.toFixed(3)}`
  )
}

for (const [nm, k] of [
  [440, 0.011],
  [520, 0.0067],
  [560, 0.0051],
  [630, 0.0035]
]) {
  report(`Mars, ${nm} nm`, cloud(nm / 1000, [1.5, k], 1.6, 0.2))
}
for (const nm of [440, 520, 560, 630]) {
  report(`Venus, ${nm} nm`, cloud(nm / 1000, [1.44, 0], 1.05, 0.07))
}
