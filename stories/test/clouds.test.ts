import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import { cloudPresetNames, type CloudsNode } from '@welkin/clouds'
import { PerspectiveCamera, Scene } from 'three'
import { float, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { expect, it, vi } from 'vitest'
import { stageNames, stages, type Stage } from '../src/clouds/stages'
import { createClouds, type CloudsArgs } from '../src/clouds.scene'
import * as stories from '../src/clouds.stories'
import { createLand, type LandStory } from '../src/globe/land'

vi.mock('../src/globe/land', () => ({ createLand: vi.fn<() => void>() }))
vi.mock('../src/mount', () => ({ mount: () => () => null }))

interface Pipeline {
  outputNode?: Node
}

/** Additions of a story to the land, and what is drawn: all but the land itself, which needs a page. */
async function open(
  args: CloudsArgs
): Promise<{ story: LandStory<CloudsArgs>; pipeline: Pipeline }> {
  const atmosphere = new Atmosphere()
  const pipeline: Pipeline = {}
  const air = {
    atmosphere,
    sun: new SunDirectionalLight(atmosphere),
    sky: new SkyLightProbe(atmosphere),
    post: { pipeline, color: vec4(0), depth: float(0) },
    update() {}
  }
  let story: LandStory<CloudsArgs> | undefined
  vi.mocked(createLand).mockImplementation((_canvas, _args, _fieldOfView, create) => {
    const land = { renderer: {}, scene: new Scene(), camera: new PerspectiveCamera(), air }
    story = create(land as never) as unknown as LandStory<CloudsArgs>
    return Promise.resolve({} as never)
  })
  await createClouds({} as HTMLCanvasElement, args)
  return { story: story!, pipeline }
}

it.for(cloudPresetNames)('shows %s in whatever story it is chosen', async preset => {
  const args = { ...stories.default.args, preset } as CloudsArgs
  const { story, pipeline } = await open(args)
  expect(pipeline.outputNode).toHaveProperty('isNode', true)
  story.dispose?.()
})

it('shows each stage of a cloud, light and noise, one after the other', async () => {
  const args = { ...stories.default.args, ...stories.HowACloudIsMade.args } as CloudsArgs
  const names = Object.keys(stages) as Stage[]
  expect(names).toEqual(['columns', 'profile', 'billows', 'detail', 'density', 'cloud'])
  expect(Object.keys(stageNames)).toEqual(names)
  // Each has something that the one before left out.
  const { story, pipeline } = await open(args)
  const node = pipeline.outputNode as CloudsNode
  const seen = names.map(stage => {
    story.apply({ ...args, stage })
    return JSON.stringify([node.field.layers.at(0).parameters, node.ambient])
  })
  expect(new Set(seen).size).toBe(names.length)
  expect(node.ambient).toBe(1)
  story.apply({ ...args, noise: true })
  expect(pipeline.outputNode).not.toBe(node)
  story.apply(args)
  expect(pipeline.outputNode).toBe(node)
  story.dispose?.()
})

it('has a story of each preset as it is', () => {
  const { default: _, ...each } = stories
  const shown = Object.values(each).map(story => story.args?.preset ?? 'fairWeather')
  const elsewhere = ['shower', 'snowShower'] // Rain and snow
  expect(new Set([...shown, ...elsewhere])).toEqual(new Set(cloudPresetNames))
})
