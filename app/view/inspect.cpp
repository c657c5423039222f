#include "app/view/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/constants.hpp>

#include "app/view/outline.h"
#include "compare/shadowed_truth.h"
#include "compare/stress_families.h"
#include "compare/truth.h"
#include "compare/truth_bands.h"
#include "glsl/fit_lobe.h"
#include "scenes/light_texture.h"

namespace arealab {
namespace {

// Heights of a light's corners, or of a sphere's and a disk's extremes, over the surface's plane: how many are above.
std::string Clipping(const Light& light, const glm::dvec3& position, const glm::dvec3& normal) {
  const double height = glm::dot(light.center - position, normal);
  const double x = light.half_size.x * glm::dot(light.axis_x, normal), y = light.half_size.y * glm::dot(light.axis_y, normal);
  if (light.shape == LightShape::kRectangle) {
    int above = 0;
    for (const double corner : {x + y, x - y, -x + y, -x - y}) above += height + corner > 0.0;
    return fmt::format("{} of 4 above", above);
  }
  if (light.shape == LightShape::kPolygon) {
    const auto above = std::ranges::count_if(light.corners, [&](const glm::dvec2& corner) {
      return height + corner.x * glm::dot(light.axis_x, normal) + corner.y * glm::dot(light.axis_y, normal) > 0.0;
    });
    return fmt::format("{} of {} above", above, light.corners.size());
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

// Its normals point to the surface: what is seen of a two-sided light may be its back.
PointCase CaseOf(const ShadedPixel& pixel, double roughness, const Light& light) {
  PointCase c;
  c.shape = light.shape;
  c.position = pixel.point.position;
  c.normal = pixel.point.normal;
  c.to_view = pixel.point.to_view;
  c.roughness = roughness;
  c.f0 = Luminance(pixel.f0);
  c.center = light.center;
  c.axis_x = light.axis_x;
  c.axis_y = light.axis_y;
  c.light_normal = light.normal;
  c.half_size = light.half_size;
  c.corners = light.corners;
  c.radiance = Luminance(light.texture ? light.radiance * MeanTexel(*light.texture) : light.radiance);
  if (light.two_sided && glm::dot(light.normal, c.position - light.center) < 0.0) {
    c.light_normal = -light.normal;
    c.axis_x = -light.axis_x;
    for (glm::dvec2& corner : c.corners) corner.x = -corner.x;
    std::ranges::reverse(c.corners);
  }
  return c;
}

// The local frame of the lobe: x towards the viewer, z the normal.
struct LobeFrame {
  explicit LobeFrame(const ShadingPoint& point) : z(point.normal) {
    x = point.to_view - z * glm::dot(z, point.to_view);
    if (glm::length(x) < 1e-6) x = std::abs(z.x) < 0.5 ? glm::dvec3(0.0, -z.z, z.y) : glm::dvec3(z.z, 0.0, -z.x);
    x = glm::normalize(x);
    y = glm::cross(z, x);
  }
  glm::dvec3 x, y, z;
};

// Directions to the edge of what is above the horizon of a light, at most a degree apart.
std::vector<glm::dvec3> VisibleEdge(const Light& light, const ShadingPoint& point) {
  const double side = glm::dot(light.normal, point.position - light.center);
  if (IsFlat(light.shape) && !(side > 0.0 || (light.two_sided && side < 0.0))) return {};
  const LobeFrame frame(point);
  std::vector<glm::dvec3> corners;
  for (const glm::dvec3& corner : Silhouette(light, point.position)) {
    const glm::dvec3 p = corner - point.position;
    corners.emplace_back(glm::dot(p, frame.x), glm::dot(p, frame.y), glm::dot(p, frame.z));
  }
  std::vector<glm::dvec3> above;  // [Sutherland & Hodgman 1974]
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const glm::dvec3 &a = corners[i], &b = corners[i + 1];
    if (a.z >= 0.0) above.push_back(a);
    if ((a.z >= 0.0) != (b.z >= 0.0)) above.push_back(glm::mix(a, b, a.z / (a.z - b.z)));
  }
  std::vector<glm::dvec3> edge;
  for (std::size_t i = 0; i < above.size(); ++i) {
    const glm::dvec3 &a = above[i], &b = above[(i + 1) % above.size()];
    const double cosine = glm::dot(a, b) / std::max(glm::length(a) * glm::length(b), 1e-300);
    const int steps = std::max(1, static_cast<int>(std::ceil(glm::degrees(std::acos(std::clamp(cosine, -1.0, 1.0))))));
    for (int k = 0; k < steps; ++k) edge.push_back(glm::normalize(glm::mix(a, b, static_cast<double>(k) / steps)));
  }
  return edge;
}

// Where the closed line crosses the plane of incidence: angles from the normal.
void AddSpans(const std::vector<glm::vec2>& edge, std::vector<std::pair<float, float>>& spans) {
  std::vector<float> crossings;
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const glm::vec2 &a = edge[i], &b = edge[(i + 1) % edge.size()];
    if ((a.y >= 0.0f) != (b.y >= 0.0f)) crossings.push_back(std::asin(std::clamp(glm::mix(a.x, b.x, a.y / (a.y - b.y)), -1.0f, 1.0f)));
  }
  std::ranges::sort(crossings);
  for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) spans.emplace_back(crossings[i], crossings[i + 1]);
}

constexpr double kBeyond = 105.0;  // degrees from the normal: what leaks below the horizon is shown too

// A lobe from the side. Around the mirrored view it is drawn as finely as a sharp lobe needs.
template <typename Density>
std::vector<glm::vec2> FromTheSide(const Density& density, const fit::View& view, double peak) {
  std::vector<double> angles;
  for (int i = -420; i <= 420; ++i) angles.push_back(glm::radians(kBeyond * i / 420.0));
  for (int i = -120; i <= 120; ++i) {
    angles.push_back(-std::acos(view.cosine) + view.alpha * std::sinh(i / 40.0));
  }
  std::ranges::sort(angles);
  std::vector<glm::vec2> line;
  for (const double angle : angles) {
    const glm::dvec2 direction(std::sin(angle), std::cos(angle));
    const double value = density(glm::dvec3(direction.x, 0.0, direction.y)) / peak;
    line.emplace_back(direction * std::clamp(1.0 + std::log10(std::max(value, 1e-30)) / 3.0, 0.0, 1.2));
  }
  return line;
}

// Contours from above, by marching squares.
template <typename Density>
std::vector<LobePicture::Segment> FromAbove(const Density& density, double peak) {
  constexpr int kCells = 96;
  const auto place = [](double i) { return -1.0 + 2.0 * i / kCells; };
  std::vector<double> values;
  for (int j = 0; j <= kCells; ++j) {
    for (int i = 0; i <= kCells; ++i) {
      const double x = place(i), y = place(j), r2 = x * x + y * y;
      // Beyond the horizon a line goes on as it reached it.
      const double scale = r2 < 0.999 ? 1.0 : std::sqrt(0.999 / r2);
      values.push_back(density(glm::dvec3(x * scale, y * scale, std::sqrt(1.0 - std::min(r2, 0.999)))) / peak);
    }
  }
  std::vector<LobePicture::Segment> segments;
  for (const double level : {0.5, 0.1, 0.01}) {
    for (int j = 0; j < kCells; ++j) {
      for (int i = 0; i < kCells; ++i) {
        if (std::hypot(place(i + 0.5), place(j + 0.5)) > 1.0) continue;
        std::vector<glm::vec2> ends;
        const glm::ivec2 corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
        for (int k = 0; k < 4; ++k) {
          const glm::ivec2 &p = corners[k], &q = corners[k + 1];
          const double a = values[static_cast<std::size_t>((j + p.y) * (kCells + 1) + i + p.x)];
          const double b = values[static_cast<std::size_t>((j + q.y) * (kCells + 1) + i + q.x)];
          if ((a >= level) == (b >= level)) continue;
          const glm::dvec2 at = glm::mix(glm::dvec2(p), glm::dvec2(q), (level - a) / (b - a));
          ends.emplace_back(place(i + at.x), place(j + at.y));
        }
        for (std::size_t k = 0; k + 1 < ends.size(); k += 2) segments.emplace_back(ends[k], ends[k + 1]);
      }
    }
  }
  return segments;
}

LobePicture PictureOf(const Scene& scene, const ShadingPoint& point, double roughness) {
  const fit::View view = fit::MakeView(scene.brdf, roughness, std::clamp(glm::dot(point.normal, point.to_view), 1e-6, 1.0));
  const auto density = [&](const glm::dvec3& direction) { return fit::LobeDensity(view, direction); };
  LobePicture picture;
  picture.to_view = glm::vec2(view.sine, view.cosine);
  // The peak lies in the plane of incidence, by symmetry, at or beyond the mirrored view.
  for (int i = -4000; i <= 4000; ++i) {
    const double angle = -std::acos(view.cosine) + std::min(view.alpha, 0.5) * std::sinh(i / 1000.0);
    picture.peak = std::max(picture.peak, density(glm::dvec3(std::sin(angle), 0.0, std::cos(angle))));
  }
  if (!(picture.peak > 0.0)) return picture;
  picture.brdf = FromTheSide(density, view, picture.peak);
  picture.brdf_contours = FromAbove(density, picture.peak);
  for (const Light& light : scene.lights) {
    std::vector<glm::vec2> edge;
    for (const glm::dvec3& direction : VisibleEdge(light, point)) edge.emplace_back(direction.x, direction.y);
    if (edge.empty()) continue;
    AddSpans(edge, picture.spans);
    picture.lights.push_back(std::move(edge));
  }
  return picture;
}

}  // namespace

Inspection InspectPixel(const Scene& scene, const SurfacePixels& pixels, std::size_t i) {
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
  const std::optional<ShadedPixel> pixel = ShadedPixelAt(scene, pixels, i);
  if (!pixel) {
    inspection.what = "A face turned away from the viewer: black.";
    return inspection;
  }
  const SurfacePixels one{1, 1, pixels.view_position, {pixels.position[i]}, {pixels.normal[i]}, {pixels.base_color[i]}, {}};
  const Truth truth = ComputeTruth(scene, one);
  inspection.surface = true;
  inspection.position = pixel->point.position;
  inspection.roughness = pixels.normal[i].w;
  inspection.n_dot_v = glm::dot(pixel->point.normal, pixel->point.to_view);
  for (const Light& light : scene.lights) {
    const double form_factor = IntegrateLight(pixel->point, light, 1e-4).form_factor;
    inspection.form_factor += form_factor;
    PointCase c = CaseOf(*pixel, inspection.roughness, light);
    c.normal = glm::dvec3(pixels.normal[i]);  // as it is in the picture, to the bit
    inspection.lights.push_back({light.name, form_factor, Clipping(light, pixel->point.position, pixel->point.normal), c});
  }
  std::ranges::stable_sort(inspection.lights, std::ranges::greater(), &LightAtPixel::form_factor);
  inspection.truth = {glm::dvec3(truth.radiance.diffuse[0]), glm::dvec3(truth.radiance.specular[0])};
  inspection.truth_error = truth.relative_error[0];
  if (scene.aperture) {  // techniques have visibility there
    const ShadowedTruth shadowed = ComputeShadowedTruth(scene, one, truth.radiance, {});
    inspection.truth = {glm::dvec3(shadowed.radiance.diffuse[0]), glm::dvec3(shadowed.radiance.specular[0])};
    inspection.truth_error = std::max(inspection.truth_error, static_cast<double>(shadowed.relative_error[0]));
  }
  inspection.picture = PictureOf(scene, pixel->point, inspection.roughness);
  return inspection;
}

void AddFittedLobe(Inspection& inspection, Brdf brdf, const FittedLobe& lobe, const std::string& name) {
  LobePicture& picture = inspection.picture;
  if (!(picture.peak > 0.0)) return;
  const fit::View view = fit::MakeView(brdf, inspection.roughness, inspection.n_dot_v);
  const auto density = [&](const glm::dvec3& direction) { return lobe.Density(direction); };
  picture.ltc_name = name;
  picture.ltc = FromTheSide(density, view, picture.peak);
  picture.ltc_contours = FromAbove(density, picture.peak);
}

std::string Json(const Inspection& inspection) {
  const auto lobes = [](const Lobes& value) { return fmt::format("[{:.9g}, {:.9g}]", Luminance(value.diffuse), Luminance(value.specular)); };
  std::string values, cases;
  for (const PixelValue& value : inspection.values) {
    values += fmt::format("{}\"{}\": {{\"float\": {}, \"double\": {}}}", values.empty() ? "" : ", ", value.name, lobes(value.in_float),
                          value.in_double ? lobes(*value.in_double) : "null");
  }
  for (const LightAtPixel& light : inspection.lights) cases += fmt::format("{}\"{}\"", cases.empty() ? "" : ", ", CaseLine(light.test_case));
  return fmt::format("\"pixel\": {{\"x\": {}, \"y\": {}, \"truth\": {}, \"values\": {{{}}}, \"cases\": [{}]}}", inspection.pixel.x, inspection.pixel.y,
                     lobes(inspection.truth), values, cases);
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
