import { expect, it } from 'vitest'
import meta, { Everything, Meadow } from '../src/terrain.stories'
import type { TerrainArgs } from '../src/terrain.scene'
import { hasEffects, NO_EFFECTS } from '../src/terrain/GroundFinish'
import type { PostEffects } from '../src/valley/finish'

const argsOf = ({ args }: { args?: Partial<TerrainArgs> }): TerrainArgs =>
  ({ ...meta.args, ...args }) as TerrainArgs

it('has a picture drawn to a texture for each post effect, and for nothing else', () => {
  const bare = argsOf(Meadow)
  expect(hasEffects(bare)).toBe(false)
  const full: TerrainArgs = { ...bare, clouds: true, vegetation: true }
  expect(hasEffects(full)).toBe(false)
  for (const name of Object.keys(NO_EFFECTS) as (keyof PostEffects)[]) {
    const on = name === 'antialiasing' ? 'traa' : true
    expect([name, hasEffects({ ...bare, [name]: on })]).toEqual([name, true])
  }
})

it('has a switch for each post effect', () => {
  for (const name of Object.keys(NO_EFFECTS)) expect(meta.argTypes).toHaveProperty(name)
})

it('has all of a landscape in the story of everything', () => {
  const all = argsOf(Everything)
  const parts = ['clouds', 'shafts', 'mirror', 'night', 'vegetation', 'shadows'] as const
  for (const part of parts) expect([part, all[part]]).toEqual([part, true])
  expect(hasEffects(all)).toBe(true)
})
