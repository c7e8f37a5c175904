import { defineConfig } from 'vite'

const pages = ['index', 'geo', 'clouds', 'terrain', 'fiber', 'fiberClouds'].map(
  name => `${name}.html`
)

export default defineConfig({
  // React's development build: StrictMode mounts twice, and React reports what is wrong.
  define: { 'process.env.NODE_ENV': '"development"' },
  build: { rolldownOptions: { input: pages } }
})
