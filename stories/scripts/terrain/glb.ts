export interface Primitive {
  /** Metres from the tile's centre, ECEF axes. */
  positions: Float32Array
  /** Unit vectors as signed 16-bit fractions, four per vertex: the fourth pads to a multiple of 4 bytes. */
  normals: Int16Array
  /** Texture coordinates in the tile's image. */
  uvs?: Float32Array
  /** Linear RGBA, 8 bits each; multiplies the image if there is one. */
  colors?: Uint8Array
  indices: Uint16Array | Uint32Array
}

export interface Tile {
  /** Centre of the tile in ECEF [m]. */
  centre: readonly [number, number, number]
  /** Textured where they have `uvs`. */
  primitives: Primitive[]
  image: Uint8Array
}

const FLOAT = 5126
const SHORT = 5122
const UNSIGNED_BYTE = 5121
const ARRAY_BUFFER = 34962
const ELEMENT_ARRAY_BUFFER = 34963

/** ECEF axes to the y-up axes of glTF; a 3D Tiles client turns them back. */
function toYUp<T extends Float32Array | Int16Array>(vectors: T, stride: number): T {
  const result = vectors.slice() as T
  for (let i = 0; i < vectors.length; i += stride) {
    result[i + 1] = vectors[i + 2]
    result[i + 2] = -vectors[i + 1]
  }
  return result
}

function bounds(positions: Float32Array): { min: number[]; max: number[] } {
  const min = [Infinity, Infinity, Infinity]
  const max = [-Infinity, -Infinity, -Infinity]
  for (let i = 0; i < positions.length; i++) {
    min[i % 3] = Math.min(min[i % 3], positions[i])
    max[i % 3] = Math.max(max[i % 3], positions[i])
  }
  return { min, max }
}

function padded(bytes: Uint8Array, filler: number): Uint8Array {
  const result = new Uint8Array(Math.ceil(bytes.length / 4) * 4).fill(filler)
  result.set(bytes)
  return result
}

/** The binary chunk, and what JSON says of its parts. */
class Binary {
  readonly bufferViews: object[] = []
  readonly accessors: object[] = []
  readonly parts: Uint8Array[] = []
  length = 0

  view(data: ArrayBufferView, target?: number, byteStride?: number): number {
    const part = padded(new Uint8Array(data.buffer, data.byteOffset, data.byteLength), 0)
    this.bufferViews.push({
      buffer: 0,
      byteOffset: this.length,
      byteLength: data.byteLength,
      byteStride,
      target
    })
    this.parts.push(part)
    this.length += part.length
    return this.bufferViews.length - 1
  }

  accessor(
    bufferView: number,
    componentType: number,
    type: string,
    count: number,
    more: object = {}
  ): number {
    this.accessors.push({ bufferView, componentType, type, count, ...more })
    return this.accessors.length - 1
  }

  primitive({ positions, normals, uvs, colors, indices }: Primitive): object {
    const count = positions.length / 3
    const turned = toYUp(positions, 3)
    const indexType = indices instanceof Uint16Array ? 5123 : 5125
    return {
      attributes: {
        POSITION: this.accessor(
          this.view(turned, ARRAY_BUFFER),
          FLOAT,
          'VEC3',
          count,
          bounds(turned)
        ),
        NORMAL: this.accessor(this.view(toYUp(normals, 4), ARRAY_BUFFER, 8), SHORT, 'VEC3', count, {
          normalized: true
        }),
        TEXCOORD_0: uvs && this.accessor(this.view(uvs, ARRAY_BUFFER), FLOAT, 'VEC2', count),
        COLOR_0:
          colors &&
          this.accessor(this.view(colors, ARRAY_BUFFER, 4), UNSIGNED_BYTE, 'VEC4', count, {
            normalized: true
          })
      },
      indices: this.accessor(
        this.view(indices, ELEMENT_ARRAY_BUFFER),
        indexType,
        'SCALAR',
        indices.length
      ),
      material: uvs ? 0 : 1
    }
  }
}

/**
 * A tile as binary glTF.
 *
 * Its centre is the translation of the node, which JSON holds in full precision; vertices are relative to it.
 */
export function encodeGLB({ centre: [x, y, z], primitives, image }: Tile): Uint8Array {
  const binary = new Binary()
  const encoded = primitives.map(primitive => binary.primitive(primitive))
  const json = {
    asset: { version: '2.0', generator: 'welkin make-terrain' },
    extensionsUsed: ['KHR_mesh_quantization'],
    extensionsRequired: ['KHR_mesh_quantization'],
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, translation: [x, z, -y] }],
    meshes: [{ primitives: encoded }],
    materials: [
      {
        pbrMetallicRoughness: {
          baseColorTexture: { index: 0 },
          metallicFactor: 0,
          roughnessFactor: 0.95
        }
      },
      { pbrMetallicRoughness: { metallicFactor: 0, roughnessFactor: 0.95 } }
    ],
    textures: [{ source: 0, sampler: 0 }],
    samplers: [{ magFilter: 9729, minFilter: 9987, wrapS: 33071, wrapT: 33071 }],
    images: [{ bufferView: binary.view(image), mimeType: 'image/png' }],
    accessors: binary.accessors,
    bufferViews: binary.bufferViews,
    buffers: [{ byteLength: binary.length }]
  }

  const text = padded(new TextEncoder().encode(JSON.stringify(json)), 0x20)
  const total = 28 + text.length + binary.length
  const glb = new Uint8Array(total)
  const view = new DataView(glb.buffer)
  view.setUint32(0, 0x46546c67, true)
  view.setUint32(4, 2, true)
  view.setUint32(8, total, true)
  view.setUint32(12, text.length, true)
  view.setUint32(16, 0x4e4f534a, true)
  glb.set(text, 20)
  view.setUint32(20 + text.length, binary.length, true)
  view.setUint32(24 + text.length, 0x004e4942, true)
  let offset = 28 + text.length
  for (const part of binary.parts) {
    glb.set(part, offset)
    offset += part.length
  }
  return glb
}
