// Ward's importance cone: that of Beckmann's density, whose lobe it is over (n·v)² at the peak; energy and peak have it alike. Dual;
// see importance_cone.glsl.
#include "importance_cone/beckmann.glsl"
