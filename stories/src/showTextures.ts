import { Data3DTexture, Mesh, OrthographicCamera, PlaneGeometry, Scene, Vector4 } from 'three'
import type { Texture } from 'three'
import { texture, texture3D, uniform, uv, vec3 } from 'three/tsl'
import { MeshBasicNodeMaterial } from 'three/webgpu'
import type { Node } from 'three/webgpu'

/** A part of a texture: x, y, width, height in [0, 1]. */
export type Region = readonly [number, number, number, number]

/** A texture to show as a picture. */
export interface Picture {
  label: string
  texture: Texture
  /** Sides of the picture in texels: they set its proportions. */
  width: number
  height: number
  /** Slice of a 3D texture, in [0, 1]. */
  slice?: number
  /** Part of a 2D texture to show: x, y, width, height in [0, 1]; default all of it. */
  region?: Region
  /** Factor before display; what is above 1 after it is white. Default 1. */
  scale?: number
  /** Conversion of a texel to linear RGB; default its first three channels. */
  color?: (texel: Node<'vec4'>) => Node<'vec3'>
}

interface Shown {
  picture: Picture
  mesh: Mesh<PlaneGeometry, MeshBasicNodeMaterial>
  slice: { value: number }
  region: { value: Vector4 }
  scale: { value: number }
  label: HTMLElement
}

const GAP = 16
const LABEL_HEIGHT = 22

/**
 * Lays textures out as labelled pictures, as large as the page allows.
 *
 * Row 0 of a texture (v = 0) is at the bottom. Labels are page elements beside the canvas, so that a frame's pixels
 * do not depend on fonts.
 *
 * ```ts
 * const pictures = new TexturePictures(canvas, [{ label: 'Transmittance', texture, width: 256, height: 64 }])
 * pictures.resize(width, height)
 * renderer.render(pictures.scene, pictures.camera)
 * ```
 */
export class TexturePictures {
  readonly scene = new Scene()
  readonly camera = new OrthographicCamera(0, 1, 0, 1, -1, 1)
  private readonly shown: Shown[]

  constructor(canvas: HTMLCanvasElement, pictures: Picture[]) {
    this.shown = pictures.map(picture => {
      const slice = uniform(picture.slice ?? 0)
      const scale = uniform(picture.scale ?? 1)
      const region = uniform(new Vector4(...(picture.region ?? [0, 0, 1, 1])))
      const material = new MeshBasicNodeMaterial({
        depthTest: false,
        depthWrite: false,
        toneMapped: false
      })
      const texel =
        picture.texture instanceof Data3DTexture
          ? texture3D(picture.texture, vec3(uv(), slice))
          : texture(picture.texture, uv().mul(region.zw).add(region.xy))
      const node = texel as unknown as Node<'vec4'>
      material.colorNode = (picture.color?.(node) ?? node.rgb).mul(scale)
      const mesh = new Mesh(new PlaneGeometry(1, 1), material)
      mesh.frustumCulled = false
      this.scene.add(mesh)
      const label = document.createElement('div')
      label.textContent = picture.label
      label.style.cssText = 'position:absolute;white-space:nowrap;pointer-events:none'
      canvas.parentElement?.append(label)
      return { picture, mesh, slice, region, scale, label }
    })
  }

  /** Changes the pictures whose labels begin with some words. */
  set(
    label: string,
    { slice, region, scale }: { slice?: number; region?: Region; scale?: number }
  ): void {
    for (const shown of this.shown.filter(({ picture }) => picture.label.startsWith(label))) {
      shown.slice.value = slice ?? shown.slice.value
      shown.scale.value = scale ?? shown.scale.value
      if (region !== undefined) {
        shown.region.value.set(...region)
      }
    }
  }

  /** Fits the pictures into a page, in rows of equal height [CSS pixels]. */
  resize(width: number, height: number): void {
    this.camera.right = width
    this.camera.top = height
    this.camera.updateProjectionMatrix()

    const rowHeight = this.largestRowHeight(width, height)
    let x = GAP
    let y = GAP
    for (const { picture, mesh, label } of this.shown) {
      const shownWidth = Math.min((rowHeight * picture.width) / picture.height, width - 2 * GAP)
      const shownHeight = (shownWidth * picture.height) / picture.width
      if (x > GAP && x + shownWidth > width - GAP) {
        x = GAP
        y += rowHeight + LABEL_HEIGHT + GAP
      }
      label.style.left = `${x}px`
      label.style.top = `${y}px`
      mesh.scale.set(shownWidth, shownHeight, 1)
      mesh.position.set(x + shownWidth / 2, height - (y + LABEL_HEIGHT + shownHeight / 2), 0)
      x += shownWidth + GAP
    }
  }

  dispose(): void {
    for (const { mesh, label } of this.shown) {
      mesh.geometry.dispose()
      mesh.material.dispose()
      label.remove()
    }
  }

  private largestRowHeight(width: number, height: number): number {
    for (let rowHeight = height; rowHeight > 24; rowHeight *= 0.95) {
      if (this.heightOfRows(width, rowHeight) <= height) {
        return rowHeight
      }
    }
    return 24
  }

  private heightOfRows(width: number, rowHeight: number): number {
    let rows = 1
    let x = GAP
    for (const { picture } of this.shown) {
      const shownWidth = Math.min((rowHeight * picture.width) / picture.height, width - 2 * GAP)
      if (x > GAP && x + shownWidth > width - GAP) {
        rows++
        x = GAP
      }
      x += shownWidth + GAP
    }
    return GAP + rows * (rowHeight + LABEL_HEIGHT + GAP)
  }
}
