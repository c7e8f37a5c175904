import type { StorybookConfig } from '@storybook/html-vite'
import { mergeConfig } from 'vite'
import { sourceAliases } from '../../scripts/aliases.ts'
import { worldData } from '../vite/worldData.ts'

const config: StorybookConfig = {
  framework: '@storybook/html-vite',
  stories: ['../src/*.stories.ts', '../src/gallery/*.stories.ts'],
  core: { disableTelemetry: true, disableWhatsNewNotifications: true, enableCrashReports: false },
  features: {
    backgrounds: false,
    highlight: false,
    measure: false,
    outline: false,
    viewport: false,
    actions: false,
    interactions: false,
    sidebarOnboardingChecklist: false,
    menuOnboardingChecklist: false
  },
  viteFinal: viteConfig =>
    mergeConfig(viteConfig, {
      plugins: [worldData()],
      resolve: { alias: sourceAliases, dedupe: ['three'] },
      // Relative, so that the built Storybook works from any directory of a web server.
      base: './',
      build: { target: 'es2022', chunkSizeWarningLimit: 4000 }
    })
}

export default config
