// The same shader text as hardware of half floats computes it: a rewrite of its expressions.
#pragma once

#include <string>
#include <string_view>

namespace arealab {

// The nearest half float, ties to even; ±Inf from 65520 on; 0 below 2⁻¹⁴: GLSL ES 3.00, § 4.5.1, leaves
// subnormal numbers to the implementation, and what shall run everywhere must do without.
float RoundedToHalf(double value);

// `text` with the result of every +, −, *, / and of every built-in function that rounds as fp16(…), those of several
// operations as fp16_NAME(…) (glsl/fp16_math.glsl), and every literal the nearest half float. Integers stay as they
// are: fp16 of an integer is that integer. A constant that is computed is no `const` any more. Brackets are copied: an
// index is an integer. The number of lines stays.
std::string RewriteAsHalf(std::string_view text);

}  // namespace arealab
