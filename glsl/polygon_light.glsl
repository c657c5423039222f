#pragma once
// A convex polygon light, side by side, its corners read from the light block as they are needed. After an "edge" and lights.glsl.
#include "ltc.glsl"
#include "streamed_outline.glsl"

// As a shaded point sees it: corner = center + axis_x · x + axis_y · y. What is linear maps the three.
struct PolygonView {
  vec3 center;  // m, from the shaded point; the centroid
  vec3 axis_x;
  vec3 axis_y;
};

// In the shading frame.
PolygonView ViewPolygon(Light light, vec3 position, ShadingFrame frame) {
  vec3 to_center = light.center - position;
  PolygonView view;
  view.center = vec3(dot(frame.tangent, to_center), dot(frame.bitangent, to_center), dot(frame.normal, to_center));
  view.axis_x = vec3(dot(frame.tangent, light.axis_x), dot(frame.bitangent, light.axis_x), dot(frame.normal, light.axis_x));
  view.axis_y = vec3(dot(frame.tangent, light.axis_y), dot(frame.bitangent, light.axis_y), dot(frame.normal, light.axis_y));
  return view;
}

PolygonView TransformPolygon(vec4 m, PolygonView view) {
  return PolygonView(LtcTransform(m, view.center), LtcTransform(m, view.axis_x), LtcTransform(m, view.axis_y));
}

vec3 PolygonCorner(Light light, PolygonView view, int i) {
  vec2 corner = LightCorner(light, i);
  return view.center + view.axis_x * corner.x + view.axis_y * corner.y;
}

// The rectangle that the corners reach: what is small against its distance is taken as one of the polygon's area about the centroid,
// as in polygon.glsl and for its reasons.
bool IsSmallPolygon(Light light, PolygonView view) {
  return IsSmallParallelogram(view.center, view.axis_x * light.half_size.x, view.axis_y * light.half_size.y);
}
float SmallPolygonShare(Light light) { return light.area / (2.0 * light.products.z); }

// Σ θ (v_i × v_{i+1})/|v_i × v_{i+1}| over the sides, clockwise seen from the lit side: kTurn times the vector form factor of the whole polygon.
vec3 PolygonSides(Light light, PolygonView view, bool lambert) {
  vec3 sum = vec3(0.0);
  vec4 from = EdgeVertex(PolygonCorner(light, view, 0));
  for (int i = light.corner_count - 1; i >= 0; --i) {
    vec4 to = EdgeVertex(PolygonCorner(light, view, i));
    sum += EdgeVector(from, to, lambert);
    from = to;
  }
  return sum;
}

// The vector form factor of the whole polygon.
vec3 PolygonVector(Light light, PolygonView view, bool lambert) {
  if (!Lit(!IsSmallPolygon(light, view))) {
    return SmallRectangleVector(view.center, view.axis_x * light.half_size.x, view.axis_y * light.half_size.y) * SmallPolygonShare(light);
  }
  return PolygonSides(light, view, lambert) * (1.0 / kTurn);
}

// The vector form factor of what is above z = 0, its z the form factor for a clamped cosine about +z. Side by side,
// whatever "clip" says of rectangles.
vec3 ClippedPolygon(Light light, PolygonView view, bool lambert) {
  if (!Lit(!IsSmallPolygon(light, view))) {
    return ClippedSmallRectangle(view.center, view.axis_x * light.half_size.x, view.axis_y * light.half_size.y) * SmallPolygonShare(light);
  }
  StreamedOutline outline = NoOutline();
  vec3 from = PolygonCorner(light, view, 0);
  for (int i = light.corner_count - 1; i >= 0; --i) {
    vec3 to = PolygonCorner(light, view, i);
    outline = StreamSide(outline, from, to, lambert);
    from = to;
  }
  return CloseOutline(outline);
}

// The same where nothing is clipped: what is below subtracts.
vec3 UnclippedPolygon(Light light, PolygonView view, bool lambert) {
  vec3 f = PolygonVector(light, view, lambert);
  return vec3(f.x, f.y, AsFormFactor(f.z));
}
