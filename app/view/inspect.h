// One pixel: what is there, what the lights do to it, and the lobes that reflect them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/view/display.h"
#include "compare/point_shader.h"
#include "glsl/fitted_lobe.h"
#include "glsl/pixels.h"
#include "scenes/scene.h"

namespace arealab {

// Radiance of the two lobes.
struct Lobes {
  glm::dvec3 diffuse{0.0}, specular{0.0};
  glm::dvec3 Of(Lobe lobe) const { return lobe == Lobe::kTotal ? diffuse + specular : lobe == Lobe::kDiffuse ? diffuse : specular; }
};

struct LightAtPixel {
  std::string name;
  double form_factor = 0.0;
  std::string clipping;  // how the surface's horizon cuts it
  // The point under this light alone: white albedo, F0 and radiance by their luminance, no texture, the side that faces the point.
  PointCase test_case;
};

// The specular lobe at a point with Fresnel 1, times the cosine, in two pictures of the unit disc. From the side: the plane of
// incidence, y along the normal, x towards the viewer, the radius 1 at the BRDF's peak and 1/3 less for each tenth of it. From
// above: a direction's projection on the surface, so that a light's share of the disc is its form factor.
struct LobePicture {
  using Segment = std::pair<glm::vec2, glm::vec2>;
  double peak = 0.0;  // 1/sr, of the BRDF × cosine
  glm::vec2 to_view{0.0f};
  std::vector<glm::vec2> brdf, ltc;                 // from the side
  std::vector<Segment> brdf_contours, ltc_contours;  // from above: a half, a tenth and a hundredth of the peak
  std::vector<std::vector<glm::vec2>> lights;        // from above, closed
  std::vector<std::pair<float, float>> spans;        // of lights in the plane of incidence: angles from the normal, towards the viewer
  std::string ltc_name;                              // the variant whose lobe it is; empty: none
};

struct PixelValue {
  std::string name;
  Lobes in_float;
  std::optional<Lobes> in_double;  // the same text
};

struct Inspection {
  bool surface = false;
  std::string what;  // it is where it is no surface
  glm::ivec2 pixel{0};
  glm::dvec3 position{0.0};  // m
  double roughness = 0.0, n_dot_v = 0.0;
  double form_factor = 0.0;           // of all lights
  std::vector<LightAtPixel> lights;   // the largest form factor first
  Lobes truth;
  double truth_error = 0.0;  // relative, of the total
  std::vector<PixelValue> values;
  LobePicture picture;
};

// What is known of pixel i without any technique; `values` and the picture's LTC stay empty.
Inspection InspectPixel(const Scene& scene, const SurfacePixels& pixels, std::size_t i);
void AddFittedLobe(Inspection& inspection, Brdf brdf, const FittedLobe& lobe, const std::string& name);

// "pixel": {…}, the luminance of each lobe by variant, and the test cases.
std::string Json(const Inspection& inspection);

// Figures of a picture's total, over the finite pixels that it lights; 0 where there are none.
double MeanLuminance(const RadianceImage& image);
double LuminancePercentile(const RadianceImage& image, double share);

}  // namespace arealab
