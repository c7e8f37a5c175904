import { addons } from 'storybook/manager-api'
import { create } from 'storybook/theming'

addons.setConfig({
  theme: create({ base: 'dark', brandTitle: 'Welkin' }),
  // Keys belong to the story.
  ui: { enableShortcuts: false },
  layout: { panelPosition: 'right', rightPanelWidth: 400, navSize: 190 }
})
