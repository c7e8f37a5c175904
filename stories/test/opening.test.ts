import { readFileSync } from 'node:fs'
import { fileURLToPath } from 'node:url'
import { expect, it } from 'vitest'
import preview from '../.storybook/preview'
import { openingState } from '../src/valley/openingState'
import meta, { Day } from '../src/valley.stories'

const file = fileURLToPath(new URL('../src/valley.stories.ts', import.meta.url))

it('is a day in the valley, as it comes', () => {
  const { order } = preview.parameters!.options.storySort as { order: string[] }
  expect(order[0]).toBe(meta.title)
  expect(/^export const (\w+)/m.exec(readFileSync(file, 'utf8'))?.[1]).toBe('Day')
  expect(Day.args).toBeUndefined()
  expect(meta.args).toMatchObject(openingState)
})

it('has a control for all that the valley can be told', () => {
  const controls = meta.argTypes as Record<string, { control?: unknown } | undefined>
  const without = Object.keys(openingState).filter(name => controls[name]?.control === undefined)
  expect(without).toEqual([])
})
