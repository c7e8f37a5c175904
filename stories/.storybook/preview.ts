import type { Preview } from '@storybook/html-vite'

const preview: Preview = {
  parameters: {
    layout: 'fullscreen',
    options: {
      storySort: {
        order: ['Valley, all day', 'Gallery', 'Globe', 'Sandbox', 'Plain scene', 'Tables']
      }
    }
  }
}

export default preview
