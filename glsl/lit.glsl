#pragma once
// The guards before the work. `arealab cost` counts a pixel that is lit: with PATH_LIT others are discarded, since the
// compiler's count discounts what stands behind a condition. Where something is drawn it is off. Dual.

// Whether a guard lets the pixel through to the work behind it.
bool Lit(bool lit) {
#if PATH_LIT
  if (!lit) discard;
  return true;
#else
  return lit;
#endif
}
