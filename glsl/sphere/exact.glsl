// The form factor of a sphere clipped at the horizon, exactly [Snyder 1996; in the form of Lagarde & de Rousiers 2014]. Dual.
#include "directions.glsl"

// size: sin² of the sphere's angular radius, its form factor when faced, [0, 1]; elevation: cosine between its centre and
// the normal.
float ClippedSphere(float size, float elevation) {
  float y = clamp(elevation, -1.0, 1.0);  // rounding can leave the range, and that of size below
  size = min(size, 1.0);
  if (y * y >= size) return size * max(y, 0.0);  // wholly above or wholly below
  float sine = sqrt(1.0 - y * y);
  // cot² of the angular radius; from within the sphere the whole hemisphere is lit.
  float x = sqrt(max(1.0 / size - 1.0, 0.0));
  float rim = clamp(-x * y / sine, -1.0, 1.0);  // cosine of the azimuth where the sphere's rim meets the horizon
  float chord = sine * sqrt(1.0 - rim * rim);
  return ((y * Arccosine(rim) - x * chord) * size + Arctangent(chord, x)) / kPi;
}
