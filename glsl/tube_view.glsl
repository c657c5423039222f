#pragma once
// A tube, the outside of a cylinder whose ends are open, as a shaded point sees it: what lies between the lines where planes through the
// point touch it.
#include "directions.glsl"
#include "surface.glsl"

// m, from a tube's axis, prolonged, to a position.
vec3 FromTubeAxis(Light light, vec3 position) {
  vec3 from_center = position - light.center;
  vec3 across = from_center - light.axis_x * dot(from_center, light.axis_x);
  return across - light.axis_x * dot(across, light.axis_x);  // once more: far along the axis the first difference is all rounding
}

struct TubeView {
  vec3 toward;     // unit, from the axis to the point
  float distance;  // m, of the point from the axis
};

TubeView ViewTube(Light light, vec3 position) {
  vec3 across = FromTubeAxis(light, position);
  TubeView view;
  view.distance = sqrt(dot(across, across));
  view.toward = across / max(view.distance, 1e-30);
  return view;
}

// Whether the point sees any of the wall: from within the tube, prolonged, it sees none.
bool SeesTube(Light light, TubeView view) {
#if EFFECT_BEHIND
  return view.distance > light.half_size.y;
#else
  return true;
#endif
}

// The flat strip between the two lines of contact, a rectangle that faces the point: it covers what the tube covers but for what the
// rims' front halves, which bulge towards the point, add to it or take from it at the ends.
Light StripOfTube(Light light, TubeView view) {
  float ratio = min(light.half_size.y / max(view.distance, 1e-30), 1.0);
  Light strip = light;
  strip.shape = SHAPE_RECTANGLE;
  strip.center = light.center + view.toward * (light.half_size.y * ratio);
  strip.normal = view.toward;
  strip.axis_y = cross(view.toward, light.axis_x);
  strip.half_size = vec2(light.half_size.x, light.half_size.y * sqrt(max((1.0 - ratio) * (1.0 + ratio), 0.0)));
  strip.half_axis_y = strip.axis_y * strip.half_size.y;
  strip.area = 4.0 * strip.half_size.x * strip.half_size.y;
  strip.products = vec3(light.products.x, strip.half_size.y * strip.half_size.y, 2.0 * strip.half_size.x * strip.half_size.y);
  return strip;
}

// m, from the point along a unit direction to the wall; 0 where it meets none. to_center: m.
float DistanceToTube(Light light, TubeView view, vec3 to_center, vec3 direction) {
  // Of a t² + 2bt + c = 0 the lesser root: where the ray first meets the cylinder.
  float along = dot(direction, light.axis_x);
  vec3 across = direction - light.axis_x * along;
  float a = dot(across, across);
  float b = dot(across, view.toward) * view.distance;
  float c = (view.distance - light.half_size.y) * (view.distance + light.half_size.y);
  float d = b * b - a * c;
  if (b >= 0.0 || d <= 0.0) return 0.0;
  float t = c / (sqrt(d) - b);
  return abs(t * along - dot(to_center, light.axis_x)) <= light.half_size.x ? t : 0.0;
}

// The outline of what the point sees as a chain of chords: two lines of contact, and the rims' front halves between them in a few chords
// each, their inner corners moved out until the chain encloses what the arcs do. What is linear maps the four vectors.
struct TubeChain {
  vec3 center;     // m, from the shaded point, in the shading frame
  vec3 half_axis;  // m
  vec3 front;      // m, towards the point, as long as the radius
  vec3 side;       // m, as long as the radius
  float widest;    // rad, of a rim from its front to the line of contact
};

TubeChain ChainOfTube(Light light, TubeView view, vec3 position, vec3 tangent, vec3 bitangent, vec3 normal) {
  vec3 to_center = light.center - position;
  vec3 front = view.toward * light.half_size.y;
  vec3 side = cross(light.axis_x, front);
  TubeChain chain;
  chain.center = vec3(dot(tangent, to_center), dot(bitangent, to_center), dot(normal, to_center));
  chain.half_axis = vec3(dot(tangent, light.half_axis_x), dot(bitangent, light.half_axis_x), dot(normal, light.half_axis_x));
  chain.front = vec3(dot(tangent, front), dot(bitangent, front), dot(normal, front));
  chain.side = vec3(dot(tangent, side), dot(bitangent, side), dot(normal, side));
  chain.widest = Arccosine(light.half_size.y / max(view.distance, 1e-30));
  return chain;
}

// By how much the inner corners are moved out, g: of n chords each over the angle θ = 2 widest/n, two end on a line of contact, so that
// g sinθ + (n/2 − 1) g² sinθ = widest.
float ChainGrowth(float widest, float chords) {
  float inner = chords - 2.0;
  float sine = sin(2.0 * widest / chords);
  return (sqrt(1.0 + 2.0 * inner * widest / max(sine, 1e-30)) - 1.0) / inner;
}

// A corner at the angle (cosine, sine, each times the growth) on the rim at end = 1 or −1.
vec3 ChainCorner(TubeChain chain, vec2 place, float end) {
  return chain.center + chain.half_axis * end + chain.front * place.x + chain.side * place.y;
}
