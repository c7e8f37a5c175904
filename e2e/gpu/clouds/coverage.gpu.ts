import { Atmosphere } from '@welkin/atmosphere'
import { CloudField, CloudLayers, cloudPreset, cloudWorldMap } from '@welkin/clouds'
import { PerspectiveCamera, Vector3 } from 'three'
import { float, Loop, vec3 } from 'three/tsl'
import type { Node, NodeFrame } from 'three/webgpu'
import { cloudExtinction, verticalOpticalDepth } from '../harness/cloud-extinction'
import { CloudColumns, highestPeak, PlanetColumns } from '../harness/cloud-columns'
import { cloudScene, mean, places, worldMap } from '../harness/cloud-scene'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectFinite, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

// On one backend but for textures' edges: `clouds/density` holds these functions to their twins on both.
gpuTest(
  'covers the share of the sky that a layer asks for, all over the planet',
  async t => {
    const layers = cloudPreset('fairWeather')
    const { renderer, field, viewpoint, update, dispose } = await cloudScene(t, layers, {
      longitude: 20,
      latitude: 45
    })
    const { baseAltitude, topAltitude } = layers.at(0).parameters
    const count = 8192
    // A spiral of even density.
    const inputs = Array.from({ length: count }, (_, i) => {
      const z = (2 * i + 1) / count - 1
      const [across, angle] = [Math.sqrt(1 - z * z), 2.399963 * i]
      const place = new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
      return [...place.multiplyScalar(field.radius.value).sub(viewpoint).toArray(), 2000].map(
        Math.fround
      )
    })
    const steps = 12
    const misses: string[] = []
    for (const [coverage, weatherWeights] of [
      [0, [1, 0, 0, 0]],
      [0.2, [1, 0, 0, 0]],
      [0.5, [1, 0, 0, 0]],
      [0.8, [1, 0, 0, 0]],
      [1, [1, 0, 0, 0]],
      [0.5, [0, 1, 0, 0]]
    ] as [number, [number, number, number, number]][]) {
      layers.at(0).set({ coverage, weatherWeights })
      update()
      const depths = await evaluateOnGpu(renderer, inputs, input => {
        const ground = input.xyz
        const zenith = field.view.localCoordinates(ground).up.toConst()
        const depth = float(0).toVar()
        Loop(steps, ({ i }) => {
          const height = float(i as never)
            .add(0.5)
            .div(steps)
            .mul(topAltitude - baseAltitude)
            .add(baseAltitude)
          const offset = ground.add(zenith.mul(height)).toConst() as Node<'vec3'>
          const sample = { offset, ...field.view.localCoordinates(offset), distance: float(2000) }
          const extinction = cloudExtinction(field, sample, false)
          depth.addAssign(extinction.mul((topAltitude - baseAltitude) / steps))
        })
        return depth
      })
      const covered = inputs.filter((_, i) => depths[4 * i] > 0.7).length / count
      t.note(`${coverage} covers ${covered.toFixed(3)}`)
      if (Math.abs(covered - coverage) > 0.04) misses.push(`${coverage} covers ${covered}`)
    }
    expectTrue(misses.length === 0, misses.join(', '))
    dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'keeps the clouds of an area from 2 km to the whole globe',
  async t => {
    const layers = cloudPreset('fairWeather')
    const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
    const columns = new CloudColumns(scene.field, 80, 200_000, 12)
    const misses: string[] = []
    // Optical depths as they are, and as a march counts them.
    for (const [coverage, longitude, depthScale] of [
      [0.03, 20, 0.6],
      [0.2, 20, 1],
      [0.4, 20, 0.6],
      [0.93, 20, 1],
      [0.7, -120, 0.6]
    ]) {
      layers.at(0).set({ coverage })
      scene.field.depthScale.value = depthScale
      scene.field.atmosphere.place({ longitude, latitude: 45 })
      scene.update()
      const means: number[] = []
      for (const distance of [2e3, 1e4, 3e4, 1e5, 2e5, 4e5, 1e6, 3e6]) {
        columns.distance = distance
        const { depth } = await columns.draw(scene.renderer)
        means.push(1 - mean(depth.map(tau => Math.exp(-depthScale * tau))))
      }
      t.note(`${coverage} at ${longitude}°: opacity ${means.map(x => x.toFixed(3)).join(' ')}`)
      const worst = Math.max(...means.map(x => Math.abs(x - means[0])))
      if (worst > 0.04) misses.push(`coverage ${coverage}: opacity changes by ${worst}`)
    }
    expectTrue(misses.length === 0, misses.join(', '))
    columns.dispose()
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'covers what is asked for, from near and far',
  async t => {
    const layers = new CloudLayers([{}])
    const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
    const { field } = scene
    const [size, steps, depthScale] = [64, 16, 0.6]
    field.depthScale.value = depthScale
    const columns = new PlanetColumns(field, size, steps)
    const misses: string[] = []
    for (const [name, index] of [
      ['fairWeather', 0],
      ['stratocumulus', 0],
      ['cumulonimbus', 0]
    ] as const) {
      for (const coverage of [0, 0.03, 0.2, 0.5, 0.95, 1]) {
        layers.at(0).set({ ...cloudPreset(name).at(index).parameters, coverage })
        scene.update()
        const found: number[] = []
        for (const distance of [500, 3e5, 1e6, 2e7]) {
          const depth = await columns.draw(scene.renderer, layers.at(0).parameters, distance)
          found.push(1 - mean(depth.map(tau => Math.exp(-depthScale * tau))))
        }
        t.note(`${name} ${coverage}: ${found.map(x => x.toFixed(3)).join(' ')}`)
        const worst = Math.max(...found.map(x => Math.abs(x - coverage)))
        if (worst > 0.05) misses.push(`${name}: ${found.join(' ')} for ${coverage}`)
      }
    }
    expectTrue(misses.length === 0, misses.join(', '))
    columns.dispose()
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'has no grain from orbit: what pixels next to each other see is much alike',
  async t => {
    const [size, distance] = [128, 1e6]
    for (const [name, limit] of [
      ['fairWeather', 0.06],
      ['altocumulus', 0.05],
      ['cirrus', 0.08]
    ] as const) {
      const scene = await cloudScene(t, cloudPreset(name), { longitude: 20, latitude: 45 })
      const { field } = scene
      const columns = new CloudColumns(field, size, size * distance * field.pixelAngle.value, 8)
      columns.distance = distance
      const { light } = await columns.draw(scene.renderer)
      const middle = mean(light)
      const variance = mean(light.map(value => (value - middle) ** 2))
      const inRows = light.filter((_, i) => i % size > 0)
      const steps = inRows.map((value, i) => {
        const row = Math.floor(i / (size - 1))
        return (value - light[i + row]) ** 2
      })
      // 1 for white noise, 0 for an even sky.
      const grain = mean(steps) / (2 * variance)
      t.note(`${name}: ${grain.toFixed(3)}, deviation ${Math.sqrt(variance).toFixed(3)}`)
      expectTrue(grain < limit, `${name}: grain of ${grain}`)
      columns.dispose()
      scene.dispose()
    }
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'descends to the clouds of a world map without a pop, whatever they are',
  async t => {
    const map = worldMap()
    for (const [name, limit] of [
      ['fairWeather', 0.05],
      ['cumulonimbus', 0.06],
      ['cirrus', 0.1]
    ] as const) {
      const layers = cloudPreset(name)
      layers.at(0).set({ coverage: 0.5 })
      for (let i = 1; i < layers.length; i++) layers.at(i).set({ coverage: 0 })
      const scene = await cloudScene(t, layers, { longitude: 100, latitude: -30 }, map)
      const columns = new CloudColumns(scene.field, 60, 600_000, 12)
      for (const longitude of [100, 60]) {
        scene.field.atmosphere.place({ longitude, latitude: -30 })
        scene.update()
        const means: number[] = []
        for (const distance of [2e3, 2e5, 1e6, 2e6, 4e6, 2e7]) {
          columns.distance = distance
          means.push(1 - mean((await columns.draw(scene.renderer)).light))
        }
        t.note(`${name} at ${longitude}°: opacity ${means.map(x => x.toFixed(3)).join(' ')}`)
        const worst = Math.max(...means.map(x => Math.abs(x - means[0])))
        expectTrue(worst < limit, `${name} at ${longitude}°: opacity changes by ${worst}`)
      }
      columns.dispose()
      scene.dispose()
    }
    map.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'shows no lattice in an overcast sky from below',
  async t => {
    const size = 128
    // Wider than the noise's periods by far.
    const width = 90_000
    for (const place of places.map(([, p]) => p)) {
      const layers = new CloudLayers([
        { coverage: 0.95, density: 0.004, weatherWeights: [0, 1, 0, 0] }
      ])
      const scene = await cloudScene(t, layers, place)
      const columns = new CloudColumns(scene.field, size, width, 16)
      const { light } = await columns.draw(scene.renderer)
      const { ratio, wave } = highestPeak(light, size)
      t.note(`highest peak ${ratio.toFixed(1)} times the mean of its ring, at ${wave.join(', ')}`)
      // Noise without a lattice: the highest of 6,000 powers, exponentially distributed, is about 9.
      expectTrue(ratio < 18, `a peak of ${ratio} times the noise floor at ${wave.join(', ')}`)
      if (place === places[0][1]) {
        // The same noise as it repeats, for comparison: rows of clouds along its axes.
        const { shape } = scene.field.textures
        const inputs = Array.from({ length: size ** 2 }, (_, i) => [i % size, Math.floor(i / size)])
        const texels = await evaluateOnGpu(scene.renderer, inputs, input => {
          const at = vec3(input.xy.mul(width / size / 2600), 0.3)
          return shape.sample(at).level(2)
        })
        const rows = highestPeak(
          inputs.map((_, i) => texels[4 * i]),
          size
        )
        t.note(`rows of clouds: ${rows.ratio.toFixed(0)} at ${rows.wave.join(', ')}`)
        expectTrue(rows.ratio > 36, `rows of clouds would pass, with a peak of ${rows.ratio}`)
      }
      columns.dispose()
      scene.dispose()
    }
  },
  { backends: ['webgpu'] }
)

gpuTest('has no seam in a world map', async t => {
  const renderer = await t.createRenderer()
  const map = worldMap()
  const atmosphere = new Atmosphere()
  atmosphere.frame = 'ecef'
  const layers = new CloudLayers([{ coverage: 0.5, baseAltitude: 0, topAltitude: 1500 }])
  const field = new CloudField(atmosphere, layers, undefined, {
    worldMap: cloudWorldMap(map)
  })
  field.bake(renderer)
  const camera = new PerspectiveCamera()
  const seams: [string, (s: number) => [number, number]][] = [
    ['180° meridian', s => [180 + 0.2 * s, 30]],
    ['north pole', s => [s < 0 ? 10 : 190, 90 - 0.1 * Math.abs(s)]],
    ['south pole', s => [s < 0 ? -70 : 110, -90 + 0.1 * Math.abs(s)]]
  ]
  for (const [name, at] of seams) {
    const points = Array.from({ length: 101 }, (_, i) => {
      const [longitude, latitude] = at((i - 50) / 50)
      return atmosphere.ellipsoid.geodeticToECEF({
        longitude: ((longitude + 180) % 360) - 180,
        latitude,
        height: 700
      })
    })
    // From orbit, where only the map is seen.
    camera.position.copy(points[50]).multiplyScalar(3)
    camera.updateMatrixWorld()
    const view = atmosphere.update(renderer, camera)
    field.view.update({ renderer, camera } as unknown as NodeFrame)
    field.update(view, 0)
    field.pixelAngle.value = 0.002
    const viewpoint = view.up
      .clone()
      .multiplyScalar(atmosphere.parameters.bottomRadius + view.height)
    const inputs = points.map(point => {
      const offset = atmosphere.space.position(point, new Vector3()).sub(viewpoint)
      return [...offset.toArray(), offset.length()].map(Math.fround)
    })
    const results = await evaluateOnGpu(renderer, inputs, input => {
      const offset = input.xyz.toConst() as unknown as Node<'vec3'>
      const { altitude, up } = field.view.localCoordinates(offset)
      return verticalOpticalDepth(field, { offset, altitude, up, distance: input.w })
    })
    const depths = inputs.map((_, i) => results[4 * i])
    expectFinite(depths)
    const steps = depths.slice(1).map((depth, i) => Math.abs(depth - depths[i]) / mean(depths))
    t.note(
      `${name}: depth ${mean(depths).toFixed(2)}, largest step ${Math.max(...steps).toFixed(4)}`
    )
    expectTrue(mean(depths) > 0.05, `${name}: mean depth ${mean(depths)}`)
    expectTrue(Math.max(...steps) < 0.05, `${name}: a step of ${Math.max(...steps)}`)
  }
  field.dispose()
  atmosphere.dispose()
  map.dispose()
})
