// What a pixel sees: the triangle that covers it, cut by the ray through the pixel's centre, in double. The rasteriser's
// interpolation would lose digits on triangles that reach behind the camera, and its own error would be in every
// technique's input; here positions are right to float rounding.

layout(location = 0) out vec4 out_position;    // m, world; w: what it is, see Draw
layout(location = 1) out vec4 out_normal;      // unit shading normal; w: artist's roughness
layout(location = 2) out vec4 out_base_color;  // linear sRGB; w: metalness, or below 0 a non-metal whose specular lobe weighs 1 + w

#if EFFECT_APERTURE
layout(location = 3) out vec4 out_aperture;       // caps, each a unit axis; w: versine
layout(location = 4) out vec4 out_first_region;
layout(location = 5) out vec4 out_second_region;
layout(location = 6) out vec4 out_blocked;
#endif

// One draw, as gbuffer.cpp writes it.
struct Draw {
  vec4 base_color_metalness;
  vec2 roughness;            // at texture coordinate u = 0 and 1
  float normal_scale;
  float kind;                // 1 surface, ±(2 + i) emitter i
  ivec4 textures;            // x: the set of textures that it needs; y, z, w: whether that set has colour, roughness, normals
};

struct Corner {
  vec3 position, normal;
  vec4 tangent;  // w: the bitangent's sign
  vec2 uv;
};

// Buffers as textures: a software rasteriser reads these for several pixels at once, storage blocks a number at a time.
layout(binding = 4) uniform samplerBuffer vertices;  // a Corner in three texels
layout(binding = 5) uniform usamplerBuffer indices;
layout(binding = 6) uniform samplerBuffer draws;     // a Draw in three texels
#if EFFECT_APERTURE
layout(binding = 7) uniform samplerBuffer apertures;  // a vertex's four caps: unit axis, versine
#endif

layout(binding = 0) uniform usampler2D coverage;
layout(binding = 1) uniform sampler2D base_color_texture;
layout(binding = 2) uniform sampler2D metallic_roughness_texture;  // glTF: green × roughness, blue × metalness
#if EFFECT_NORMAL_MAP
layout(binding = 3) uniform sampler2D normal_texture;              // glTF: tangent space, y up
#endif
uniform int texture_set;           // that is bound; pixels that need another are left alone
uniform dvec3 view_position;       // m, world
uniform dvec3 ray_forward;         // unit: a ray is forward + x · right + y · up, x and y in [−1, 1]
uniform dvec3 ray_right;
uniform dvec3 ray_up;
uniform vec2 size;                 // pixels

Draw DrawAt(uint i) {
  int at = 3 * int(i);
  vec4 ramp = texelFetch(draws, at + 1);
  return Draw(texelFetch(draws, at), ramp.xy, ramp.z, ramp.w, floatBitsToInt(texelFetch(draws, at + 2)));
}

Corner CornerAt(uint i) {
  int at = 3 * int(texelFetch(indices, int(i)).x);
  vec4 a = texelFetch(vertices, at);
  vec4 b = texelFetch(vertices, at + 1);
  vec4 c = texelFetch(vertices, at + 2);
  return Corner(a.xyz, vec3(a.w, b.xy), vec4(b.zw, c.xy), c.zw);
}

#if EFFECT_APERTURE
vec4 CapAt(uint i, int cap) { return texelFetch(apertures, 4 * int(texelFetch(indices, int(i)).x) + cap); }

// A cap between the corners' own. Axes count by `by_size` of what their caps cover: an empty cap has no direction to speak of.
vec4 MixCaps(uint first, vec3 weight, int cap, bool by_size, vec3 otherwise) {
  vec4 a = CapAt(first, cap);
  vec4 b = CapAt(first + 1u, cap);
  vec4 c = CapAt(first + 2u, cap);
  vec3 axis = by_size ? weight.x * a.w * a.xyz + weight.y * b.w * b.xyz + weight.z * c.w * c.xyz
                      : weight.x * a.xyz + weight.y * b.xyz + weight.z * c.xyz;
  float axis_length = length(axis);
  return vec4(axis_length > 0.0 ? axis / axis_length : otherwise, weight.x * a.w + weight.y * b.w + weight.z * c.w);
}
#endif

// A triangle: one corner and the edges to the two others.
struct Triangle {
  dvec3 corner, edge_b, edge_c;
};

// The ray through a point of the picture, in pixels from the upper left; not unit.
dvec3 RayThrough(dvec2 pixel) {
  dvec2 ndc = dvec2(2.0lf * pixel.x / size.x - 1.0lf, 1.0lf - 2.0lf * pixel.y / size.y);
  return ray_forward + ndc.x * ray_right + ndc.y * ray_up;
}

// Barycentric weights of b and c where the ray meets the triangle's plane [Möller & Trumbore 1997].
dvec2 RayHit(Triangle triangle, dvec3 ray) {
  dvec3 from_corner = view_position - triangle.corner;
  dvec3 ray_cross_c = cross(ray, triangle.edge_c);
  double determinant = dot(triangle.edge_b, ray_cross_c);
  if (determinant == 0.0lf) return dvec2(1.0lf / 3.0lf);  // edge-on: the centroid will do
  return dvec2(dot(from_corner, ray_cross_c), dot(ray, cross(from_corner, triangle.edge_b))) / determinant;
}

// The share of the way along an edge, from the corner `from`, where it is nearest to the ray; 0 to 1.
double NearestOnEdge(dvec3 from, dvec3 edge, dvec3 ray) {
  dvec3 a = cross(from - view_position, ray);
  dvec3 e = cross(edge, ray);
  double length2 = dot(e, e);
  return length2 > 0.0lf ? clamp(-dot(a, e) / length2, 0.0lf, 1.0lf) : 0.0lf;
}

double DistanceToRay(Triangle triangle, dvec2 weight, dvec3 ray) {
  dvec3 point = triangle.corner + weight.x * triangle.edge_b + weight.y * triangle.edge_c;
  return length(cross(point - view_position, ray));
}

// The weights of the triangle's point that is nearest to a ray that misses it.
dvec2 NearestToRay(Triangle triangle, dvec3 ray) {
  dvec2 on_b = dvec2(NearestOnEdge(triangle.corner, triangle.edge_b, ray), 0.0lf);
  dvec2 on_c = dvec2(0.0lf, NearestOnEdge(triangle.corner, triangle.edge_c, ray));
  double t = NearestOnEdge(triangle.corner + triangle.edge_b, triangle.edge_c - triangle.edge_b, ray);
  dvec2 on_bc = dvec2(1.0lf - t, t);
  double distance_b = DistanceToRay(triangle, on_b, ray);
  double distance_c = DistanceToRay(triangle, on_c, ray);
  double distance_bc = DistanceToRay(triangle, on_bc, ray);
  if (distance_b <= distance_c && distance_b <= distance_bc) return on_b;
  return distance_c <= distance_bc ? on_c : on_bc;
}

void main() {
  uvec2 covering = texelFetch(coverage, ivec2(gl_FragCoord.xy), 0).xy;
  if (covering.x == 0u) discard;
  Draw draw = DrawAt(covering.y);
  if (draw.textures.x != texture_set) discard;
  uint first = 3u * (covering.x - 1u);
  Corner a = CornerAt(first);
  Corner b = CornerAt(first + 1u);
  Corner c = CornerAt(first + 2u);

  Triangle triangle;
  triangle.corner = a.position;
  triangle.edge_b = dvec3(b.position) - triangle.corner;
  triangle.edge_c = dvec3(c.position) - triangle.corner;
  dvec2 pixel = dvec2(gl_FragCoord.xy);
  dvec3 ray = RayThrough(pixel);
  dvec2 weight = RayHit(triangle, ray);
  // Coverage is decided on a grid of 1/256 pixel, so that a centre may lie just outside, and on a triangle that is seen
  // edge-on the plane's point far outside.
  if (min(weight.x, weight.y) < 0.0lf || weight.x + weight.y > 1.0lf) weight = NearestToRay(triangle, ray);
  double weight_a = 1.0lf - weight.x - weight.y;

  dvec3 position = triangle.corner + weight.x * triangle.edge_b + weight.y * triangle.edge_c;
  dvec3 normal_sum = weight_a * a.normal + weight.x * b.normal + weight.y * c.normal;
  double normal_length = length(normal_sum);
  dvec3 normal = normal_length > 0.0lf ? normal_sum / normal_length
                                       : normalize(cross(triangle.edge_b, triangle.edge_c));

  dvec2 uv_a = a.uv;
  dvec2 uv_b = b.uv - uv_a;
  dvec2 uv_c = c.uv - uv_a;
  vec2 uv = vec2(uv_a + weight.x * uv_b + weight.y * uv_c);

  vec3 color = draw.base_color_metalness.rgb;
  float metal = draw.base_color_metalness.w;
  // This form of the ramp gives a constant roughness back bit by bit.
  float rough = draw.roughness.x + (draw.roughness.y - draw.roughness.x) * clamp(uv.x, 0.0, 1.0);
  if (draw.textures.x != 0) {
    // Derivatives by two more rays: the neighbouring pixels may see another triangle.
    dvec2 hit_x = RayHit(triangle, RayThrough(pixel + dvec2(1.0lf, 0.0lf))) - weight;
    dvec2 hit_y = RayHit(triangle, RayThrough(pixel + dvec2(0.0lf, 1.0lf))) - weight;
    vec2 uv_dx = vec2(hit_x.x * uv_b + hit_x.y * uv_c);
    vec2 uv_dy = vec2(hit_y.x * uv_b + hit_y.y * uv_c);
    if (draw.textures.y != 0) color *= textureGrad(base_color_texture, uv, uv_dx, uv_dy).rgb;
    if (draw.textures.z != 0) {
      vec4 texel = textureGrad(metallic_roughness_texture, uv, uv_dx, uv_dy);
      rough *= texel.g;
      metal *= texel.b;
    }
#if EFFECT_NORMAL_MAP
    if (draw.textures.w != 0) {
      vec3 texel = textureGrad(normal_texture, uv, uv_dx, uv_dy).xyz * 2.0 - 1.0;
      dvec3 tangent = weight_a * a.tangent.xyz + weight.x * b.tangent.xyz + weight.y * c.tangent.xyz;
      dvec3 bitangent = cross(normal, tangent) * a.tangent.w;
      dvec3 mapped = double(texel.x * draw.normal_scale) * tangent +
                     double(texel.y * draw.normal_scale) * bitangent + double(texel.z) * normal;
      if (dot(mapped, mapped) > 0.0lf) normal = normalize(mapped);
    }
#endif
  }

#if EFFECT_APERTURE
  vec3 weights = vec3(dvec3(weight_a, weight));
  out_aperture = MixCaps(first, weights, 0, false, vec3(normal));
  out_first_region = MixCaps(first, weights, 1, true, vec3(normal));
  out_second_region = MixCaps(first, weights, 2, true, vec3(normal));
  out_blocked = MixCaps(first, weights, 3, true, vec3(normal));
#endif
  out_position = vec4(vec3(position), draw.kind);
  out_normal = vec4(vec3(normal), clamp(rough, 0.0, 1.0));
  out_base_color = vec4(color, clamp(metal, -1.0, 1.0));
}
