import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import { cloudPresetNames, type CloudPresetName } from '@welkin/clouds'
import { PerspectiveCamera, Scene } from 'three'
import { float, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { expect, it, vi } from 'vitest'
import { createClouds, type CloudsArgs } from '../src/clouds.scene'
import * as stories from '../src/clouds.stories'
import { createLand, type LandStory } from '../src/globe/land'

vi.mock('../src/globe/land', () => ({ createLand: vi.fn() }))
vi.mock('../src/mount', () => ({ mount: () => () => null }))

/** What a story adds to the land, with arguments that are applied: all but the land itself, which needs a page. */
async function open(args: CloudsArgs): Promise<{ story: LandStory<CloudsArgs>; output: Node }> {
  const atmosphere = new Atmosphere()
  const pipeline: { outputNode?: Node } = {}
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
  return { story: story!, output: pipeline.outputNode! }
}

it.for(cloudPresetNames)('shows %s in whatever story it is chosen', async preset => {
  const args = { ...stories.default.args, preset } as CloudsArgs
  const { story, output } = await open(args)
  expect(output).toHaveProperty('isNode', true)
  story.dispose?.()
})
