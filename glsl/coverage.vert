// Which triangle covers which pixel; gbuffer.frag finds the point on it by itself.

layout(location = 0) in vec3 in_position;  // m, world

uniform vec3 view_position;    // m, world
uniform mat3 view_from_world;  // to x right, y up, z forward
uniform vec2 focal;            // 1 / tan of half the angle of view, in x and y
uniform float near;            // m

void main() {
  vec3 p_view = view_from_world * (in_position - view_position);
  // Reversed depth without a far plane: near / z, 1 at the near plane, 0 at infinity.
  gl_Position = vec4(focal * p_view.xy, near, p_view.z);
}
