import { PerspectiveCamera, Texture, Vector3 } from 'three'
import { texture } from 'three/tsl'
import {
  Atmosphere,
  moon,
  MoonDirectionalLight,
  NightLightProbe,
  SkyLightProbe,
  skyLuminanceAt,
  SunDirectionalLight,
  surfaceLighting,
  type SurfaceLightingOptions
} from '@welkin/atmosphere'
import { notASource, throwsEach, wrong } from '../harness/wrong'

const atmosphere = new Atmosphere()
const camera = new PerspectiveCamera()
const luna = moon().attach(atmosphere)
const picture = texture(new Texture())
const zero = new Vector3()

throwsEach('lights and questions about light', [
  [`SkyLightProbe: source ${notASource}`, () => new SkyLightProbe(atmosphere, wrong(luna))],
  [
    `SunDirectionalLight: source ${notASource}`,
    () => new SunDirectionalLight(atmosphere, 1, wrong(luna))
  ],
  [
    'MoonDirectionalLight: moon must be a Moon, got { source: 1 }',
    () => new MoonDirectionalLight(atmosphere, wrong({ source: 1 }))
  ],
  [
    'SurfaceLightingNode: colorNode must be a node, got undefined',
    () => surfaceLighting(wrong(undefined), picture, camera, [])
  ],
  [
    "SurfaceLightingNode: depthNode must be a texture's node, got null",
    () => surfaceLighting(picture, wrong(null), camera, [])
  ],
  [
    'SurfaceLightingNode: camera must be a Camera',
    () => surfaceLighting(picture, picture, wrong(atmosphere), [])
  ],
  [
    'SurfaceLightingNode: lights must be an array of Lights',
    () => surfaceLighting(picture, picture, camera, wrong(atmosphere))
  ],
  [
    'SurfaceLightingNode: lights[0] must be a Light',
    () => surfaceLighting(picture, picture, camera, [wrong(camera)])
  ],
  ...(
    [
      [{ strength: 1.5 }, 'strength must be in [0, 1], got 1.5'],
      [{ albedo: -1 }, 'albedo must be finite and ≥ 0, got -1'],
      [{ normal: wrong(1) }, 'normal must be a node, got 1'],
      [{ mask: wrong('x') }, "mask must be a node, got 'x'"]
    ] satisfies [SurfaceLightingOptions, string][]
  ).map(
    ([options, message]) =>
      [
        `SurfaceLightingNode: ${message}`,
        () => surfaceLighting(picture, picture, camera, [], options)
      ] as [string, () => unknown]
  ),
  ['NightLightProbe: illuminance must', () => new NightLightProbe(atmosphere, wrong(null))],
  ['skyLuminanceAt: there are no tables yet', () => skyLuminanceAt(atmosphere, zero, zero)],
  [
    'skyLuminanceAt: source must be a LightSource',
    () => skyLuminanceAt(atmosphere, zero, zero, { source: wrong(null) })
  ]
])
