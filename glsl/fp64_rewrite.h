// The same shader text in double precision: a rewrite of its tokens.
#pragma once

#include <string>
#include <string_view>

namespace arealab {

// `text` with float, vecN and matN as double, dvecN and dmatN, float literals with the suffix lf, and calls
// of built-in functions that GLSL has for float only (acos, exp, pow, …) as calls of fp64_NAME
// (glsl/fp64_math.glsl). Comments and preprocessor lines other than #define stay as they are, and so does the
// number of lines.
std::string RewriteAsDouble(std::string_view text);

}  // namespace arealab
