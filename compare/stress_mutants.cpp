#include "compare/stress_mutants.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "compare/check.h"
#include "compare/image_files.h"
#include "compare/stress.h"
#include "glsl/renderer.h"
#include "scenes/error.h"

namespace arealab {
namespace {

namespace fs = std::filesystem;

// A folder of overrides with one changed file; removed at the end.
class MutatedText {
 public:
  explicit MutatedText(const Mutant& mutant)
      : folder_(fs::temp_directory_path() / fmt::format("arealab_mutant_{}", getpid())) {
    const std::optional<std::string> text = ShaderLibrary().Find(mutant.file);
    const std::string wanted = mutant.text;
    const auto at = text ? text->find(wanted) : std::string::npos;
    if (at == std::string::npos || text->find(wanted, at + 1) != std::string::npos) {
      throw InputError(
          fmt::format("glsl/{}: \"{}\" is not there exactly once; expected the text that a mutant changes",
                      mutant.file, wanted));
    }
    const fs::path file = folder_ / mutant.file;
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << std::string(*text).replace(at, wanted.size(), mutant.becomes);
  }
  ~MutatedText() {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }
  MutatedText(const MutatedText&) = delete;
  MutatedText& operator=(const MutatedText&) = delete;

  ShaderLibrary Library() const { return ShaderLibrary(folder_); }

 private:
  fs::path folder_;
};

std::string CaughtByStress(Context& context, const ShaderLibrary& library, const Variant& variant,
                           int cases) {
  StressOptions options;
  options.variants = {variant};
  options.judged = {true};
  options.cases = cases;
  const StressResult result = Stress(context, library, options);
  for (const FamilyResult& family : result.variants[0].families) {
    if (!family.failures.empty())
      return fmt::format("stress: {}: {}", family.family->name, family.failures[0]);
  }
  return {};
}

std::string CaughtByGolden(Context& context, const ShaderLibrary& library, const Variant& variant,
                           const fs::path& golden) {
  Renderer renderer(context.gl(), library);
  for (const fs::path& file : BuiltInScenes()) {
    const Scene scene = LoadScene(file);
    const fs::path stored = golden / scene.name / (variant.Name() + ".exr");
    if (WhyUnsupported(variant, scene) || !fs::exists(stored)) continue;
    renderer.DrawScene(scene, kCheckSize);
    const auto failure = TestGolden(renderer.Shade(variant), ReadExr(stored));
    if (failure) return fmt::format("golden: {}: {}", scene.name, failure->message);
  }
  return {};
}

}  // namespace

const std::vector<Mutant>& Mutants() {
  static const std::vector<Mutant> mutants{
      {"ltc", "ltc_shading.glsl", "light.radiance * form_factor;",
       "light.radiance * sqrt(form_factor * form_factor - 1e-12);",
       "a planted NaN: the root of a negative where there is hardly any light"},
      {"ltc", "clip/arc.glsl", "clamp(end_b * inverse_b + 1.0, 0.0, 1.0)", "end_b * inverse_b + 1.0",
       "a dropped clamp in the horizon clip"},
      {"ltc", "clip/arc.glsl",
       "return AsFormFactor(sum * (1.0 / kTurn));", "return sum * (1.0 / kTurn);",
       "a dropped max: the diffuse form factor below 0"},
      {"ltc", "clip/arc.glsl", "- t1 * u1 + closing", "- t1 * u1 - closing",
       "a wrong sign of the closing arc"},
      {"ltc", "polygon.glsl", "return d >= 0.0 ? acute : 0.5 * inversesqrt",
       "return d >= -1e30 ? acute : 0.5 * inversesqrt", "no obtuse angles"},
      {"ltc", "polygon.glsl", "const float kSmallestEdge = 1e-30;", "const float kSmallestEdge = 0.0;",
       "no guard of an edge through the point"},
      {"ltc", "ltc.glsl", "if (length2 < 1e-8) {", "if (length2 < 0.0) {",
       "no tangent where the view is the normal"},
      {"ltc", "ltc.glsl", "return vec3(m.x * v.x + m.z * v.z, v.y, m.y * v.x + m.w * v.z);",
       "return vec3(m.x * v.x + m.y * v.z, v.y, m.z * v.x + m.w * v.z);", "a transposed transform"},
      {"ltc", "polygon.glsl",
       "view.in_plane = vec3(dot(light.axis_x, to_center), dot(light.axis_y, to_center),",
       "view.in_plane = vec3(dot(light.axis_y, to_center), dot(light.axis_x, to_center),", "a swapped axis"},
      {"ltc", "polygon.glsl", "< kSmallRectangle * dot(view.in_plane, view.in_plane)", "< 0.0", "no path for far lights"},
      {"ltc", "fresnel/direction.glsl", "inversesqrt(max(dot(to_light, to_light), 1e-30))",
       "inversesqrt(dot(to_light, to_light))", "a dropped max: no light, no direction"},
      {"ltc", "light_cone.glsl", "float inverse = inversesqrt(max(distance2, 1e-30));",
       "float inverse = inversesqrt(distance2);", "no guard at a sphere's centre",
       "the next line gives the direction there, and a clamp the size"},
      {"ltc", "light_cone.glsl", "if (psi < 0.0) psi += 2.0 * kPi;", "", "an angle of the wrong turn"},
      {"ltc", "frame/mirror.glsl", "* n_dot_v + vec4", "* n_dot_v - vec4", "the frame turned the wrong way"},
      {"ltc", "directions.glsl", "a = x < 0.0 ? kPi - a : a;\n  return y < 0.0 ? -a : a;\n#else",
       "return y < 0.0 ? -a : a;\n#else", "an arctangent of one quadrant"},
      {"hill", "vector_form_factor.glsl",
       "alpha * p.z, t1 * x1 - t3 * x0 - t0 * y0 + t2 * y1);",
       "alpha * p.z, t1 * x1 - t3 * x0 + t0 * y0 + t2 * y1);",
       "a wrong sign in the vector form factor"},
      {"point", "far_field.glsl", "max(dot(to_center, to_center), kMinDistance2)",
       "dot(to_center, to_center)", "no guard at the light's centre",
       "the cosine is then no number, which is not above 0"},
      {"point", "surface.glsl", "const float kMinAlpha = 1e-4;", "const float kMinAlpha = 0.0;",
       "roughness 0 let through"},
      {"point", "specular_lobe.glsl",
       "vec3 c = cross(normal, half_vector);\n  float sin2 = min(dot(c, c), 1.0);",
       "float d = dot(normal, half_vector);\n  float sin2 = 1.0 - d * d;", "the lobe's peak by 1 - cos²"},
      {"karis", "techniques/karis.glsl", "max(dot(to_center, to_center), radius * radius)",
       "dot(to_center, to_center)", "no floor of the distance inside the sphere"},
      {"oat", "spherical_cap.glsl", "radius * radius < distance2 ? radius * radius / distance2 : 1.0",
       "radius * radius / distance2", "a sphere's sine above 1"},
      {"oat", "techniques/oat.glsl", "min(open.x / max(source.versine, 1e-30), 1.0)",
       "open.x / source.versine", "no guard of an empty cap",
       "no light that the lighting pass lets through is below 1e-30 sr"},
      {"drobot", "techniques/drobot.glsl",
       "point.z = max(point.z, 1e-6 * (light.half_size.x + light.half_size.y));", "",
       "no floor of the height over the light"},
      {"mayaux", "techniques/mayaux.glsl", "inversesqrt(max(dot(mean.f, mean.f), 1e-30))",
       "inversesqrt(dot(mean.f, mean.f) - 1e-12)", "a planted NaN in the average direction",
       "the default form does not read the direction, only its length along the normal"},
      {"light_field", "techniques/light_field.glsl", "if (!Lit(size2 >= 1e-36)) return result;", "",
       "a vector of length 0 made unit"},
      {"light_field", "lights.glsl", "light.normal = row1.xyz;", "light.normal = -row1.xyz;",
       "a light turned round"},
  };
  return mutants;
}

std::vector<MutantResult> RunMutants(Context& context, const MutantOptions& options) {
  std::vector<MutantResult> results;
  for (const Mutant& mutant : Mutants()) {
    if (options.progress) {
      options.progress(mutant.what,
                       static_cast<double>(results.size()) / static_cast<double>(Mutants().size()));
    }
    const MutatedText text(mutant);
    const ShaderLibrary library = text.Library();
    const std::vector<Technique> techniques = LoadTechniques(library);
    const Variant variant = ParseVariant(techniques, mutant.technique);
    MutantResult result{&mutant, CaughtByStress(context, library, variant, options.cases)};
    if (result.caught.empty() && !options.golden.empty()) {
      result.caught = CaughtByGolden(context, library, variant, options.golden);
    }
    results.push_back(std::move(result));
  }
  return results;
}

}  // namespace arealab
