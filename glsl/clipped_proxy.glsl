// A rectangle clipped at the horizon as the sphere of the same vector form factor [Hill & Heitz 2016]. Dual; after an "edge"
// and a "sphere".
#include "vector_form_factor.glsl"

// Of the proxy sphere that has the same F, clipped at the horizon; ClippedSphere is the option "sphere".
float ClippedProxy(VectorFormFactor f) {
  return AsFormFactor(ClippedSphere(f.size, f.height * f.inverse));
}

// Of the light itself. Where its sphere is clear of every horizon the clip leaves the height as it is; a table and a rational do not quite.
float LambertProxy(VectorFormFactor f) {
#if EFFECT_PROXY_HORIZON || SPHERE_TABLE || SPHERE_CHEAP
  return ClippedProxy(f);
#else
  return AsFormFactor(f.height);
#endif
}
