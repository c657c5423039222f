// Which triangle covers which pixel, and which draw it belongs to.

layout(location = 0) out uvec2 out_triangle;  // 1 + index of the triangle, index of the draw; 0, 0: background

uniform int first_triangle;
uniform int draw;

void main() { out_triangle = uvec2(1 + first_triangle + gl_PrimitiveID, draw); }
