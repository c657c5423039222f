// What a pixel sees: the triangle that covers it, cut by the ray through the pixel's centre, in double. The rasteriser's
// interpolation would lose digits on triangles that reach behind the camera, and its own error would be in every
// technique's input; here positions are right to float rounding.

layout(location = 0) out vec4 out_position;    // m, world; w: what it is, see `kind`
layout(location = 1) out vec4 out_normal;      // unit shading normal; w: artist's roughness
layout(location = 2) out vec4 out_base_color;  // linear sRGB; w: metalness

// glTF's vertex: position, normal, tangent (w: the bitangent's sign), texture coordinates. 12 floats, as scenes/scene.h.
layout(std430, binding = 0) readonly buffer Vertices { float vertices[]; };
layout(std430, binding = 1) readonly buffer Indices { uint indices[]; };

uniform dvec3 view_position;       // m, world
uniform dvec3 ray_forward;         // unit: a ray is forward + x · right + y · up, x and y in [−1, 1]
uniform dvec3 ray_right;
uniform dvec3 ray_up;
uniform vec2 size;                 // pixels
uniform float near;                // m
uniform float kind;                // 1 surface, ±(2 + i) emitter i
uniform vec3 base_color;
uniform vec2 roughness;            // at texture coordinate u = 0 and 1
uniform float metalness;
uniform float normal_scale;
uniform bool has_base_color_texture;
uniform bool has_metallic_roughness_texture;
uniform bool has_normal_texture;
layout(binding = 0) uniform sampler2D base_color_texture;
layout(binding = 1) uniform sampler2D metallic_roughness_texture;
layout(binding = 2) uniform sampler2D normal_texture;

uint VertexOffset(int corner) { return 12u * indices[3 * gl_PrimitiveID + corner]; }

dvec3 Vec3At(uint i) { return dvec3(vertices[i], vertices[i + 1u], vertices[i + 2u]); }
dvec2 Vec2At(uint i) { return dvec2(vertices[i], vertices[i + 1u]); }

void main() {
  uint a = VertexOffset(0);
  uint b = VertexOffset(1);
  uint c = VertexOffset(2);

  // Barycentric weights of b and c where the ray meets the triangle's plane [Möller & Trumbore 1997]. Row 0 is the top.
  dvec2 ndc = dvec2(2.0 * gl_FragCoord.x / size.x - 1.0, 1.0 - 2.0 * gl_FragCoord.y / size.y);
  dvec3 ray = ray_forward + ndc.x * ray_right + ndc.y * ray_up;
  dvec3 corner = Vec3At(a);
  dvec3 edge_b = Vec3At(b) - corner;
  dvec3 edge_c = Vec3At(c) - corner;
  dvec3 from_corner = view_position - corner;
  dvec3 ray_cross_c = cross(ray, edge_c);
  double determinant = dot(edge_b, ray_cross_c);
  dvec2 hit = dvec2(1.0lf / 3.0lf);
  if (determinant != 0.0lf) {
    hit = dvec2(dot(from_corner, ray_cross_c), dot(ray, cross(from_corner, edge_b))) / determinant;
  }
  // Coverage is decided on a grid of 1/256 pixel, so that a centre may lie just outside: seen edge-on, far outside.
  dvec2 weight = clamp(hit, 0.0lf, 1.0lf);
  weight.y = min(weight.y, 1.0lf - weight.x);

  dvec3 position = corner + weight.x * edge_b + weight.y * edge_c;
  gl_FragDepth = near / float(dot(position - view_position, ray_forward));

  dvec3 normal_sum = (1.0lf - weight.x - weight.y) * Vec3At(a + 3u) + weight.x * Vec3At(b + 3u) + weight.y * Vec3At(c + 3u);
  double normal_length = length(normal_sum);
  dvec3 normal = normal_length > 0.0lf ? normal_sum / normal_length : normalize(cross(edge_b, edge_c));

  dvec2 uv_a = Vec2At(a + 10u);
  dvec2 uv_b = Vec2At(b + 10u) - uv_a;
  dvec2 uv_c = Vec2At(c + 10u) - uv_a;
  vec2 uv = vec2(uv_a + weight.x * uv_b + weight.y * uv_c);
  vec2 uv_unclamped = vec2(uv_a + hit.x * uv_b + hit.y * uv_c);  // linear over the quad, as derivatives need it
  vec2 uv_dx = dFdx(uv_unclamped);
  vec2 uv_dy = dFdy(uv_unclamped);

  vec3 color = base_color;
  // This form of the ramp gives a constant roughness back bit by bit.
  float rough = roughness.x + (roughness.y - roughness.x) * clamp(uv.x, 0.0, 1.0);
  float metal = metalness;
  if (has_base_color_texture) color *= textureGrad(base_color_texture, uv, uv_dx, uv_dy).rgb;
  if (has_metallic_roughness_texture) {
    vec4 texel = textureGrad(metallic_roughness_texture, uv, uv_dx, uv_dy);
    rough *= texel.g;
    metal *= texel.b;
  }
  if (has_normal_texture) {
    vec3 texel = textureGrad(normal_texture, uv, uv_dx, uv_dy).xyz * 2.0 - 1.0;
    vec3 tangent = (1.0 - float(weight.x) - float(weight.y)) * vec3(Vec3At(a + 6u)) +
                   float(weight.x) * vec3(Vec3At(b + 6u)) + float(weight.y) * vec3(Vec3At(c + 6u));
    vec3 bitangent = cross(vec3(normal), tangent) * vertices[a + 9u];
    vec3 mapped = texel.x * normal_scale * tangent + texel.y * normal_scale * bitangent + texel.z * vec3(normal);
    if (dot(mapped, mapped) > 0.0) normal = normalize(dvec3(mapped));
  }

  out_position = vec4(vec3(position), kind);
  out_normal = vec4(vec3(normal), clamp(rough, 0.0, 1.0));
  out_base_color = vec4(color, clamp(metal, 0.0, 1.0));
}
