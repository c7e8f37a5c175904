// Uniforms of all that a camera renders: what is an object's own does not reach materials that three
// does not refresh.
export {
  matrix3Uniform as matrix3,
  matrix4Uniform as matrix4,
  numberUniform as number,
  vector2Uniform as vector2,
  vector3Uniform as vector3,
  vector4Uniform as vector4
} from '@welkin/atmosphere'
