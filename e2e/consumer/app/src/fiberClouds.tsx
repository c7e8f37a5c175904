import { Canvas } from '@react-three/fiber'
import { StrictMode } from 'react'
import { createRoot } from 'react-dom/client'
import { WebGPURenderer } from 'three/webgpu'
import { CloudyAir } from './readme/packages-clouds-README-md'

async function makeRenderer({ canvas }: { canvas: unknown }): Promise<WebGPURenderer> {
  const renderer = new WebGPURenderer({ canvas: canvas as HTMLCanvasElement })
  await renderer.init()
  return renderer
}

document.body.style.margin = '0'
const root = document.body.appendChild(document.createElement('div'))
root.style.height = '100vh'
createRoot(root).render(
  <StrictMode>
    <Canvas
      shadows="percentage"
      gl={makeRenderer}
      camera={{ fov: 60, near: 1, far: 100_000, position: [0, 2, 0], rotation: [0.25, 0, 0] }}
    >
      <CloudyAir />
      <mesh receiveShadow rotation-x={-Math.PI / 2}>
        <circleGeometry args={[20_000, 64]} />
        <meshStandardMaterial color="#6b7350" />
      </mesh>
    </Canvas>
  </StrictMode>
)
