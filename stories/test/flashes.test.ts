import { readdirSync, readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { expect, it } from 'vitest'

const folder = fileURLToPath(new URL('../src/', import.meta.url))
const scenes = readdirSync(folder, { recursive: true, encoding: 'utf8' }).filter(
  file => file.endsWith('.ts') && /\blightning\(/.test(readFileSync(folder + file, 'utf8'))
)

it('has flashes in stories that are asked for alone, and gentle then: they may harm people', () => {
  expect(scenes).toEqual(['stormNight.scene.ts'])
  for (const scene of scenes) {
    const code = readFileSync(folder + scene, 'utf8')
    // Its code, which readers copy, says so too.
    const [shown] = code.split('// #region lightning')[1].split('// #endregion')
    expect(shown).toContain('storm.enabled = false')
    const stories = readFileSync(folder + scene.replace('.scene.', '.stories.'), 'utf8')
    expect(stories.match(/\bflashes: (?:true|false)/g)).toEqual(['flashes: false'])
    expect(stories.match(/\bgentle: (?:true|false)/g)).toEqual(['gentle: true'])
  }
})
