import { Color, DirectionalLight, HemisphereLight, MathUtils } from 'three'
import type { Scene, Vector3 } from 'three'

const SPACE = new Color('#000004')
const SKY_INTENSITY = 1.8
const SKY = new Color('#6f9fd8')

/** Stand-in for the atmosphere: a sun, an even sky, and a background that darkens with altitude and at night. */
export class Daylight {
  readonly sun = new DirectionalLight('#fff6e8', 5)
  private readonly sky = new HemisphereLight('#b9d4ff', '#8a8271', SKY_INTENSITY)
  private readonly background = new Color()

  constructor(private readonly scene: Scene) {
    scene.add(this.sun, this.sun.target, this.sky)
    scene.background = this.background
  }

  update(sunDirectionWorld: Vector3, upWorld: Vector3, altitude: number): void {
    const day = MathUtils.smoothstep(sunDirectionWorld.dot(upWorld), -0.1, 0.15)
    this.sky.position.copy(upWorld)
    this.sky.intensity = SKY_INTENSITY * (altitude > 100_000 ? 0.1 : Math.max(day, 0.02))
    this.background.lerpColors(SPACE, SKY, day * Math.exp(-altitude / 15_000))
  }

  dispose(): void {
    this.scene.remove(this.sun, this.sun.target, this.sky)
    this.sun.dispose()
    this.sky.dispose()
  }
}
