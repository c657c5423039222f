#pragma once
// The light block's rows made into the Light that techniques see.
#include "surface.glsl"
#include "platform"

Light LoadLight(int i) {
  vec4 row0 = LightRow(i, 0);
  vec4 row1 = LightRow(i, 1);
  vec4 row2 = LightRow(i, 2);
  vec4 row3 = LightRow(i, 3);
  vec4 row4 = LightRow(i, 4);
  Light light;
  // Where the scene has one shape only it is a constant, and branches on it vanish.
#if EFFECT_RECTANGLE + EFFECT_DISK + EFFECT_SPHERE + EFFECT_POLYGON + EFFECT_TUBE != 1
  light.shape = int(row0.w);
#elif EFFECT_RECTANGLE
  light.shape = SHAPE_RECTANGLE;
#elif EFFECT_DISK
  light.shape = SHAPE_DISK;
#elif EFFECT_SPHERE
  light.shape = SHAPE_SPHERE;
#elif EFFECT_POLYGON
  light.shape = SHAPE_POLYGON;
#else
  light.shape = SHAPE_TUBE;
#endif
#if EFFECT_TWO_SIDED
  light.two_sided = row1.w != 0.0;
#else
  light.two_sided = false;
#endif
  light.center = row0.xyz;
  light.normal = row1.xyz;
  light.axis_x = row2.xyz;
  light.axis_y = row3.xyz;
  light.half_size = vec2(row2.w, row3.w);
  light.half_axis_x = row4.xyz;
  light.area = row4.w;
  vec4 row5 = LightRow(i, 5);
  light.half_axis_y = row5.xyz;
#if EFFECT_POLYGON
  light.index = i;
  light.corner_count = int(row5.w);
  light.turned = false;
#endif
#if EFFECT_LIGHT_COLOR
  light.radiance = LightRow(i, 6).xyz;
#else
  light.radiance = vec3(LightRow(i, 6).x);  // white: with grey materials one channel is computed
#endif
  light.products = LightRow(i, 7).xyz;
#if EFFECT_TEXTURED
  light.image = vec3(LightRow(i, 6).w, LightRow(i, 5).w, LightRow(i, 7).w);
#endif
  return light;
}

// Turns a two-sided light's frame so that its lit side faces the point, right-handed as before. False where no lit side
// does: the point is in the plane or behind it. A sphere or a tube faces everything, and so does every light where nothing lies behind one.
// A light without an area is none, and one that is thinner than 1e-7 of its length neither: no float tells its sides apart.
bool FaceLight(inout Light light, vec3 position) {
#if EFFECT_THIN
  if (light.area <= max(1e-7 * (light.products.x + light.products.y), 1e-30)) return false;
#endif
#if EFFECT_BEHIND && (EFFECT_RECTANGLE || EFFECT_DISK || EFFECT_POLYGON)
#if EFFECT_TUBE
  if (light.shape != SHAPE_SPHERE && light.shape != SHAPE_TUBE)
#else
  if (light.shape != SHAPE_SPHERE)
#endif
  {
    float height = dot(light.normal, position - light.center);
#if EFFECT_TWO_SIDED
    if (light.two_sided && height < 0.0) {
      light.normal = -light.normal;
      light.axis_x = -light.axis_x;
      light.half_axis_x = -light.half_axis_x;
#if EFFECT_POLYGON
      light.turned = true;
#endif
      height = -height;
    }
#endif
    return height > 0.0;
  }
#endif
  return true;
}

#if EFFECT_POLYGON
// Corner i of a polygon, m, from its centre along axis_x and axis_y, counter-clockwise seen from the lit side.
vec2 LightCorner(Light light, int i) {
  int k = light.turned ? light.corner_count - 1 - i : i;
  vec4 row = CornerRow(light.index, k / 2);
  vec2 corner = k % 2 == 0 ? vec2(row.x, row.y) : vec2(row.z, row.w);
  return light.turned ? vec2(-corner.x, corner.y) : corner;
}

// The same in the world.
vec3 CornerDirection(Light light, int i) {
  vec2 corner = LightCorner(light, i);
  return light.axis_x * corner.x + light.axis_y * corner.y;
}
#endif
