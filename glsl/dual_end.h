// Closes what glsl/dual_begin.h opened.
#undef float
#undef INOUT
#undef OUT
#undef AREALAB_DUAL

}  // namespace
}  // namespace arealab::dual

#pragma GCC diagnostic pop
