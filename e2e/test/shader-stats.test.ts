import { expect, it } from 'vitest'
import { shaderStats } from '../harness/shader-stats'

const wgsl = `
// textures
@binding( 0 ) @group( 1 ) var nodeUniform0_sampler : sampler;
@binding( 1 ) @group( 1 ) var nodeUniform0 : texture_2d<f32>;
@binding( 2 ) @group( 1 ) var nodeUniform1 : texture_depth_2d;
@binding( 3 ) @group( 1 ) var nodeUniform2 : texture_storage_2d<rgba16float, write>;
@binding( 4 ) @group( 1 ) var nodeUniform3 : texture_cube<f32>;

fn biquadratic( map : texture_2d<f32>, coord : vec2f ) -> vec4f { return vec4f(); }
`

const glsl = `#version 300 es
precision highp sampler2D;
uniform sampler2D nodeUniform0;
uniform highp isampler3D nodeUniform1;
uniform sampler2DArrayShadow nodeUniform2;
uniform float nodeUniform3;
vec4 gather( sampler2D map, vec2 at ) { return vec4( 0.0 ); }
`

it('counts the textures that WGSL binds, not samplers, storage or parameters', () => {
  expect(shaderStats(wgsl)).toEqual({ lines: 7, textures: 3 })
})

it('counts the samplers that GLSL declares, not precisions or parameters', () => {
  expect(shaderStats(glsl)).toEqual({ lines: 7, textures: 3 })
})
