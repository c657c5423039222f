// Out of the ambient aperture [Oat 2006], for techniques that know of none.
#include "light_cap.glsl"
#include "open_share.glsl"

#if EFFECT_APERTURE
float Visibility(Surface surface, Light light) { return OpenShare(surface, LightCap(light, surface.position, surface.normal)); }
#endif
