import { Matrix3, Matrix4, Vector2, Vector3, Vector4 } from 'three'
import { renderGroup, uniform } from 'three/tsl'
import type { UniformNode } from 'three/webgpu'

// Uniforms of all that a camera renders: what is an object's own does not reach materials that three
// does not refresh.
export const number = (value = 0): UniformNode<'float', number> =>
  uniform(value).setGroup(renderGroup)
export const vector2 = (): UniformNode<'vec2', Vector2> =>
  uniform(new Vector2()).setGroup(renderGroup)
export const vector3 = (): UniformNode<'vec3', Vector3> =>
  uniform(new Vector3()).setGroup(renderGroup)
export const vector4 = (value = new Vector4()): UniformNode<'vec4', Vector4> =>
  uniform(value).setGroup(renderGroup)
export const matrix3 = (): UniformNode<'mat3', Matrix3> =>
  uniform(new Matrix3()).setGroup(renderGroup)
export const matrix4 = (): UniformNode<'mat4', Matrix4> =>
  uniform(new Matrix4()).setGroup(renderGroup)
