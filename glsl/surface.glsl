#pragma once
// What a technique is given and what it gives back. Metres, world space; directions are unit and leave the surface.

const float kPi = 3.14159265358979323846;

struct Surface {
  vec3 position;        // m, world
  vec3 normal;          // unit shading normal; its plane is the horizon
  float roughness;      // the artist's value, [0, 1]
  float alpha;          // roughness², at least kMinAlpha
  vec3 diffuse_albedo;  // base · (1 − metalness)
  vec3 f0;              // reflectance at normal incidence: mix(0.04, base, metalness)
#if EFFECT_APERTURE
  // Caps of directions, each a unit axis; w: versine, 1 − cos of the radius.
  vec4 aperture;        // that meet no surface
  vec4 first_region;    // the two largest contiguous regions of these
  vec4 second_region;
  vec4 blocked;         // that meet one
#endif
};

// Computed once per light on the host, in double, then rounded; the same for every technique.
struct Light {
  int shape;          // one of SHAPE_*
  bool two_sided;
  vec3 center;        // m, world
  vec3 normal;        // unit, towards the lit side; right-handed: axis_x × axis_y
  vec3 axis_x;        // unit
  vec3 axis_y;        // unit
  vec3 half_axis_x;   // m: A = axis_x · half_size.x
  vec3 half_axis_y;   // m: B = axis_y · half_size.y
  vec2 half_size;     // m; disk and sphere: the radius, twice; polygon: how far its corners reach; tube: half its length, its radius
  float area;         // m², of one side; sphere: πR², its cross-section; tube: 2R · length, seen from the side
  vec3 radiance;      // W/(m² sr) or cd/m², linear sRGB
#if EFFECT_POLYGON
  int index;          // in the light block, whose corners LightCorner gives
  int corner_count;   // of a polygon
  bool turned;        // whether FaceLight has turned the frame
#endif
  vec3 products;      // m²: half_size.x², half_size.y², 2 · half_size.x · half_size.y
#if EFFECT_TEXTURED
  vec3 image;         // its layer in the texture arrays, 0 where it shows none; width, height in texels
#endif
};

// Reflected radiance towards the viewer, in the light's unit.
struct Radiance {
  vec3 diffuse;
  vec3 specular;
};

#define SHAPE_RECTANGLE 0
#define SHAPE_DISK 1  // and ellipses
#define SHAPE_SPHERE 2
#define SHAPE_POLYGON 3
#define SHAPE_TUBE 4

// The GGX peak 1/(π α²) is 3e7 there: safe in float32.
const float kMinAlpha = 1e-4;
