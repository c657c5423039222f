// The lobe that an LTC technique integrates in place of the BRDF's, for pictures of it.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "glsl/shader_library.h"
#include "glsl/variant.h"
#include "scenes/scene.h"

namespace arealab {

struct FittedLobe {
  glm::dvec4 m{1.0, 0.0, 0.0, 1.0};  // M⁻¹, in the order of glsl/fit.h
  double magnitude = 1.0;            // with Fresnel 1
  double other = 0.0;                // weight of a lobe beside it
  glm::dvec4 second{1.0, 0.0, 0.0, 1.0};  // that lobe's M⁻¹; the plain cosine's is the identity

  // 1/sr, with Fresnel 1, also below the surface's horizon. `direction` is unit, in the frame normal = +z, viewer = (sin θ, 0, cos θ).
  double Density(const glm::dvec3& direction) const;
};

// As the variant looks it up, from the files that it reads; nothing where it looks up none. Throws InputError where such a file is
// missing or is no table.
std::optional<FittedLobe> FindFittedLobe(const ShaderLibrary& library, const Variant& variant, Brdf brdf, double roughness,
                                         double n_dot_v);

}  // namespace arealab
