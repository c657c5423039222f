// A tile as a point of its size: squares of one primitive have no diagonal along which pixels are shaded twice.
layout(location = 0) in vec2 tile;  // column and row

uniform vec2 tile_count;  // over the viewport, which holds whole tiles

void main() {
  gl_Position = vec4((2.0 * tile + 1.0) / tile_count - 1.0, 0.0, 1.0);
  gl_PointSize = float(TILE_SIZE);
}
