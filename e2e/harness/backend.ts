/** Backend of three that draws. */
export type Backend = 'webgpu' | 'webgl'
