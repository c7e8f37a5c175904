import type { Walker } from '@welkin/terrain'
import type { Vector3 } from 'three'

/** Ground and axes of the world that an {@link Explorer} moves in. */
export interface ExplorerOptions {
  /** Height of the ground below a place, along up, above the datum; NaN where none is known [m]. Default 0. */
  groundAt?: (position: Vector3) => number
  /** Height of the ground for those on foot, above the datum: with houses, whose walls stop them, and with beds of lakes [m]. Default `groundAt`. */
  footingAt?: (position: Vector3) => number
  /** Height of the surface of water, above the datum; −∞ where there is none: one wades and swims [m]. Default none. */
  waterAt?: (position: Vector3) => number
  /** Unit vector up at a place. Default +Y. */
  upAt?: (position: Vector3, target: Vector3) => Vector3
  /** Height of a place above the datum [m]. Default its y, in a world of metres. */
  heightAt?: (position: Vector3) => number
  /** Metres of the world's unit, > 0; heights stay in metres. Default 1. */
  metersPerUnit?: number
  /** Direction that north leans to, unit vector. Default −Z. */
  pole?: Vector3
  /** Line on how else the camera is moved, by other controls; for the help. */
  others?: string
  /** Someone on foot who knows slopes and water of the ground, and walks from near it on. */
  walker?: Walker
}
