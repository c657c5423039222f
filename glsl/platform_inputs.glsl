#pragma once
// What the host binds, the same in both precisions: floats in, floats out. Set by glsl/renderer.cpp.

layout(binding = 0) uniform sampler2D gbuffer_position;    // m, world; w: 0 background, 1 surface, else an emitter
layout(binding = 1) uniform sampler2D gbuffer_normal;      // unit; w: artist's roughness
layout(binding = 2) uniform sampler2D gbuffer_base_color;  // linear sRGB; w: metalness, or below 0 a non-metal whose specular lobe weighs 1 + w

#if EFFECT_APERTURE
// Caps of directions, each a unit axis and (w) a versine; 0 where nothing was baked.
layout(binding = 14) uniform sampler2D gbuffer_aperture;       // that meet no surface
layout(binding = 13) uniform sampler2D gbuffer_first_region;   // the two largest contiguous regions of these
layout(binding = 12) uniform sampler2D gbuffer_second_region;
layout(binding = 11) uniform sampler2D gbuffer_blocked;        // that meet one
#endif

#if EFFECT_TEXTURED
// Textures of lights, one a layer, layer 0 white, in the forms of glsl/light_textures.h.
layout(binding = 8) uniform sampler2DArray light_image;          // the texels, as many as each has
layout(binding = 9) uniform sampler2DArray light_weights;        // rules of product integration
layout(binding = 10) uniform sampler2DArray light_means;         // means over squares
layout(binding = 11) uniform sampler2DArray light_cosine;        // blurred by a cosine lobe's trace
layout(binding = 12) uniform sampler2DArray light_cosine_border; // the same, with what lies around the light
layout(binding = 13) uniform sampler2DArray light_solid_angle;   // blurred by solid angle
layout(binding = 7) uniform sampler2DArray light_phong;          // blurred by Phong's lobe
layout(binding = 15) uniform sampler2DArray light_straight;     // means of colours and of alpha, each by itself
#endif

#if EFFECT_SKY_TEXTURE
// The sky's texture in the forms of glsl/sky_maps.h.
layout(binding = 16) uniform sampler2DArray sky_image;
layout(binding = 17) uniform sampler2DArray sky_lobes;
layout(binding = 18) uniform sampler2DArray sky_cosine;
uniform float sky_turn;  // revolutions counter-clockwise, seen from above
#endif

#define MAX_LIGHTS 256
#define LIGHT_ROWS 8
layout(std140, binding = 0) uniform LightBlock {
  vec4 light_rows[MAX_LIGHTS * LIGHT_ROWS];  // what each row holds: glsl/light_block.h
};

#if EFFECT_POLYGON
#define CORNER_ROWS 4
layout(std140, binding = 1) uniform CornerBlock {
  vec4 corner_rows[MAX_LIGHTS * CORNER_ROWS];
};
#endif

uniform vec3 view_position;  // m, world
uniform int light_count;
#if EFFECT_SKY
uniform vec3 sky_radiance;  // from every direction, in the lights' unit; of a textured sky what a white texel sends
#endif

layout(location = 0) out vec4 out_diffuse;
layout(location = 1) out vec4 out_specular;
