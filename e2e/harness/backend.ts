/** Which of three's backends draws. */
export type Backend = 'webgpu' | 'webgl'
