import { FloatType, RenderTarget } from 'three'
import { exp, float, Fn, Loop, screenCoordinate, uniform, vec3 } from 'three/tsl'
import { NodeMaterial, QuadMesh, type Node, type WebGPURenderer } from 'three/webgpu'
import type { CloudField, CloudLayerParameters } from '@welkin/clouds'
import { powerSpectrum } from '../../validate/power-spectrum'
import { cloudExtinction } from './cloud-extinction'
import { readPicture } from './picture'

/** Draws a square picture of floats; pixels, channel by channel. */
async function drawChannels(
  renderer: WebGPURenderer,
  quad: QuadMesh,
  size: number
): Promise<number[][]> {
  const target = new RenderTarget(size, size, { type: FloatType, depthBuffer: false })
  renderer.setRenderTarget(target)
  quad.render(renderer)
  renderer.setRenderTarget(null)
  const { data } = await readPicture(renderer, target)
  target.dispose()
  return [0, 1, 2, 3].map(c => Array.from({ length: size ** 2 }, (_, i) => data[4 * i + c]))
}

/** A square picture of the sky straight up, as light that comes through: no perspective. */
export class CloudColumns {
  readonly #material = new NodeMaterial()
  readonly #quad: QuadMesh
  /** Number of times that the shader was built. */
  builds = 0
  readonly #distance = uniform(2000)

  /**
   * @param size - Pixels along an edge.
   * @param width - Width of the square that is seen [m].
   * @param steps - Samples in a column.
   */
  constructor(
    readonly field: CloudField,
    readonly size: number,
    width: number,
    steps: number
  ) {
    const layers = [...field.layers].map(layer => layer.parameters)
    const base = Math.min(...layers.map(layer => layer.baseAltitude))
    const top = Math.max(...layers.map(layer => layer.topAltitude))
    const setup = this.#material.setup.bind(this.#material)
    this.#material.setup = builder => {
      this.builds++
      setup(builder)
    }
    const distance = this.#distance as unknown as Node<'float'>
    this.#material.fragmentNode = Fn(() => {
      const { up } = field.view
      const side = up.yzx.cross(up).normalize().toConst()
      const place = screenCoordinate.xy.div(size).sub(0.5).mul(width).toConst()
      const level = side.mul(place.x).add(side.cross(up).mul(place.y)).toConst()
      const depth = float(0).toVar()
      Loop(steps, ({ i }) => {
        const height = float(i as never)
          .add(0.5)
          .div(steps)
          .mul(top - base)
          .add(base)
          .toConst()
        // Down to the sphere, without cancellation.
        const radius = field.radius.add(height).toConst()
        const square = level.dot(level).toConst()
        const drop = square.div(radius.mul(radius).sub(square).sqrt().add(radius))
        const offset = level.add(up.mul(height.sub(drop))).toConst() as unknown as Node<'vec3'>
        const { altitude, up: zenith } = field.view.localCoordinates(offset)
        const sample = { offset, altitude, up: zenith, distance }
        depth.addAssign(cloudExtinction(field, sample, false).mul((top - base) / steps))
      })
      return vec3(exp(depth.negate()), depth, 0)
    })() as never
    this.#quad = new QuadMesh(this.#material)
  }

  /** Distance that all clouds are seen from: sets the level of detail [m]. */
  set distance(metres: number) {
    this.#distance.value = metres
  }

  /** Pixels of `[transmittance, optical depth]`, channel by channel. */
  async draw(renderer: WebGPURenderer): Promise<{ light: number[]; depth: number[] }> {
    const [light, depth] = await drawChannels(renderer, this.#quad, this.size)
    return { light, depth }
  }

  dispose(): void {
    this.#material.dispose()
  }
}

/** Columns of a layer, spread evenly over the whole planet. */
export class PlanetColumns {
  readonly #material = new NodeMaterial()
  readonly #quad = new QuadMesh(this.#material)
  readonly #distance = uniform(0)
  readonly #base = uniform(0)
  readonly #thickness = uniform(1)

  /**
   * @param size - There are as many columns as pixels in a square of this edge.
   * @param steps - Samples in a column.
   */
  constructor(
    field: CloudField,
    readonly size: number,
    steps: number
  ) {
    this.#material.fragmentNode = Fn(() => {
      const pixel = screenCoordinate.xy.floor()
      const index = pixel.y.mul(size).add(pixel.x).toConst()
      // A spiral of even density.
      const z = index
        .mul(2)
        .add(1)
        .div(size ** 2)
        .sub(1)
        .toConst()
      const across = z.mul(z).oneMinus().sqrt()
      const angle = index
        .mul(0.618033988)
        .fract()
        .mul(2 * Math.PI)
      const up = vec3(across.mul(angle.cos()), across.mul(angle.sin()), z).toConst()
      const viewpoint = field.view.up.mul(field.radius.add(field.view.height)).toConst()
      const thickness = this.#thickness as unknown as Node<'float'>
      const distance = this.#distance as unknown as Node<'float'>
      const depth = float(0).toVar()
      Loop(steps, ({ i }) => {
        const altitude = float(i as never)
          .add(0.5)
          .div(steps)
          .mul(thickness)
          .add(this.#base)
          .toConst()
        const offset = up.mul(field.radius.add(altitude)).sub(viewpoint).toConst()
        const sample = { offset, altitude, up, distance }
        depth.addAssign(cloudExtinction(field, sample, false).mul(thickness.div(steps)))
      })
      return vec3(depth)
    })() as never
  }

  /**
   * @param layer - The field's only one.
   * @param distance - Distance that the clouds are seen from [m].
   * @returns Optical depths.
   */
  async draw(
    renderer: WebGPURenderer,
    { baseAltitude, topAltitude }: CloudLayerParameters,
    distance: number
  ): Promise<number[]> {
    this.#distance.value = distance
    this.#base.value = baseAltitude
    this.#thickness.value = topAltitude - baseAltitude
    const [depth] = await drawChannels(renderer, this.#quad, this.size)
    return depth
  }

  dispose(): void {
    this.#material.dispose()
  }
}

/** The wave of a square picture whose power stands out the most from those that are as long. */
export function highestPeak(
  picture: readonly number[],
  size: number,
  shortest = 4
): { ratio: number; wave: [number, number] } {
  const power = powerSpectrum(picture, size)
  const signed = (i: number): number => (i > size / 2 ? i - size : i)
  const waveOf = (i: number): [number, number] => [signed(i % size), signed(Math.floor(i / size))]
  const rings: number[][] = Array.from({ length: size }, () => [])
  power.forEach((p, i) => rings[Math.round(Math.hypot(...waveOf(i)))].push(p))
  const means = rings.map(ring => ring.reduce((a, b) => a + b, 0) / ring.length)
  let highest: { ratio: number; wave: [number, number] } = { ratio: 0, wave: [0, 0] }
  power.forEach((p, i) => {
    const wave = waveOf(i)
    const ring = Math.round(Math.hypot(...wave))
    if (ring < shortest || ring > size / 2) return
    if (p / means[ring] > highest.ratio) highest = { ratio: p / means[ring], wave }
  })
  return highest
}
