import { If, float, mix, screenCoordinate, vec4 } from 'three/tsl'
import type { NodeFrame, NodeMaterial, Renderer } from 'three/webgpu'
import { scatterSegment } from '../scattering/tsl/segment'
import { loop, type Float, type Vec3, type Vec4 } from '../tsl-types'
import { number } from '../uniforms'
import type { MeshShadows } from '../view/AirShadows'
import type { AtmosphereView } from '../view/AtmosphereView'
import { screenRay } from '../view/tsl/screenRay'
import type { CameraShafts } from './CameraShafts'
import { ScreenShafts } from './ScreenShafts'
import { staggered } from './tsl/lostLight'
import { shadowAt } from './tsl/shadowsAlong'

/** Samples of the shadow between two points of a mesh's ray. Fewer: grain at the edges of shadows, by orthographic cameras. */
const MESH_SAMPLES = 6

/** Height in radii of the planet above which meshes have no shafts: from there one direction holds all rays of light. */
const MAX_MESH_HEIGHT = 20

/** Light shafts in the picture of a mesh of air, whose rays end at the planet or nowhere. */
export class MeshShafts extends ScreenShafts implements MeshShadows {
  readonly #shafts: CameraShafts
  /** Material that marches these shadows, and version of the shafts that it was compiled for. */
  #material: NodeMaterial | undefined
  #compiled = 0
  /** `strengthNow`, for a mesh that marches its air itself. */
  readonly #marchedStrength = number()

  constructor(shafts: CameraShafts) {
    super(shafts, float(0.5), undefined, true)
    this.#shafts = shafts
  }

  compileWith(material: NodeMaterial): void {
    const key = material.customProgramCacheKey.bind(material)
    material.customProgramCacheKey = () => key() + String(this.#shafts.version)
    this.#material = material
    this.#compiled = this.#shafts.version
  }

  override prepareShadows(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void {
    super.prepareShadows(renderer, view, frame)
    const { version } = this.#shafts
    if (this.#material === undefined || this.#compiled === version) return
    this.#compiled = version
    this.#material.needsUpdate = true
  }

  prepareMesh(frame: NodeFrame, sun: object, isMarched: boolean): void {
    const { view, camera, strengthNow } = this.#shafts
    const { atmosphere, source } = view
    const isTheirs = frame.camera === camera && sun === atmosphere && source === atmosphere.sun
    const seen = isTheirs ? view.prepare(frame) : undefined
    this.hide()
    this.#marchedStrength.value = 0
    if (seen === undefined) return
    const { bottomRadius } = atmosphere.parameters
    if (isMarched && seen.height < MAX_MESH_HEIGHT * bottomRadius) {
      this.prepareShadows(frame.renderer!, seen, frame)
      this.#marchedStrength.value = strengthNow.value
    }
    if (isMarched) return
    this.prepare(frame.renderer!, seen, frame)
    this.update(seen)
  }

  scatterAlong(entry: Float): typeof scatterSegment {
    const { direction, origin } = screenRay()
    const start = this.#shafts.view.toMapped(origin).toConst() as Vec3
    const along = this.#shafts.view.toMapped(direction).normalize().toConst() as Vec3
    const offsetAt = (distance: Float): Vec3 => start.add(along.mul(entry.add(distance)))
    return (air, ray, from, to) => {
      const { direct, diffuse } = this.#arriving(offsetAt(from), offsetAt(to))
      const [once, again] = [true, false].map(isDirect =>
        scatterSegment(air, ray, from, to, {
          direct: isDirect,
          diffuse: !isDirect
        })
      )
      return {
        molecular: once.molecular.mul(direct).add(again.molecular.mul(diffuse)),
        aerosol: once.aerosol.mul(direct),
        depth: once.depth
      }
    }
  }

  /** Parts of the light that arrive between two points, by their offsets [m]: straight from the source, and scattered before. */
  #arriving(start: Vec3, end: Vec3): { direct: Float; diffuse: Vec4 } {
    const { view, shadowedAir } = this.#shafts
    const strength = this.#marchedStrength
    const direct = float(1).toVar() as Float
    const diffuse = vec4(1).toVar() as Vec4
    If(strength.greaterThan(0), () => {
      const jitter = staggered(screenCoordinate.xy.floor())
      const share = strength.min(1).div(MESH_SAMPLES).toConst() as Float
      loop('meshSample', MESH_SAMPLES, index => {
        const part = float(index).add(jitter).div(MESH_SAMPLES)
        const offset = mix(start, end, part).toConst() as Vec3
        const distance = offset.length().max(1e-3).toConst() as Float
        const ray = {
          direction: offset.div(distance).toConst() as Vec3,
          jitter
        }
        const { dark, missing } = shadowAt(view, shadowedAir, ray, distance)
        direct.subAssign(dark.mul(share))
        if (missing !== null) diffuse.subAssign(missing.mul(share))
      })
    })
    return { direct, diffuse }
  }
}
