// Every choice of a scene's BRDF in C++, in a namespace named as its file. Between glsl/dual_begin.h and
// glsl/dual_end.h, after glsl/brdf.glsl; scenes/scene.h before them.

// clang-format off
namespace ggx {
#include "glsl/brdf/ggx.glsl"
}
namespace ggx_separable {
#include "glsl/brdf/ggx_separable.glsl"
}
namespace beckmann {
#include "glsl/brdf/beckmann.glsl"
}
namespace blinn_phong {
#include "glsl/brdf/blinn_phong.glsl"
}
namespace ward {
#include "glsl/brdf/ward.glsl"
}
namespace phong {
#include "glsl/brdf/phong.glsl"
}
namespace lambert {
#include "glsl/diffuse/lambert.glsl"
}
namespace disney {
#include "glsl/diffuse/disney.glsl"
}
// clang-format on

// Calls function(over_ggx), over_ggx being the choice's BrdfOverGgx as an object of a type of its own, so
// that a loop over it is compiled for each BRDF. A diffuse one is a lobe of alpha = 1, of which GgxDensity is 1/π
// everywhere, whatever the surface's `roughness`.
template <typename Function>
auto WithBrdf(Brdf brdf, float roughness, const Function& function) {
  using Number = float;
#define AREALAB_CALL(name)                                                                        \
  return function([](Number n_dot_v, Number n_dot_l, Number v_dot_h, Number tan2_h, Number alpha) \
                      __attribute__((always_inline)) {                                            \
                        return name::BrdfOverGgx(n_dot_v, n_dot_l, v_dot_h, tan2_h, alpha);       \
                      })
  switch (brdf) {
    case Brdf::kGgx:
      AREALAB_CALL(ggx);
    case Brdf::kGgxSeparable:
      AREALAB_CALL(ggx_separable);
    case Brdf::kBeckmann:
      AREALAB_CALL(beckmann);
    case Brdf::kBlinnPhong:
      AREALAB_CALL(blinn_phong);
    case Brdf::kWard:
      AREALAB_CALL(ward);
    case Brdf::kPhong:
      AREALAB_CALL(phong);
    case Brdf::kLambert:
    case Brdf::kDisney:
      break;
  }
  const bool even = brdf == Brdf::kLambert;
  return function([even, roughness](Number n_dot_v, Number n_dot_l, Number v_dot_h, Number, Number) __attribute__((always_inline)) {
    return even ? lambert::DiffuseOverLambert(n_dot_v, n_dot_l, v_dot_h * v_dot_h, roughness)
                : disney::DiffuseOverLambert(n_dot_v, n_dot_l, v_dot_h * v_dot_h, roughness);
  });
#undef AREALAB_CALL
}

// The BRDF over GgxDensity at one place.
float BrdfOverGgx(Brdf brdf, float n_dot_v, float n_dot_l, float v_dot_h, float tan2_h, float alpha, float roughness = 0.0) {
  return WithBrdf(brdf, roughness,
                  [&](const auto& over_ggx) { return over_ggx(n_dot_v, n_dot_l, v_dot_h, tan2_h, alpha); });
}
