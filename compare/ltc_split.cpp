#include "compare/ltc_split.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/constants.hpp>
#include <set>

#include "compare/cache_file.h"
#include "compare/content_hash.h"
#include "compare/truth_bands.h"
#include "compare/truth_cache.h"
#include "glsl/table.h"
#include "scenes/error.h"

namespace arealab {
namespace {

using Outline = std::vector<glm::dvec3>;

// Corners of the polygon of the same area that stands for a round light; its form factors are off by about 1e-5.
constexpr int kRoundCorners = 256;

// Where the light is seen from the lit side, counter-clockwise from there, from the point, world; empty where nothing is.
Outline OutlineOf(const Light& light, const glm::dvec3& point) {
  const glm::dvec3 center = light.center - point;
  Outline outline;
  const double step = glm::two_pi<double>() / kRoundCorners, widening = std::sqrt(step / std::sin(step));
  if (light.shape == LightShape::kSphere) {
    const double d2 = glm::dot(center, center), r2 = light.half_size.x * light.half_size.x;
    if (d2 <= r2) return {};
    const glm::dvec3 axis = glm::normalize(center), x = glm::normalize(glm::cross(axis, std::abs(axis.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 y = glm::cross(x, axis);
    const double tangent = std::sqrt(r2 / (d2 - r2)) * widening;
    for (int i = 0; i < kRoundCorners; ++i) outline.push_back(axis + tangent * (std::cos(i * step) * x + std::sin(i * step) * y));
    return outline;
  }
  const double height = -glm::dot(light.normal, center);
  if (height == 0.0 || (height < 0.0 && !light.two_sided)) return {};
  const auto add = [&](double x, double y) { outline.push_back(center + x * light.axis_x + y * light.axis_y); };
  const glm::dvec2 half = light.half_size;
  if (light.shape == LightShape::kRectangle) {
    for (const glm::dvec2 c : {glm::dvec2(1, 1), glm::dvec2(-1, 1), glm::dvec2(-1, -1), glm::dvec2(1, -1)}) add(c.x * half.x, c.y * half.y);
  } else if (light.shape == LightShape::kPolygon) {
    for (const glm::dvec2& c : light.corners) add(c.x, c.y);
  } else {
    for (int i = 0; i < kRoundCorners; ++i) add(widening * half.x * std::cos(i * step), widening * half.y * std::sin(i * step));
  }
  if (height < 0.0) std::reverse(outline.begin(), outline.end());
  return outline;
}

Outline AboveHorizon(const Outline& outline) {
  Outline above;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    if (a.z > 0.0) above.push_back(a);
    if ((a.z > 0.0) != (b.z > 0.0)) {
      above.push_back(a + (b - a) * (a.z / (a.z - b.z)));
      above.back().z = 0.0;
    }
  }
  return above;
}

// The vector form factor [Lambert 1760; Arvo 1995].
glm::dvec3 VectorOf(const Outline& outline) {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const glm::dvec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
    const glm::dvec3 cross = glm::cross(b, a);
    const double sine = glm::length(cross);
    if (sine > 0.0) sum += cross * (std::atan2(sine, glm::dot(a, b)) / sine);
  }
  return sum / glm::two_pi<double>();
}

glm::dvec3 OfProxy(glm::dvec3 vector) {
  const double size = glm::length(vector);
  if (size > 0.0) vector.z = ClippedSphere(vector.z / size, size);
  return vector;
}

glm::dvec3 Treated(const Outline& outline, LtcHorizon horizon) {
  if (horizon == LtcHorizon::kProxy) return OfProxy(VectorOf(outline));
  glm::dvec3 vector = VectorOf(horizon == LtcHorizon::kNone ? outline : AboveHorizon(outline));
  vector.z = std::max(vector.z, 0.0);
  return vector;
}

bool IsRound(LightShape shape) { return shape != LightShape::kRectangle && shape != LightShape::kPolygon; }

// The lobes of one pixel.
void AddPixel(const Scene& scene, const ShadedPixel& pixel, double roughness, const LtcForm& form, glm::dvec3& diffuse, glm::dvec3& specular) {
  const glm::dvec3 &n = pixel.point.normal, &v = pixel.point.to_view;
  const double cosine = glm::dot(n, v);
  glm::dvec3 tangent = v - n * cosine;
  const double sine = std::min(glm::length(tangent), 1.0);
  if (sine < 1e-9) tangent = glm::cross(n, std::abs(n.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0));
  tangent = glm::normalize(tangent);
  const glm::dmat3 local = glm::transpose(glm::dmat3(tangent, glm::cross(n, tangent), n));
  const LtcLookup look = Look(form.tables, roughness, cosine);
  for (const Light& light : scene.lights) {
    Outline outline = OutlineOf(light, pixel.point.position);
    if (outline.empty()) continue;
    for (glm::dvec3& corner : outline) corner = local * corner;
    const LtcHorizon horizon = IsRound(light.shape) ? form.round : form.straight;
    const double form_factor = Treated(outline, horizon).z;
    const Outline lobe = horizon == LtcHorizon::kBoth ? AboveHorizon(outline) : outline;
    const bool two = form.tables.kind == FitKind::kTwo;
    const auto add_lobe = [&](const glm::dvec4& m, double magnitude, double schlick, double cosine_share) {
      Outline transformed = lobe;
      for (glm::dvec3& c : transformed) c = {m.x * c.x + m.z * c.z, c.y, m.y * c.x + m.w * c.z};
      const glm::dvec3 seen = Treated(transformed, horizon);
      double weight = schlick;
      if (form.fresnel_direction) {
        const glm::dvec3 back(m.w * seen.x - m.z * seen.z, (m.x * m.w - m.y * m.z) * seen.y, m.x * seen.z - m.y * seen.x);
        const double length = glm::length(back), v_dot_l = length > 0.0 ? (sine * back.x + cosine * back.z) / length : 0.0;
        const double v_dot_h = std::sqrt(std::clamp(0.5 + 0.5 * v_dot_l, 0.0, 1.0));
        weight = glm::mix(std::pow(1.0 - v_dot_h, 5.0) * magnitude, schlick, seen.z);
      }
      specular += pixel.specular_weight * light.radiance * (pixel.f0 * (magnitude - weight) + weight) *
                  std::max(seen.z + cosine_share * form_factor, 0.0);
    };
    diffuse += pixel.albedo * light.radiance * form_factor;
    add_lobe(look.m, look.terms.x, look.terms.y, two ? 0.0 : look.terms.z);
    if (two) add_lobe(look.second, look.terms.x * look.terms.z, look.terms.w, 0.0);
  }
}

FitKind KindOf(const Variant& variant) {
  const auto chosen = [&](const char* option, const char* choice) {
    const auto found = variant.options.find(option);
    return found != variant.options.end() && found->second == choice;
  };
  if (chosen("fit", "l3")) return FitKind::kPublished;
  if (chosen("lobes", "cosine")) return FitKind::kCosine;
  if (chosen("lobes", "two")) return FitKind::kTwo;
  return chosen("horizon", "true") ? FitKind::kHorizon : FitKind::kPolygon;
}

std::vector<glm::dvec3> Less(const LobePictures& a, const LobePictures& b, const LobePictures& ratio) {
  std::vector<glm::dvec3> difference(a.diffuse.size());
  for (std::size_t i = 0; i < difference.size(); ++i)
    difference[i] = ratio.diffuse[i] * (a.diffuse[i] - b.diffuse[i]) + ratio.specular[i] * (a.specular[i] - b.specular[i]);
  return difference;
}

LobePictures InDouble(const RadianceImage& image) {
  return {{image.diffuse.begin(), image.diffuse.end()}, {image.specular.begin(), image.specular.end()}};
}

// a/b, 1 where b is dark.
std::vector<glm::dvec3> Ratio(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
  std::vector<glm::dvec3> ratio(a.size(), glm::dvec3(1.0));
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      if (b[i][c] > 0.0) ratio[i][c] = a[i][c] / b[i][c];
    }
  return ratio;
}

Variant With(Variant variant, const char* option, const char* choice) {
  if (variant.options.contains(option)) variant.options[option] = choice;
  return variant;
}

}  // namespace

LobePictures LtcPicture(const Scene& scene, const SurfacePixels& pixels, const LtcForm& form) {
  LobePictures picture{std::vector(pixels.size(), glm::dvec3(0.0)), std::vector(pixels.size(), glm::dvec3(0.0))};
  tbb::parallel_for(std::size_t{0}, pixels.size(), [&](std::size_t i) {
    const std::optional<ShadedPixel> pixel = ShadedPixelAt(scene, pixels, i);
    if (pixel) AddPixel(scene, *pixel, static_cast<double>(pixels.normal[i].w), form, picture.diffuse[i], picture.specular[i]);
  });
  return picture;
}

LtcTables OwnTables(const Variant& variant, const ShaderLibrary& library, Brdf brdf) {
  LtcTables tables;
  tables.brdf = brdf;
  tables.kind = KindOf(variant);
  const auto among = [&](const char* option, std::initializer_list<const char*> choices) {
    return std::distance(choices.begin(), std::ranges::find(choices, variant.options.at(option), [](const char* c) { return std::string(c); }));
  };
  tables.storage = {static_cast<LtcFrame>(among("frame", {"mirror", "normal"})), static_cast<LtcNorm>(among("norm", {"middle", "none", "last"})),
                    static_cast<LtcAxis>(among("axis", {"sqrt", "cos", "theta"}))};
  for (const Table& table : TablesOf(variant, brdf)) {
    if (!table.name.starts_with("ltc_")) continue;
    const std::string name = TableFile(variant, table, brdf);
    const std::optional<std::string> bytes = library.Find(name);
    if (!bytes) throw InputError(library.DisplayPath(name) + " does not exist; expected a file that `arealab fit` wrote");
    TableTexels texels = DecodeTable(*bytes, library.DisplayPath(name));
    tables.size = texels.size.x;
    (table.name == "ltc_matrix" ? tables.matrix : tables.terms) = std::move(texels.texels);
  }
  return tables;
}

LtcTables FineTables(const LtcTables& own, const SurfacePixels& pixels, const std::filesystem::path& cache) {
  FitOptions options;
  options.size = kLtcRefinement * (own.size - 1) + 1;
  std::set<int> wanted;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!pixels.IsSurface(i)) continue;
    const int column = std::min(static_cast<int>(std::clamp(static_cast<double>(pixels.normal[i].w), 0.0, 1.0) * (options.size - 1)), options.size - 2);
    wanted.insert({column, column + 1});
  }
  const std::vector<int> columns(wanted.begin(), wanted.end());
  ContentHash hash;  // the variant's table stands for the fit that made it
  hash.Bytes(own.matrix.data(), own.matrix.size() * sizeof own.matrix[0]);
  hash.Bytes(columns.data(), columns.size() * sizeof columns[0]);
  hash.Value(options.size);
  hash.Value(own.kind);
  hash.Text(Name(own.brdf));
  const std::string name = "ltc-fine-" + hash.Name();
  // The columns' texels, of the matrices (two lobes' one after the other) and then of the terms.
  const std::size_t all = static_cast<std::size_t>(options.size) * static_cast<std::size_t>(options.size);
  const std::size_t matrices = own.matrix.size() / own.terms.size(), count = static_cast<std::size_t>(options.size) * columns.size();
  std::vector<glm::vec4> packed((matrices + 1) * count);
  const auto each_texel = [&](LtcTables& tables, const auto& function) {
    for (std::size_t k = 0; k < packed.size(); ++k) {
      const std::size_t square = k / count, row = k % count / columns.size(), column = static_cast<std::size_t>(columns[k % columns.size()]);
      const std::size_t texel = row * static_cast<std::size_t>(options.size) + column;
      function(packed[k], square < matrices ? tables.matrix[square * all + texel] : tables.terms[texel]);
    }
  };
  const std::size_t bytes = packed.size() * sizeof packed[0];
  if (const std::optional<std::string> stored = ReadCacheEntry(cache, name); stored && stored->size() == bytes) {
    std::memcpy(packed.data(), stored->data(), bytes);
    LtcTables fine{own.brdf, own.kind, OwnStorage(own.brdf, own.kind), options.size, std::vector<glm::vec4>(matrices * all), std::vector<glm::vec4>(all)};
    each_texel(fine, [](const glm::vec4& kept, glm::vec4& texel) { texel = kept; });
    return fine;
  }
  LtcTables fine = FitLtcColumns(own.brdf, own.kind, options, columns);
  each_texel(fine, [](glm::vec4& kept, const glm::vec4& texel) { kept = texel; });
  WriteCacheEntry(cache, name, std::string_view(reinterpret_cast<const char*>(packed.data()), bytes));
  return fine;
}

std::optional<std::string> WhyNoCauses(const Variant& variant, const Scene& scene) {
  if (!variant.options.contains("fit")) return "only variants of transformed cosines are split by cause";
  if (scene.diffuse != Brdf::kLambert) return "only Lambert's diffuse BRDF is split by cause";
  if (scene.aperture || scene.sky) return "apertures and skies are not split by cause";
  if (std::ranges::any_of(scene.lights, [](const Light& light) { return light.shape == LightShape::kTube; })) return "tubes are not split by cause";
  return WhyUnsupported(variant, scene);
}

std::vector<CausePicture> SplitByCause(Renderer& renderer, const ShaderLibrary& library, const Variant& variant, const Scene& scene,
                                       glm::ivec2 size, const RadianceImage& image, const RadianceImage& truth,
                                       const TruthOptions& truth_options, const std::filesystem::path& cache) {
  const auto in_double = [&](const Variant& form) { return InDouble(renderer.Shade(form, Precision::kDouble)); };
  const LobePictures text = in_double(variant);
  Scene plain = scene;
  bool textured = false;
  for (Light& light : plain.lights) {
    textured = textured || light.texture;
    light.texture = nullptr;
  }
  const SurfacePixels& pixels = renderer.DrawScene(plain, size);
  const LobePictures plain_truth = textured ? InDouble(CachedTruth(plain, pixels, truth_options, cache).radiance) : InDouble(truth);
  const LobePictures whole_truth = InDouble(truth);
  const LobePictures ratio{Ratio(whole_truth.diffuse, plain_truth.diffuse), Ratio(whole_truth.specular, plain_truth.specular)},
      one{std::vector(pixels.size(), glm::dvec3(1.0)), std::vector(pixels.size(), glm::dvec3(1.0))};
  const LobePictures plain_text = textured ? in_double(variant) : text;
  const Variant exact_edge = With(variant, "edge", "arctangent"), exact_proxy = With(exact_edge, "sphere", "exact");
  const LobePictures with_exact_edge = in_double(exact_edge), with_exact_proxy = exact_proxy == exact_edge ? with_exact_edge : in_double(exact_proxy);

  const bool hill = variant.options.contains("sphere");
  LtcForm form{OwnTables(variant, library, scene.brdf), variant.options.at("fresnel") == "direction"};
  LtcForm fine = form;
  fine.tables = FineTables(form.tables, pixels, cache);
  const LobePictures of_fine = LtcPicture(plain, pixels, fine), of_both = LtcPicture(plain, pixels, form);
  if (hill) {
    form.straight = form.round = LtcHorizon::kProxy;
  } else {
    form.straight = variant.options.at("horizon") == "true" ? LtcHorizon::kBoth : variant.options.at("clip") == "none" ? LtcHorizon::kNone : LtcHorizon::kLobe;
    form.round = variant.options.at("disk") == "proxy" ? LtcHorizon::kProxy : LtcHorizon::kLobe;
  }
  const LobePictures of_own = LtcPicture(plain, pixels, form);

  std::vector<CausePicture> causes{{"fit", Less(of_fine, plain_truth, ratio)},
                                   {"interpolation", Less(of_both, of_fine, ratio)},
                                   {"horizon", Less(of_own, of_both, ratio)},
                                   {"edge", Less(plain_text, with_exact_edge, ratio)},
                                   {"texture", Less(text, plain_text, one)},
                                   {"rounding", Less(InDouble(image), text, one)}};
  const std::vector<glm::dvec3> form_of_proxy = Less(with_exact_edge, with_exact_proxy, ratio), total = Less(InDouble(image), whole_truth, one);
  CausePicture remainder{"remainder", total};
  for (std::size_t i = 0; i < total.size(); ++i) {
    causes[2].error[i] += form_of_proxy[i];
    // What the textures do to the text, less what they do to the truth.
    causes[4].error[i] += plain_text.diffuse[i] * (1.0 - ratio.diffuse[i]) + plain_text.specular[i] * (1.0 - ratio.specular[i]);
    for (const CausePicture& cause : causes) remainder.error[i] -= cause.error[i];
  }
  causes.push_back(std::move(remainder));
  renderer.DrawScene(scene, size);
  return causes;
}

}  // namespace arealab
