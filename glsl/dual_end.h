// Closes what glsl/dual_begin.h opened.
#undef float
#undef INOUT
#undef OUT
#undef AREALAB_DUAL
#undef EFFECT_HORIZON
#undef EFFECT_PROXY_HORIZON

}  // namespace
}  // namespace arealab::dual

#pragma GCC diagnostic pop
