import {
  Atmosphere,
  distanceFog,
  heightFog,
  lightShafts,
  moon,
  moonIlluminanceAt,
  skyIlluminanceAt,
  SunDirectionalLight,
  sunIlluminanceAt
} from '@welkin/atmosphere'
import {
  cloudAirShadow,
  CloudCover,
  cloudFogLight,
  CloudLightTable,
  cloudPreset,
  precipitationShafts
} from '@welkin/clouds'
import { BoxGeometry, Mesh, MeshBasicMaterial, Vector3 } from 'three'
import { CloudView, SparseNoise, viewSize } from '../harness/cloud-view'
import { luminance } from '../harness/environment'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const up = new Vector3(0, 1, 0)

gpuTest(
  'fog under an overcast is as dark as the ground, and once where shafts have the clouds',
  async t => {
    const renderer = await t.createRenderer(viewSize)
    const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 45 })
    const luna = moon({ mapSize: 16, lightsAir: false, phase: 0.5 })
    atmosphere.add(luna)
    const mist = heightFog({ falloff: 80, density: 0.05, sources: [luna.source] })
    const far = distanceFog({ density: 1 / 300, fade: [1e4, 2e4] })
    atmosphere.add(mist, far)
    let moonHeight = 0
    /** Sun and moon aside of the camera, which sees no forward peak. */
    const setLights = (sun: number, lunar: number): void => {
      atmosphere.setSunAngles(lunar, 90)
      luna.direction = atmosphere.sunDirection
      moonHeight = atmosphere.sunDirection.y
      atmosphere.setSunAngles(sun, 90)
      atmosphere.luminanceScale = sun > 0 ? 1e-4 : 10
    }
    const layers = cloudPreset('overcast')
    const light = new CloudLightTable()
    const noise = new SparseNoise()
    const precipitation = precipitationShafts()
    const view = new CloudView(renderer, atmosphere, layers, { noise, light, precipitation })
    const { camera, node, scene } = view
    const wall = new Mesh(new BoxGeometry(4000, 4000, 10), new MeshBasicMaterial({ color: 0 }))
    wall.position.z = -2000
    scene.add(wall)
    camera.position.y = 2
    const [mistLight, farLight] = [mist, far].map(fog => cloudFogLight(fog, node))
    const cover = new CloudCover(layers, { light })
    /** All light of level ground. */
    const ground = (clouds: CloudCover): number => {
      const place = new Vector3()
      const sky = [{ clouds }, { clouds, source: luna.source }].map(options =>
        luminance(skyIlluminanceAt(atmosphere, place, up, options))
      )
      const sun = luminance(sunIlluminanceAt(atmosphere, place, { clouds }))
      const moonlight = luminance(moonIlluminanceAt(luna, place, { clouds }))
      const { sunDirection } = atmosphere
      return (
        sky[0] + sun * Math.max(sunDirection.y, 0) + sky[1] + moonlight * Math.max(moonHeight, 0)
      )
    }
    const look = async (): Promise<number> =>
      luminance((await view.draw(3)).at(viewSize.width / 2, viewSize.height / 2))
    const coverages = [...layers].map(({ parameters }) => parameters.coverage)
    const setClouds = (share: number): void =>
      [...layers].forEach((layer, i) => void layer.set({ coverage: share * coverages[i] }))

    for (const [sun, lunar, name, density, thickness] of [
      [5, -30, 'height fog', 0.05, 0],
      [60, -30, 'height fog', 0.05, 0],
      [-30, 40, 'height fog by moonlight', 0.05, 0],
      [20, -30, 'distance fog', 0, 1 / 300]
    ] as const) {
      setLights(sun, lunar)
      mist.density = density
      far.density = thickness
      setClouds(1)
      const dark = await look()
      const onGround = ground(cover)
      setClouds(0)
      const bright = await look()
      const [got, expected] = [dark / bright, onGround / ground(cover)]
      t.note(`${name}, sun ${sun}°: ${got.toFixed(3)} for ${expected.toFixed(3)}`)
      expectTrue(Math.abs(got / expected - 1) < 0.1, `${name}, ${sun}°: ${got} for ${expected}`)
    }

    setLights(20, -30)
    // Rain from the deck dims what is in it, on the way down to the ground. Fog hides what falls before it.
    mist.density = 0.05
    far.density = 0
    setClouds(1)
    const [dry, dryGround] = [await look(), ground(cover)]
    layers.at(0).precipitation = { rate: 100, share: 1 }
    const [rainy, rainyGround] = [(await look()) / dry, ground(cover) / dryGround]
    layers.at(0).precipitation = null
    t.note(`in rain ${rainy.toFixed(3)} for ${rainyGround.toFixed(3)}`)
    expectTrue(rainyGround < 0.85, `rain leaves ${rainyGround} of the light on the ground`)
    expectTrue(Math.abs(rainy / rainyGround - 1) < 0.03, `fog in rain: ${rainy} for ${rainyGround}`)

    // Light shafts of these clouds dim the fog themselves.
    mist.density = 0.004
    far.density = 0
    setClouds(1)
    const sun = new SunDirectionalLight(atmosphere, 100)
    const shafts = lightShafts(atmosphere, camera, sun).add(cloudAirShadow(node))
    scene.add(sun, sun.target)
    view.show(node)
    const both = await look()
    for (const each of [mistLight, farLight]) each.dispose()
    atmosphere.remove(mist).add(mist)
    const alone = await look()
    t.note(`with light shafts ${(both / alone).toFixed(4)} of those alone`)
    expectTrue(
      Math.abs(both / alone - 1) < 0.01,
      `${both} for ${alone} where shafts have the clouds`
    )
    shafts.dispose()
    view.dispose()
    atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)
