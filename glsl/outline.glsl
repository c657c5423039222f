#pragma once
// The outline of a light's visible part on the sphere of directions, as arcs counter-clockwise seen from outside, and its form
// factor by Lambert's contour integral. Frame: the shading normal is z. The same mathematics as compare/closed_forms.cpp.
#include "directions.glsl"
#include "elliptic_cone.glsl"
#include "polar_rule.glsl"
#if EFFECT_TUBE
#include "tube_view.glsl"
#endif

// Of a convex polygon, one more than the light's own where the horizon cuts it, and one to spare; of a tube's 18 up to
// three more, since its outline is not convex.
#if EFFECT_TUBE
#define OUTLINE_CORNERS 22
#elif EFFECT_POLYGON
#define OUTLINE_CORNERS 10
#else
#define OUTLINE_CORNERS 6
#endif

// Chords between corners, then quarters of a cone's outline from angle begin to end.
struct Outline {
  vec3 corners[OUTLINE_CORNERS];  // unit; chord i runs from corner i to the next
  int corner_count;
  int chord_count;  // as many as corners, or 1 where a cone is cut by the horizon
  Cone cone;
  float begin;
  float end;
  int arc_count;  // chords and quarters; 0: nothing is visible
  float form_factor;
  bool mirror_inside;  // whether the light covers the mirror direction
};

// Whether a chord lies in the horizon and is long. Where a light's plane passes by the point its ends are opposite but for rounding, so
// that their sum points anywhere; the plane is known.
bool SpansHorizon(vec3 p, vec3 q, float cosine, float sine) { return p.z == 0.0 && q.z == 0.0 && cosine < sine; }

// Arc i of the outline. A quarter of a cone is measured from the nearer end of its long axis.
Arc OutlineArc(Outline outline, int i) {
  Arc arc;
  if (i < outline.chord_count) {
    vec3 p = outline.corners[i];
    vec3 q = outline.corners[i + 1 < outline.corner_count ? i + 1 : 0];
    vec3 middle = p + q;
    vec3 along = q - p;
    float cosine = sqrt(max(dot(middle, middle), 1e-14));
    float sine = sqrt(max(dot(along, along), 1e-14));
    arc.axis_2 = along / sine;
    arc.axis_1 = SpansHorizon(p, q, cosine, sine) ? vec3(arc.axis_2.y, -arc.axis_2.x, 0.0) : middle / cosine;
    arc.axis_3 = vec3(0.0);
    arc.sin_1 = 1.0;
    arc.sin_2 = 1.0;
    arc.cos_1 = 0.0;
    arc.cos_2 = 0.0;
    arc.t1 = sine / (2.0 + cosine);
    arc.t0 = -arc.t1;
  } else {
    float quarter = 0.5 * kPi;
    float low = floor(outline.begin / quarter) + float(i - outline.chord_count);
    float zero = floor(0.5 * (low + 1.0));  // half turns from axis_1
    float sense = 1.0 - 2.0 * (zero - 2.0 * floor(0.5 * zero));
    float h0 = 0.5 * (max(outline.begin, low * quarter) - zero * kPi);
    float h1 = 0.5 * (min(outline.end, (low + 1.0) * quarter) - zero * kPi);
    arc.axis_1 = outline.cone.axis_1 * sense;
    arc.axis_2 = outline.cone.axis_2 * sense;
    arc.axis_3 = outline.cone.axis_3;
    arc.sin_1 = outline.cone.sin_1;
    arc.sin_2 = outline.cone.sin_2;
    arc.cos_1 = outline.cone.cos_1;
    arc.cos_2 = outline.cone.cos_2;
    arc.t0 = sin(h0) / cos(h0);
    arc.t1 = sin(h1) / cos(h1);
  }
  return arc;
}

// Adds what lies at or above the horizon of the side from p, its end q left out, m, local [Sutherland and Hodgman 1974].
void AddSide(vec3 p, vec3 q, INOUT(Outline) outline) {
  if (p.z >= 0.0) {
    outline.corners[outline.corner_count] = p;
    outline.corner_count = outline.corner_count + 1;
  }
  if ((p.z > 0.0 && q.z < 0.0) || (p.z < 0.0 && q.z > 0.0)) {
    vec3 cut = p + (q - p) * (p.z / (p.z - q.z));
    outline.corners[outline.corner_count] = vec3(cut.x, cut.y, 0.0);
    outline.corner_count = outline.corner_count + 1;
  }
}

// The chords between the corners of the added sides, and their form factor; nothing of fewer than three. Corners nearer than 1e-6 are
// one, since no float tells the direction of a chord between them.
void CloseChords(vec3 mirror, INOUT(Outline) outline) {
  int count = 0;
  vec3 before = vec3(0.0);
  vec3 first = before;
  for (int i = 0; i < outline.corner_count; ++i) {
    vec3 p = outline.corners[i];
    p *= inversesqrt(max(dot(p, p), 1e-30));
    vec3 along = p - before;
    if (dot(along, along) > 1e-12) {
      first = count == 0 ? p : first;
      outline.corners[count] = p;
      ++count;
      before = p;
    }
  }
  vec3 closing = before - first;
  if (dot(closing, closing) <= 1e-12) --count;
  if (count >= 3) {
    outline.corner_count = count;
    outline.chord_count = count;
    outline.arc_count = count;
    outline.mirror_inside = true;
    float sum = 0.0;
    for (int i = 0; i < count; ++i) {
      vec3 p = outline.corners[i];
      vec3 q = outline.corners[i + 1 < count ? i + 1 : 0];
      vec3 middle = p + q;
      vec3 along = q - p;
      float cosine = length(middle);
      float sine = length(along);
      vec3 plane = SpansHorizon(p, q, cosine, sine) ? vec3(0.0, 0.0, cosine * sine) : cross(middle, along);
      sum += PositiveAngle(sine, cosine) * plane.z / max(cosine * sine, 1e-30);
      outline.mirror_inside = outline.mirror_inside && dot(plane, mirror) > 0.0;
    }
    outline.form_factor = sum / kPi;
  }
}

// center, half_a, half_b: m, local; the light faces the point. Corners are counter-clockwise seen from outside.
void RectangleOutline(vec3 center, vec3 half_a, vec3 half_b, vec3 mirror, INOUT(Outline) outline) {
  // Sutherland and Hodgman at the horizon; a convex quadrilateral keeps at most five corners.
  for (int i = 0; i < 4; ++i) {
    float a = i < 2 ? -1.0 : 1.0;
    float b = (i == 1 || i == 2) ? 1.0 : -1.0;
    float c = (i == 0 || i == 3) ? -1.0 : 1.0;
    float d = (i == 0 || i == 1) ? 1.0 : -1.0;
    vec3 p = center + a * half_a + b * half_b;
    vec3 q = center + c * half_a + d * half_b;
    AddSide(p, q, outline);
  }
  CloseChords(mirror, outline);
}

#if EFFECT_POLYGON
// The same of a polygon: center, x_axis and y_axis are local.
void PolygonOutline(Light light, vec3 center, vec3 x_axis, vec3 y_axis, vec3 mirror, INOUT(Outline) outline) {
  vec2 first = LightCorner(light, 0);
  vec3 p = center + x_axis * first.x + y_axis * first.y;
  for (int i = light.corner_count - 1; i >= 0; --i) {  // clockwise seen from the lit side
    vec2 corner = LightCorner(light, i);
    vec3 q = center + x_axis * corner.x + y_axis * corner.y;
    AddSide(p, q, outline);
    p = q;
  }
  CloseChords(mirror, outline);
}
#endif

// center: m; normal: unit, towards the origin's side; radius: m. In the plane of centre and normal c = (ρ, h), and the cone's
// dual matrix c cᵀ − R²(1 − n nᵀ) has there the eigenvalues μ > 0 and −R²h²/μ; across it −R².
Cone DiskCone(vec3 center, vec3 normal, float radius) {
  // Nearer the plane than this the cone is all rounding.
  float h = max(-dot(center, normal), 1e-6 * radius);
  vec3 in_plane = center + normal * h;
  in_plane -= normal * dot(in_plane, normal);
  float rho = length(in_plane);
  vec3 radial = AnyPerpendicular(normal);
  if (rho > 1e-6 * (radius + h)) {
    radial = in_plane / rho;
  }
  float difference = (rho - radius) * (rho + radius);
  float mean = 0.5 * (difference + h * h);
  float root = sqrt(mean * mean + radius * radius * h * h);
  float mu = mean > 0.0 ? mean + root : radius * radius * h * h / (root - mean);
  float a = rho > radius ? 0.5 * (difference - h * h) + root : rho * h;
  float b = rho > radius ? rho * h : mu - difference;
  float inv = inversesqrt(max(a * a + b * b, 1e-30));
  Cone cone;
  cone.axis_3 = (radial * a - normal * b) * inv;
  cone.axis_1 = cross(radial, normal);
  cone.axis_2 = cross(cone.axis_3, cone.axis_1);
  float inv_1 = inversesqrt(radius * radius + mu);
  float rm = sqrt(mu);
  float inv_2 = inversesqrt(radius * radius * h * h / mu + mu);
  cone.sin_1 = radius * inv_1;
  cone.cos_1 = rm * inv_1;
  cone.sin_2 = radius * h / rm * inv_2;
  cone.cos_2 = rm * inv_2;
  return cone;
}

// center: m; the origin is outside.
Cone SphereCone(vec3 center, float radius) {
  Cone cone;
  float distance2 = dot(center, center);
  float inv = inversesqrt(distance2);
  cone.axis_3 = center * inv;
  // Towards the highest point of the outline; any direction serves where the centre is overhead.
  vec3 up = vec3(0.0, 0.0, 1.0) - cone.axis_3 * cone.axis_3.z;
  float up2 = dot(up, up);
  cone.axis_1 = AnyPerpendicular(cone.axis_3);
  if (up2 > 1e-10) {
    cone.axis_1 = up * inversesqrt(up2);
  }
  cone.axis_2 = cross(cone.axis_3, cone.axis_1);
  float d = distance2 * inv;
  cone.sin_1 = radius * inv;
  cone.cos_1 = sqrt((d - radius) * (d + radius)) * inv;
  cone.sin_2 = cone.sin_1;
  cone.cos_2 = cone.cos_1;
  return cone;
}

// atanh(y)/κ and atan(y)/κ with y = κx, continued to κ = 0: the series' next term is 2e-8 of the first at 0.1.
float AtanhOver(float kappa, float x) {
  float y = kappa * x;
  float y2 = y * y;
  if (abs(y) < 0.1) {
    return x * (1.0 + y2 * (1.0 / 3.0 + y2 * (1.0 / 5.0 + y2 * (1.0 / 7.0 + y2 / 9.0))));
  }
  return 0.5 * log((1.0 + y) / (1.0 - y)) / kappa;
}
float AtanOver(float kappa, float x) {
  float y = kappa * x;
  float y2 = y * y;
  if (abs(y) < 0.1) {
    return x * (1.0 + y2 * (-1.0 / 3.0 + y2 * (1.0 / 5.0 + y2 * (-1.0 / 7.0 + y2 / 9.0))));
  }
  return Angle(y, 1.0) / kappa;
}

// A point of the outline where it meets the horizon: the ellipse's own angle ψ', cosine and sine.
vec3 ConeDirection(Cone cone, float cos_psi, float sin_psi) {
  float x1 = cone.cos_1 * cos_psi;
  float x2 = cone.cos_2 * sin_psi;
  return cone.axis_1 * (cone.sin_1 * cos_psi) + cone.axis_2 * (cone.sin_2 * sin_psi) + cone.axis_3 * sqrt(x1 * x1 + x2 * x2);
}

void ConeOutline(Cone cone, vec3 mirror, INOUT(Outline) outline) {
  // Height over the outline, times positive factors: m + a cosψ' + b sinψ'; tanψ = tanψ'·cos_1/cos_2.
  float m = cone.axis_3.z * cone.cos_1 * cone.cos_2;
  float a = cone.axis_1.z * cone.sin_1 * cone.cos_2;
  float b = cone.axis_2.z * cone.sin_2 * cone.cos_1;
  float amplitude = sqrt(a * a + b * b);
  if (m > -amplitude) {
    float begin = 0.0;
    float end = 2.0 * kPi;
    bool crossing = m < amplitude;
    if (crossing) {
      float x = m / amplitude;
      float y = sqrt(max((1.0 - x) * (1.0 + x), 0.0));
      // top ± half as complex products, half = acos(−x).
      float top_cos = a / amplitude;
      float top_sin = b / amplitude;
      float begin_cos = -top_cos * x + top_sin * y;
      float begin_sin = -top_sin * x - top_cos * y;
      float end_cos = -top_cos * x - top_sin * y;
      float end_sin = -top_sin * x + top_cos * y;
      begin = Angle(begin_sin * cone.cos_1, begin_cos * cone.cos_2);
      end = Angle(end_sin * cone.cos_1, end_cos * cone.cos_2);
      end = end <= begin ? end + 2.0 * kPi : end;
      vec3 p = ConeDirection(cone, cos(end), sin(end));
      vec3 q = ConeDirection(cone, cos(begin), sin(begin));
      p = vec3(p.x, p.y, 0.0) * inversesqrt(p.x * p.x + p.y * p.y);
      q = vec3(q.x, q.y, 0.0) * inversesqrt(q.x * q.x + q.y * q.y);
      float chord = Angle(p.x * q.y - p.y * q.x, p.x * q.x + p.y * q.y);
      float tan2 = (cone.sin_1 * cone.cos_2 - cone.sin_2 * cone.cos_1) * (cone.sin_1 * cone.cos_2 + cone.sin_2 * cone.cos_1);
      float tangents = sqrt(max(tan2, 0.0)) / (cone.cos_1 * cone.cos_2);  // √(tan_1² − tan_2²)
      float kappa = tangents * cone.cos_1;
      float j = tangents * cone.cos_2;
      float i1 = cone.sin_2 / cone.cos_2 * cone.cos_1 * cone.cos_1 * (AtanhOver(kappa, end_sin) - AtanhOver(kappa, begin_sin));
      float i2 = cone.sin_1 / cone.cos_1 * cone.cos_2 * cone.cos_2 * (AtanOver(j, begin_cos) - AtanOver(j, end_cos));
      float arc = -cone.axis_1.z * i1 - cone.axis_2.z * i2 + cone.axis_3.z * cone.sin_1 * cone.sin_2 * (end - begin);
      outline.corners[0] = p;
      outline.corners[1] = q;
      outline.corner_count = 2;
      outline.chord_count = 1;
      outline.form_factor = (arc + chord) / (2.0 * kPi);
    } else {
      outline.form_factor = cone.axis_3.z * cone.sin_1 * cone.sin_2;
    }
    // Quarters between the ends of the axes; the first and the last may be short.
    float quarter = 0.5 * kPi;
    outline.cone = cone;
    outline.begin = begin;
    outline.end = end;
    outline.arc_count = outline.chord_count + int(ceil(end / quarter) - floor(begin / quarter));
    float m1 = dot(mirror, cone.axis_1) * cone.cos_1 / cone.sin_1;
    float m2 = dot(mirror, cone.axis_2) * cone.cos_2 / cone.sin_2;
    float m3 = dot(mirror, cone.axis_3);
    outline.mirror_inside = m3 > 0.0 && m1 * m1 + m2 * m2 < m3 * m3;
  }
}

#if EFFECT_TUBE
// What the point sees of a tube, its rims as chains of 8 chords.
void TubeOutline(TubeChain chain, vec3 mirror, INOUT(Outline) outline) {
  float growth = ChainGrowth(chain.widest, 8.0);
  vec3 p = ChainCorner(chain, vec2(cos(chain.widest), -sin(chain.widest)), -1.0);
  for (int i = 0; i < 18; ++i) {
    int step = i < 9 ? i : 17 - i;
    float angle = chain.widest * (0.25 * float(step) - 1.0);
    float grown = step == 0 || step == 8 ? 1.0 : growth;
    vec3 q = ChainCorner(chain, vec2(grown * cos(angle), grown * sin(angle)), i < 9 ? 1.0 : -1.0);
    AddSide(p, q, outline);
    p = q;
  }
  CloseChords(mirror, outline);
}
#endif
