import { DoubleSide, Matrix4, NearestFilter, NoBlending, OrthographicCamera, Vector3 } from 'three'
import type { Camera, Object3D, Scene } from 'three'
import { positionView, texture, vec4 } from 'three/tsl'
import { NodeMaterial, RendererUtils } from 'three/webgpu'
import type { Renderer, TextureNode } from 'three/webgpu'
import { checkOptions, checkPositive, fail } from '@welkin/geo'
import { tableTarget } from '../tables/FragmentPass'
import { sampleLevel0, type Bool, type Mat4, type Vec3 } from '../tsl-types'
import { matrix4 } from '../uniforms'
import type { FallingLattice } from './FallingLattice'

/** Options of {@link PrecipitationShelter}. */
export interface PrecipitationShelterOptions {
  /** Half width of the map about the camera, > 0 [m]; by default 26. */
  extent?: number
  /** Height above the camera from which the map looks down, > 0 [m]; by default 60. */
  height?: number
  /** Texels along each edge, a positive integer; by default 512. */
  size?: number
}

/** Depth below a surface at which a particle counts as sheltered [m]: a step of half floats at the map's height. */
const BIAS = 0.1
/** Lean of the fall, over its speed, at most: the map shall look down. */
const MOST_LEAN = 1

const _offset = new Vector3()
const _target = new Vector3()
const _up = new Vector3(0, 0, -1)
const _view = new Matrix4()
const _toMap = new Matrix4()

/** Hides objects for a while. @returns Shows them again. */
function hide(scene: Object3D, isHidden: (object: Object3D) => boolean): () => void {
  const hidden: Object3D[] = []
  scene.traverseVisible(object => {
    if (isHidden(object)) hidden.push(object)
  })
  for (const object of hidden) object.visible = false
  return () => {
    for (const object of hidden) object.visible = true
  }
}

/**
 * Shelter from rain and snow: a map of distances to what stands above, seen from where they fall.
 *
 * ```ts
 * const shelter = new PrecipitationShelter(scene)
 * scene.add(rainfall(atmosphere, { lights: [sun, sky], shelter }))
 * shelter.needsUpdate = true // when something above has moved
 * ```
 *
 * It is drawn when it is first used, when the camera has moved by a quarter of its half width, when the wind has turned, and on
 * demand. Its camera has layers, to leave out what shelters nothing.
 */
export class PrecipitationShelter {
  /** Scene whose meshes shelter; shared, not owned. */
  readonly scene: Scene
  /** Half width of the map [m]. */
  readonly extent: number
  /** Height above the camera from which the map looks down [m]. */
  readonly height: number
  /** Camera that draws the map. */
  readonly camera: OrthographicCamera
  /** Set to true to have the map drawn again. */
  needsUpdate = true
  readonly #material = new NodeMaterial()
  readonly #target
  readonly #texture: TextureNode
  /** View space [world units] to the map: texture coordinates, and distance from its camera [m]. */
  readonly #matrix = matrix4()
  /** Place that the map is drawn about, and where particles come from, in the lattice's frame. */
  readonly #middle = new Vector3()
  readonly #lean = new Vector3()
  readonly #axes = new Matrix4()

  /** @throws If the scene is none, or an option unknown or out of range. */
  constructor(scene: Scene, options: PrecipitationShelterOptions = {}) {
    const where = 'PrecipitationShelter'
    if (!(scene as Object3D | undefined)?.isObject3D) fail(where, 'scene must be a Scene', scene)
    const {
      extent = 26,
      height = 60,
      size = 512
    } = checkOptions(where, options, 'extent', 'height', 'size')
    checkPositive(where, 'extent', extent)
    checkPositive(where, 'height', height)
    if (!Number.isInteger(size) || size < 1) fail(where, 'size must be a positive integer', size)
    this.scene = scene
    this.extent = extent
    this.height = height
    this.camera = new OrthographicCamera(-extent, extent, extent, -extent, 0.1, 3 * height)
    this.camera.matrixAutoUpdate = this.camera.matrixWorldAutoUpdate = false
    Object.assign(this.#material, {
      name: 'Welkin.PrecipitationShelter',
      blending: NoBlending,
      side: DoubleSide,
      fog: false,
      lights: false,
      fragmentNode: vec4((positionView as unknown as Vec3).z.negate(), 0, 0, 1)
    })
    this.#target = tableTarget('Welkin.PrecipitationShelter', size, size, 1, NearestFilter)
    this.#target.depthBuffer = true
    this.#texture = texture(this.#target.texture)
  }

  /** Draws the map if it is stale. @param speed - Mean speed of fall [m/s]. */
  render(renderer: Renderer, camera: Camera, lattice: FallingLattice, speed: number): void {
    _offset.copy(lattice.wind).divideScalar(-speed).clampLength(0, MOST_LEAN)
    const isTurned = _offset.distanceTo(this.#lean) > 0.15
    const isLeft = lattice.camera.distanceTo(this.#middle) > this.extent / 4
    if (!this.needsUpdate && !isTurned && !isLeft) return
    this.needsUpdate = false
    this.#lean.copy(_offset)
    this.#middle.copy(lattice.camera)
    const from = _offset.setY(1).multiplyScalar(this.height)
    this.#axes.lookAt(from, _target.setScalar(0), _up).setPosition(from)
    const map = this.camera
    map.matrixWorld.copy(lattice.toView).setPosition(0, 0, 0).premultiply(camera.matrixWorld)
    map.matrixWorld.multiply(this.#axes)
    map.matrixWorldInverse.copy(map.matrixWorld).invert()
    this.#draw(renderer)
  }

  #draw(renderer: Renderer): void {
    const { scene, camera } = this
    const show = hide(scene, object => 'isPrecipitation' in object)
    const state = RendererUtils.resetRendererState(renderer, {} as never)
    const sceneState = RendererUtils.resetSceneState(scene, {} as never)
    scene.overrideMaterial = this.#material
    renderer.setClearColor(0x000000, 0)
    renderer.autoClear = true
    renderer.setRenderTarget(this.#target)
    renderer.render(scene, camera)
    RendererUtils.restoreSceneState(scene, sceneState)
    RendererUtils.restoreRendererState(renderer, state)
    show()
  }

  /** Sets uniforms for a camera. */
  update({ toView, camera }: FallingLattice): void {
    const scale = 0.5 / this.extent
    _offset.copy(camera).sub(this.#middle)
    _toMap.set(scale, 0, 0, 0.5, 0, -scale, 0, 0.5, 0, 0, -1, 0, 0, 0, 0, 1)
    this.#matrix.value
      .copy(_toMap)
      .multiply(_view.copy(this.#axes).invert())
      .multiply(_view.makeTranslation(_offset))
      .multiply(_view.copy(toView).setPosition(0, 0, 0).invert())
  }

  /** True for a place that nothing is above, and beyond the map. @param place - In view space [world units]. */
  isOpen(place: Vec3): Bool {
    const at = (this.#matrix as unknown as Mat4).mul(vec4(place, 1)).xyz.toConst() as Vec3
    const roof = sampleLevel0(this.#texture, at.xy.clamp(0, 1)).r.toConst()
    const isBeyond = at.xy.sub(0.5).abs().sub(0.5).toConst()
    return roof
      .lessThanEqual(0)
      .or(at.z.lessThan(roof.add(BIAS)))
      .or(isBeyond.x.max(isBeyond.y).greaterThan(0))
  }

  /** Frees its texture and pipeline. It can be used again. */
  dispose(): void {
    this.#target.dispose()
    this.#material.dispose()
    this.needsUpdate = true
  }
}
