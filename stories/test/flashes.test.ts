import { readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { expect, it } from 'vitest'

const folder = fileURLToPath(new URL('../src/', import.meta.url))
const scenes = readdirSync(folder, { recursive: true, encoding: 'utf8' }).filter(
  file => file.endsWith('.ts') && /\blightning\(/.test(readFileSync(folder + file, 'utf8'))
)

it('has flashes in stories that are asked for alone, and gentle then: they may harm people', () => {
  // Files with lightning, and those that say how their stories open.
  const openings = {
    'stormNight.scene.ts': 'stormNight.stories.ts',
    'valley/flashes.ts': 'valley/openingState.ts'
  }
  expect(scenes.toSorted()).toEqual(Object.keys(openings))
  for (const [scene, opening] of Object.entries(openings)) {
    const code = readFileSync(folder + scene, 'utf8')
    // Its code, which readers copy, says so too.
    const [shown] = code.split('// #region lightning')[1].split('// #endregion')
    expect(shown).toContain('storm.enabled = false')
    const args = readFileSync(folder + opening, 'utf8')
    expect(args.match(/\bflashes: (?:true|false)/g)).toEqual(['flashes: false'])
    // Gentle by default, or by an argument.
    expect(code).toMatch(/lightning\(node\)|limit: gentle \? 0\.3/)
    expect(args.match(/\bgentle: (?:true|false)/g) ?? ['gentle: true']).toEqual(['gentle: true'])
  }
  const valley = readFileSync(folder + 'valley.stories.ts', 'utf8')
  expect(valley).not.toContain('flashes: true')
})
