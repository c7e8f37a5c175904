import { defineConfig } from 'vite'

const pages = ['index', 'geo', 'clouds', 'fiber'].map(name => `${name}.html`)

export default defineConfig({ build: { rolldownOptions: { input: pages } } })
