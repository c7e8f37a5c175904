import type { Camera } from 'three'
import type { Node, NodeFrame, NodeMaterial, Renderer } from 'three/webgpu'
import { checkBoolean, checkOptions, fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { scatterSegment } from '../scattering/tsl/segment'
import type { Bool, Float, Vec2, Vec3 } from '../tsl-types'
import type { AtmosphereView } from './AtmosphereView'
import type { LightSource } from './LightSource'
import type { SkyLayer } from './SkyLayer'

/** Something in front of what the depth of a picture has, such as clouds, that is drawn over the air. */
export interface ForegroundLayer {
  /** False while it is not drawn. */
  readonly isDrawn: boolean
  /**
   * log₂ of its distance [m]: of that up to which air is in its light.
   *
   * @param at - Place in the picture, as texture coordinates.
   */
  octavesAt(at: Vec2): Float
  /** Part of the light from behind that passes, in [0, 1]. */
  transmittanceAt(at: Vec2): Float
}

/** Shadows in the air of a picture. */
export interface ScreenShadows extends SkyLayer {
  /**
   * Draws the shadows before a foreground layer is drawn, which may take light past them: `prepare` of a layer with a
   * foreground goes on from there.
   */
  prepareShadows(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void
  /**
   * Takes what shadows take from a colour, linear sRGB × `luminanceScale`.
   *
   * @param transmittance - That of the foreground, where it is known.
   */
  dim(color: Vec3, transmittance?: Float): Vec3
  /**
   * Light that the pixel loses, linear sRGB × `luminanceScale`; undefined where another node takes it.
   *
   * @param position - Position of what is seen, or of any point in front of the sky, in view space [world units].
   */
  lostAt(position: Vec3, isSky: Bool): Vec3 | undefined
}

/** Shadows in the air of a mesh, which draws all of each ray, to the planet or out of the air. */
export interface MeshShadows extends ScreenShadows {
  /** Compiles a material with {@link scatterAlong} anew whenever its shader changes. */
  compileWith(material: NodeMaterial): void
  /**
   * Draws what a mesh of air reads, before that is drawn; shadows are for their own camera and their atmosphere's sun alone.
   *
   * @param isMarched - True if it marches its air itself, by {@link scatterAlong}; else it reads {@link dim}.
   */
  prepareMesh(frame: NodeFrame, sun: object, isMarched: boolean): void
  /**
   * Light scattered between two places of the fragment's ray, which need not start at the camera, in these shadows.
   *
   * @param entry - Distance on the ray from which those of its places are [m].
   */
  scatterAlong(entry: Float): typeof scatterSegment
}

/** A node that draws the air of a camera's picture. */
export interface AirPicture {
  /** Name of its class, for errors. */
  readonly type: string
  readonly camera: Camera
  readonly atmosphere: Atmosphere
}

/**
 * Shadows in the air, as `lightShafts` makes them: what they take from the light of an atmosphere and of its media is
 * drawn by the nodes that they are given to, after all layers.
 */
export interface AirShadows extends Pick<SkyLayer, 'prepare' | 'update' | 'medium'> {
  /** Atmosphere whose air it is. */
  readonly atmosphere: Atmosphere
  /** Source of the light. */
  readonly source: LightSource
  /**
   * Layer for a post effect, computed once for its pixels and not by every material.
   *
   * @param depthNode - Depth of the scene, as the renderer writes it.
   * @param foreground - Drawn over the air, by a node that then draws these shadows instead of all others: by `dim`.
   * @param picture - The node that draws them, to be checked.
   * @throws If the picture is another camera's or another atmosphere's, which would have no shadows.
   */
  upTo(depthNode: Node, foreground?: ForegroundLayer, picture?: AirPicture): ScreenShadows
  /** For a mesh of air; absent from shafts of post effects alone. */
  onMesh?(): MeshShadows
}

/** Options of nodes that draw air. */
export interface AirOptions {
  /** Shadows in the air, of one light or of several, such as sun and moon; by default none. */
  shafts?: AirShadows | readonly AirShadows[]
  /** Draws the sky where nothing was drawn; by default true. */
  showSky?: boolean
  /** Draws the sun's disc in that sky; by default true. */
  showSun?: boolean
}

/** Shadows of an option, in a list. */
export const shaftsIn = (shafts: AirOptions['shafts'] = []): readonly AirShadows[] =>
  [shafts].flat()

/** @throws If an option is unknown or of the wrong kind. */
export function checkAirOptions(where: string, options: AirOptions): void {
  const {
    shafts,
    showSky = true,
    showSun = true
  } = checkOptions(where, options, 'shafts', 'showSky', 'showSun')
  for (const each of shaftsIn(shafts)) {
    if (!each?.upTo) fail(where, 'shafts must be LightShafts', each)
  }
  checkBoolean(where, 'showSky', showSky)
  checkBoolean(where, 'showSun', showSun)
}
