// Feeds core.frag where only compiling counts. Each component is an expression of its own that no linker can fold into the
// fragment shader.
layout(location = 0) in vec4 a;
layout(location = 1) in vec4 b;
layout(location = 0) out vec3 surface_position;
layout(location = 1) out vec3 surface_normal;

void main() {
  surface_position = vec3(a.x * b.y, a.y * b.z + a.w, a.z * b.w - b.x);
  surface_normal = vec3(b.x + a.x * 2.0, b.y * a.z + 3.0, b.z - a.y * a.y);
  gl_Position = a;
}
