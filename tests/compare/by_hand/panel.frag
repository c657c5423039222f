// A glossy grey floor under one white rectangle that is wholly above it, by linearly transformed cosines [Heitz et al. 2016]: written for that
// scene alone. The tables and the polynomial are ours.
#include "platform"
#include "lit.glsl"

// Angle over sine from the acute angle's cosine.
float Polynomial(float y) {
  return 1.57079633 + y * (-0.999694194 + y * (0.77903913 + y * (-0.620806772 + y * (0.426115597 + y * (-0.199208057 + y * 0.0437609992)))));
}

float Edge(float d, float length2s) {
  float i = inversesqrt(length2s);
  return i * Polynomial(abs(d) * i);
}

float Mirrored(float acute, float d, float line2) { return d < 0.0 ? 3.14159265 * inversesqrt(line2) - acute : acute; }

// The light's own form factor: in its axes, from the corner (x, y, z) and the opposite one.
float FormFactor(vec3 to_center, vec3 normal) {
  vec3 n = vec3(dot(normal, light_rows[2].xyz), dot(normal, light_rows[3].xyz), dot(normal, light_rows[1].xyz));
  vec2 size = vec2(light_rows[2].w, light_rows[3].w);
  vec2 middle = vec2(dot(to_center, light_rows[2].xyz), dot(to_center, light_rows[3].xyz));
  float z = dot(to_center, light_rows[1].xyz);
  vec2 high = middle + size;
  vec2 low = middle - size;
  float z2 = z * z;
  vec2 high2 = high * high + z2;
  vec2 low2 = low * low + z2;
  float l00 = low.x * low.x + low2.y;
  float l10 = high.x * high.x + low2.y;
  float l11 = high.x * high.x + high2.y;
  float l01 = low.x * low.x + high2.y;
  float d0 = low.x * high.x + low2.y;
  float d1 = low.y * high.y + high2.x;
  float d2 = low.x * high.x + high2.y;
  float d3 = low.y * high.y + low2.x;
  vec2 side = 2.0 * size;
  float t0 = side.x * Edge(d0, l00 * l10);
  float t1 = side.y * Edge(d1, l10 * l11);
  float t2 = side.x * Edge(d2, l11 * l01);
  float t3 = side.y * Edge(d3, l01 * l00);
  if (min(min(d0, d1), min(d2, d3)) < 0.0) {
    t0 = Mirrored(t0, d0, low2.y);
    t1 = Mirrored(t1, d1, high2.x);
    t2 = Mirrored(t2, d2, high2.y);
    t3 = Mirrored(t3, d3, low2.x);
  }
  float sum = t0 * (n.y * z - n.z * low.y) - t2 * (n.y * z - n.z * high.y) + t1 * (n.z * high.x - n.x * z) - t3 * (n.z * low.x - n.x * z);
  return clamp(sum * (-0.5 / 3.14159265), 0.0, 1.0);
}

// The vector form factor of a parallelogram cut by z = 0.
vec3 LobeVector(vec3 center, vec3 half_a, vec3 half_b) {
  float sign_a = half_a.z < 0.0 ? -2.0 : 2.0;
  float sign_b = half_b.z < 0.0 ? -2.0 : 2.0;
  vec3 a = half_a * sign_a;
  vec3 b = half_b * sign_b;
  vec3 c = center + 0.5 * (a + b);
  if (c.z <= 0.0) return vec3(0.0);
  bool above = c.z > a.z + b.z;
  vec4 k = vec4(1.0);
  if (!above) {
    float inverse_a = 1.0 / max(a.z, 1e-30);
    float inverse_b = 1.0 / max(b.z, 1e-30);
    k = clamp(vec4((c.z - b.z) * inverse_a, (c.z - b.z) * inverse_b + 1.0, (c.z - a.z) * inverse_a + 1.0, (c.z - a.z) * inverse_b), 0.0, 1.0);
  }
  vec3 v1 = c - k.y * b;
  vec3 v0 = v1 - k.x * a;
  vec3 v3 = c - k.z * a;
  vec3 v4 = v3 - k.w * b;
  vec3 c_a = cross(c, a);
  vec3 c_b = cross(c, b);
  vec3 a_b = cross(a, b);
  vec3 line0 = c_a + k.y * a_b;
  vec3 line3 = c_b - k.z * a_b;
  float d0 = dot(v0, v1);
  float d1 = dot(v1, c);
  float d2 = dot(c, v3);
  float d3 = dot(v3, v4);
  float l0 = dot(v0, v0);
  float l1 = dot(v1, v1);
  float lc = dot(c, c);
  float l3 = dot(v3, v3);
  float l4 = dot(v4, v4);
  float t0 = k.x * Edge(d0, l0 * l1);
  float t1 = k.y * Edge(d1, l1 * lc);
  float t2 = k.z * Edge(d2, lc * l3);
  float t3 = k.w * Edge(d3, l3 * l4);
  if (min(min(d0, d1), min(d2, d3)) < 0.0) {
    t0 = Mirrored(t0, d0, dot(line0, line0));
    t1 = Mirrored(t1, d1, dot(c_b, c_b));
    t2 = Mirrored(t2, d2, dot(c_a, c_a));
    t3 = Mirrored(t3, d3, dot(line3, line3));
  }
  float closing = 0.0;
  if (!above) {
    float d = dot(v4, v0);
    float acute = abs((v4.x - v0.x) * v0.y - (v4.y - v0.y) * v0.x) * Edge(d, l4 * l0);
    closing = d < 0.0 ? 3.14159265 - acute : acute;
  }
  float scale = sign_a * sign_b * (-0.125 / 3.14159265);
  vec3 f = ((t0 - t2) * scale) * c_a + ((t1 - t3) * scale) * c_b + ((t0 * k.y + t3 * k.z) * scale) * a_b;
  return vec3(f.xy, clamp(f.z + closing * (0.5 / 3.14159265), 0.0, 1.0));
}

vec3 Transform(vec4 m, vec3 v) { return vec3(m.x * v.x + m.z * v.z, v.y, m.y * v.x + m.w * v.z); }

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float diffuse = 0.0;
  float specular = 0.0;
  vec4 position = texelFetch(gbuffer_position, pixel, 0);
  if (Lit(position.w == 1.0)) {
    vec4 normal_roughness = texelFetch(gbuffer_normal, pixel, 0);
    vec3 normal = normal_roughness.xyz;
    float albedo = texelFetch(gbuffer_base_color, pixel, 0).x;
    vec3 to_view = normalize(view_position - position.xyz);
    vec3 to_center = light_rows[0].xyz - position.xyz;
    float radiance = light_rows[6].x;

    float n_dot_v = dot(normal, to_view);
    vec3 tangent = to_view - normal * n_dot_v;
    float sine2 = dot(tangent, tangent);
    float sine = min(sqrt(sine2), 1.0);
    if (sine2 < 1e-8) {  // any will do
      tangent = abs(normal.x) < 0.5 ? vec3(0.0, -normal.z, normal.y) : vec3(normal.z, 0.0, -normal.x);
      sine2 = dot(tangent, tangent);
    }
    tangent *= inversesqrt(sine2);
    vec3 bitangent = cross(normal, tangent);
    n_dot_v = clamp(n_dot_v, 8e-4, 1.0);

    vec2 uv = vec2(normal_roughness.w, min(sine * inversesqrt(1.0 + n_dot_v) * 1.00884173, 1.0)) * (63.0 / 64.0) + 0.5 / 64.0;
    vec4 terms = textureLod(table_ltc_terms, uv, 0.0);
    vec4 m = textureLod(table_ltc_matrix, uv, 0.0);
    m = m * n_dot_v + vec4(-m.zw, m.xy) * sine;

    diffuse = albedo * radiance * FormFactor(to_center, normal);

    vec3 half_a = light_rows[4].xyz;
    vec3 half_b = light_rows[5].xyz;
    vec3 f = LobeVector(Transform(m, vec3(dot(tangent, to_center), dot(bitangent, to_center), dot(normal, to_center))),
                        Transform(m, vec3(dot(tangent, half_a), dot(bitangent, half_a), dot(normal, half_a))),
                        Transform(m, vec3(dot(tangent, half_b), dot(bitangent, half_b), dot(normal, half_b))));
    // Schlick's term towards the light: the vector brought back from the lobe's space.
    vec3 to_light = vec3(m.w * f.x - m.z * f.z, (m.x * m.w - m.y * m.z) * f.y, m.x * f.z - m.y * f.x);
    float v_dot_l = (sine * to_light.x + n_dot_v * to_light.z) * inversesqrt(max(dot(to_light, to_light), 1e-30));
    float g = 1.0 - sqrt(clamp(0.5 + 0.5 * v_dot_l, 0.0, 1.0));
    float weight = mix(g * g * g * g * g * terms.x, terms.y, f.z);
    specular = (0.04 * (terms.x - weight) + weight) * radiance * f.z;
  }
  out_diffuse = vec4(vec3(diffuse), 1.0);
  out_specular = vec4(vec3(specular), 1.0);
}
