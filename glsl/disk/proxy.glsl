// Disks and spheres as published: the cone's axes by a cubic, the proxy sphere from its table. After ltc.glsl.
#include "sphere/table.glsl"
#include "disk/eigen.glsl"
