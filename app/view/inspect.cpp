#include "app/view/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "compare/shadowed_truth.h"
#include "compare/truth.h"

namespace arealab {
namespace {

// Heights of a light's corners, or of a sphere's and a disk's extremes, over the surface's plane: how many are above.
std::string Clipping(const Light& light, const glm::dvec3& position, const glm::dvec3& normal) {
  const double height = glm::dot(light.center - position, normal);
  const double x = light.half_size.x * glm::dot(light.axis_x, normal), y = light.half_size.y * glm::dot(light.axis_y, normal);
  if (light.shape == LightShape::kRectangle) {
    int above = 0;
    for (const double corner : {x + y, x - y, -x + y, -x - y}) above += height + corner > 0.0;
    return fmt::format("{} of 4 corners above", above);
  }
  if (light.shape == LightShape::kPolygon) {
    const auto above = std::ranges::count_if(light.corners, [&](const glm::dvec2& corner) {
      return height + corner.x * glm::dot(light.axis_x, normal) + corner.y * glm::dot(light.axis_y, normal) > 0.0;
    });
    return fmt::format("{} of {} corners above", above, light.corners.size());
  }
  const double reach = light.shape == LightShape::kSphere ? light.half_size.x
                       : light.shape == LightShape::kTube ? std::abs(x) + light.half_size.y * glm::length(glm::cross(light.axis_x, normal))
                                                          : std::hypot(x, y);
  return height > reach ? "wholly above" : height < -reach ? "wholly below" : "cut";
}

std::vector<double> Luminances(const RadianceImage& image) {
  std::vector<double> values;
  values.reserve(image.size());
  for (std::size_t i = 0; i < image.size(); ++i) {
    const double luminance = Luminance(image.Total(i));
    if (std::isfinite(luminance) && luminance > 0.0) values.push_back(luminance);
  }
  return values;
}

}  // namespace

Inspection InspectPixel(const Scene& scene, const SurfacePixels& pixels, std::size_t i, Lobe lobe) {
  Inspection inspection;
  const auto width = static_cast<std::size_t>(pixels.width);
  inspection.pixel = {static_cast<int>(i % width), static_cast<int>(i / width)};
  const int kind = static_cast<int>(pixels.position[i].w);
  if (kind != 1) {
    const auto light = static_cast<std::size_t>(std::max(std::abs(kind) - 2, 0));
    inspection.what = kind == 0 || light >= scene.lights.size()
                          ? "The background: nothing is there."
                          : fmt::format("The light '{}', its {} side.", scene.lights[light].name, kind > 0 ? "lit" : "dark");
    return inspection;
  }
  SurfacePixels one{1, 1, pixels.view_position, {pixels.position[i]}, {pixels.normal[i]}, {pixels.base_color[i]}, {}};
  const Truth truth = ComputeTruth(scene, one);
  inspection.surface = true;
  inspection.position = glm::dvec3(pixels.position[i]);
  inspection.roughness = pixels.normal[i].w;
  ShadingPoint point{inspection.position, glm::normalize(glm::dvec3(pixels.normal[i])),
                     glm::normalize(glm::dvec3(pixels.view_position) - inspection.position),
                     std::max(inspection.roughness * inspection.roughness, 1e-4), scene.brdf};
  inspection.n_dot_v = glm::dot(point.normal, point.to_view);
  for (const Light& light : scene.lights) {
    inspection.form_factor += IntegrateLight(point, light, 1e-4).form_factor;
    if (scene.lights.size() <= 4) {
      if (!inspection.clipping.empty()) inspection.clipping += '\n';
      inspection.clipping += Clipping(light, point.position, point.normal);
    }
  }
  if (inspection.clipping.empty()) inspection.clipping = fmt::format("{} lights", scene.lights.size());
  RadianceImage radiance = truth.radiance;
  inspection.truth_error = truth.relative_error[0];
  if (scene.aperture) {  // techniques have visibility there
    ShadowedTruth shadowed = ComputeShadowedTruth(scene, one, truth.radiance, {});
    radiance = std::move(shadowed.radiance);
    inspection.truth_error = std::max(inspection.truth_error, static_cast<double>(shadowed.relative_error[0]));
  }
  inspection.truth = glm::dvec3(lobe == Lobe::kTotal ? radiance.Total(0) : lobe == Lobe::kDiffuse ? radiance.diffuse[0] : radiance.specular[0]);
  return inspection;
}

double MeanLuminance(const RadianceImage& image) {
  const std::vector<double> values = Luminances(image);
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double LuminancePercentile(const RadianceImage& image, double share) {
  std::vector<double> values = Luminances(image);
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace arealab
