#pragma once
// Whether a light is near, for text that branches on it: see path.glsl. `arealab cost` counts with PATH_FAR and with PATH_NEAR. Dual.

// Whether any side of a light is seen under an obtuse angle.
bool HasObtuseSide(bool obtuse) {
#if PATH_FAR
  if (obtuse) discard;
  return false;
#elif PATH_NEAR
  if (!obtuse) discard;
  return true;
#else
  return obtuse;
#endif
}
