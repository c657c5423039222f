// points.frag where no driver hides a NaN.
#include "platform"
#include "strict_order.glsl"
#include "points.frag"
