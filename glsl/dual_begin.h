// Opens namespace arealab::dual, in which shader text compiles as C++ in double precision. Use in a .cpp file:
//   #include "glsl/dual_begin.h"
//   #include "glsl/brdf.glsl"
//   #include "glsl/dual_end.h"
// Dual files keep to the common subset: no swizzles (but .x .y .z .w), no uniforms, no derivatives, no texture reads,
// no array constructors; out parameters are written OUT(vec3) name; each file starts with #pragma once, which the
// GLSL expander drops. #include names are relative to glsl/.
#include <cassert>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wunused-variable"

namespace arealab::dual {
namespace {

using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using mat2 = glm::dmat2;
using mat3 = glm::dmat3;
using mat4 = glm::dmat4;
using uint = unsigned int;
using glm::abs, glm::acos, glm::all, glm::any, glm::asin, glm::atan, glm::ceil, glm::clamp, glm::cos, glm::cross, glm::cosh,
    glm::determinant, glm::distance, glm::dot, glm::equal, glm::exp, glm::exp2, glm::floor, glm::fract, glm::greaterThan,
    glm::inverse, glm::inversesqrt, glm::isinf, glm::isnan, glm::length, glm::lessThan, glm::log, glm::log2, glm::max,
    glm::min, glm::mix, glm::mod, glm::normalize, glm::pow, glm::reflect, glm::sign, glm::sin, glm::sinh, glm::smoothstep,
    glm::sqrt, glm::step, glm::tan, glm::tanh, glm::transpose;

#define AREALAB_DUAL 1
// All effects that dual files ask for are on.
#define EFFECT_HORIZON 1
#define EFFECT_PROXY_HORIZON 1
#define OUT(type) type&
#define INOUT(type) type&
#define float double
