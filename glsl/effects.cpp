#include "glsl/effects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "glsl/light_block.h"
#include "scenes/error.h"

namespace arealab {
namespace {

// On or off, and why.
struct Verdict {
  bool on = true;
  std::string reason;
};

// A stand-in for a light of bounding radius R is round and no larger than R seen from its centre's distance d, and its direction
// is one of the light's: a sphere of the light's form factor, or a cap of its solid angle. With the centre at height h
// over the horizon, (h − R)/(d + R) ≥ R/d suffices for it to stand clear, and since d ≥ h that holds from h = (1 + √2) R.
const double kStandInRadii = 1.0 + std::sqrt(2.0);

// Of lengths: float positions and normals, and the shading text's own rounding.
constexpr double kMargin = 1e-5;

std::string Called(const Light& light, std::size_t i) {
  return light.name.empty() ? fmt::format("light {}", i + 1) : fmt::format("light \"{}\"", light.name);
}

std::string WithArticle(LightShape shape) { return fmt::format("{} {}", shape == LightShape::kEllipse ? "an" : "a", Name(shape)); }

double BoundingRadius(const Light& light) {
  switch (light.shape) {
    case LightShape::kRectangle:
    case LightShape::kTube:
      return std::hypot(light.half_size.x, light.half_size.y);
    case LightShape::kDisk:
    case LightShape::kSphere:
    case LightShape::kEllipse:
      return std::max(light.half_size.x, light.half_size.y);
    case LightShape::kPolygon:
      break;
  }
  double radius = 0.0;
  for (const glm::dvec2& corner : light.corners) radius = std::max(radius, glm::length(corner));
  return radius;
}

// How far the light reaches from its centre along `direction` of any length or against it, times that length; convex in it.
double Reach(const Light& light, const glm::dvec3& direction) {
  const double x = light.half_size.x * glm::dot(direction, light.axis_x);
  const double y = light.half_size.y * glm::dot(direction, light.axis_y);
  switch (light.shape) {
    case LightShape::kRectangle:
      return std::abs(x) + std::abs(y);
    case LightShape::kTube:
      return std::abs(x) + light.half_size.y * glm::length(glm::cross(direction, light.axis_x));
    case LightShape::kPolygon: {
      double reach = 0.0;
      const glm::dvec2 slope(glm::dot(direction, light.axis_x), glm::dot(direction, light.axis_y));
      for (const glm::dvec2& corner : light.corners) reach = std::max(reach, std::abs(glm::dot(corner, slope)));
      return reach;
    }
    case LightShape::kDisk:
    case LightShape::kEllipse:
      return std::hypot(x, y);
    case LightShape::kSphere:
      return light.half_size.x * glm::length(direction);
  }
  return std::numeric_limits<double>::infinity();
}

// Whether there are points that see nothing of it.
bool HasBack(LightShape shape) { return shape != LightShape::kSphere; }

bool IsPureMetal(const Material& material) {
  return material.metalness >= 1.0f && !material.metallic_roughness_texture;
}

bool IsGrey(const glm::dvec3& color) { return color.x == color.y && color.y == color.z; }
bool IsGrey(const Image& image) {
  return std::ranges::all_of(image.pixels, [](const glm::vec4& p) { return p.r == p.g && p.g == p.b; });
}

// Reasons for which an effect of the geometry is on; empty ones are proven off.
struct GeometryNeeds {
  std::optional<std::string> two_sided, behind, turned_away, horizon, proxy_horizon;
  bool any_two_sided = false, any_back = false;  // among the lights: without them two_sided and behind are off anyway

  // Whether nothing is left to find.
  bool All() const { return (two_sided || !any_two_sided) && (behind || !any_back) && turned_away && horizon && proxy_horizon; }
};

// The corners of a triangle, its normals anywhere between the corners' own.
struct Patch {
  glm::dvec3 position[3];
  glm::dvec3 normal[3];
  double size = 0.0;  // greatest distance from the origin, for the margin
};

struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void Include(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  // Whether all of it is clear of 0.
  bool Clear(double margin) const { return low > margin || high < -margin; }
};

// Between which heights over the patch's horizons everything within `reach(normal)` of `center` lies.
//
// A point of the patch is p = Σ w_j p_j with the normal n ∥ Σ w_i n_i. Before it is made unit, n·(c − p) = Σ w_i w_j n_i·(c − p_j), so it
// lies between the least and the greatest of the nine products, and a convex reach is at most Σ w_i reach(n_i). Making n unit divides
// by at most 1: what is clear of 0 stays clear.
template <typename ReachOf>
Range Heights(const Patch& patch, const glm::dvec3& center, const ReachOf& reach) {
  Range heights;
  for (const glm::dvec3& normal : patch.normal) {
    const double around = reach(normal);
    for (const glm::dvec3& position : patch.position) {
      const double height = glm::dot(normal, center - position);
      heights.Include(height - around);
      heights.Include(height + around);
    }
  }
  return heights;
}

// Between which heights over the light's plane the patch lies. Of a tube: over a plane along it that touches it, which all of the patch
// lies above where it lies above any; below one it may still lie above another.
Range Before(const Light& light, const Patch& patch) {
  glm::dvec3 normal = light.normal;
  double radius = 0.0;
  Range before;
  if (light.shape == LightShape::kTube) {
    const glm::dvec3 middle = (patch.position[0] + patch.position[1] + patch.position[2]) / 3.0 - light.center;
    const glm::dvec3 across = middle - light.axis_x * glm::dot(middle, light.axis_x);
    normal = across / std::max(glm::length(across), 1e-300);
    radius = light.half_size.y;
    before.high = std::numeric_limits<double>::infinity();
  }
  for (const glm::dvec3& position : patch.position) before.Include(glm::dot(normal, position - light.center) - radius);
  return before;
}

class Analysis {
 public:
  explicit Analysis(const Scene& scene) : scene_(scene), lights_(EmittingLights(scene)) {
    std::set<int> used;
    for (const Mesh& mesh : scene.meshes) {
      if (!mesh.indices.empty()) used.insert(mesh.material);
    }
    for (const int i : used) materials_.push_back(&scene.materials.at(static_cast<std::size_t>(i)));
  }

  Verdict Shape(LightShape shape) const {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      if (lights_[i].shape == shape) return {true, fmt::format("{} is {}", Called(lights_[i], i), WithArticle(shape))};
    }
    return {false, fmt::format("no light that emits is {}", WithArticle(shape))};
  }

  // An ellipse is shaded by the text for disks.
  Verdict Disk() const {
    const Verdict ellipse = Shape(LightShape::kEllipse);
    return ellipse.on ? ellipse : Shape(LightShape::kDisk);
  }

  // Of what the text itself compares (FaceLight), twice as much.
  Verdict Thin() const {
    const std::vector<glm::vec4> rows = LightBlockRows(lights_);
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      const float area = rows[i * kLightRows + 4].w;
      const glm::vec4& products = rows[i * kLightRows + 7];
      if (!(area > 2e-7f * (products.x + products.y) && area > 2e-30f)) return {true, Called(lights_[i], i) + " has hardly any area"};
    }
    return {false, "every light has an area that a float tells from none"};
  }

  Verdict TwoSided() {
    if (std::none_of(lights_.begin(), lights_.end(), [](const Light& light) { return light.two_sided && IsFlat(light.shape); })) {
      return {false, "no light is lit on both sides"};
    }
    return OfGeometry(&GeometryNeeds::two_sided, "whatever is lit by a two-sided light lies before its front");
  }

  Verdict Behind() {
    if (std::none_of(lights_.begin(), lights_.end(), [](const Light& light) { return HasBack(light.shape); })) return {false, "spheres have no back"};
    return OfGeometry(&GeometryNeeds::behind, "every surface lies before the lit side of every light, and beside every tube");
  }

  Verdict TurnedAway() {
    return OfGeometry(&GeometryNeeds::turned_away, "no surface turns its shading normal from the camera");
  }

  Verdict Horizon() {
    return OfGeometry(&GeometryNeeds::horizon,
                      "every light is wholly above or wholly below the horizon of every point that it faces and the camera sees");
  }

  Verdict ProxyHorizon() {
    return OfGeometry(&GeometryNeeds::proxy_horizon,
                      "every light is 2.42 of its radii clear of every horizon, so that a round stand-in for it is clear too");
  }

  Verdict Diffuse() const {
    for (const Material* material : materials_) {
      if (!IsPureMetal(*material) && material->base_color != glm::vec3(0.0f)) {
        return {true, fmt::format("material \"{}\" is not pure metal", material->name)};
      }
    }
    return {false, "every material is pure metal or black"};
  }

  Verdict Specular() const {
    for (const Material* material : materials_) {
      if (HasLobe(*material)) {
        return {true, fmt::format("material \"{}\" has a specular lobe", material->name)};
      }
    }
    return {false, "every material is matte: a non-metal of specular = 0"};
  }

  Verdict SpecularWeight() const {
    if (!Specular().on) return {false, "no material has a specular lobe to weigh"};
    for (const Material* material : materials_) {
      if (material->specular != 1.0f) {
        return {true, fmt::format("material \"{}\" has specular = {}", material->name, material->specular)};
      }
    }
    return {false, "every material has its full specular lobe"};
  }

  Verdict Fresnel() const {
    if (!Specular().on) return {false, "no material has a specular lobe"};
    for (const Material* material : materials_) {
      // F0 = mix(0.04, base colour, metalness) is 1 in every channel, everywhere.
      const bool reflects_all = IsPureMetal(*material) && !material->base_color_texture &&
                                glm::all(glm::greaterThanEqual(material->base_color, glm::vec3(1.0f)));
      if (HasLobe(*material) && !reflects_all) {
        return {true, fmt::format("material \"{}\" reflects less than all light at normal incidence", material->name)};
      }
    }
    return {false, "every material reflects all light at normal incidence already"};
  }

  Verdict Metal() const {
    for (const Material* material : materials_) {
      if (material->metalness > 0.0f || material->metallic_roughness_texture) return {true, fmt::format("material \"{}\" is metallic", material->name)};
    }
    return {false, "no material is metallic"};
  }

  Verdict LightColor() const {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      if (!IsGrey(lights_[i].radiance)) return {true, Called(lights_[i], i) + " is coloured"};
      if (lights_[i].texture && !IsGrey(*lights_[i].texture)) {
        return {true, Called(lights_[i], i) + " has a coloured texture"};
      }
    }
    if (scene_.sky && !IsGrey(scene_.sky->radiance)) return {true, "the sky is coloured"};
    if (scene_.sky && scene_.sky->texture && !IsGrey(*scene_.sky->texture)) return {true, "the sky has a coloured texture"};
    return {false, "every light is white"};
  }

  Verdict Textured() const {
    for (std::size_t i = 0; i < lights_.size(); ++i) {
      if (lights_[i].texture) return {true, Called(lights_[i], i) + " shows a texture"};
    }
    return {false, "every light is as bright all over"};
  }

  Verdict MaterialColor() const {
    for (const Material* material : materials_) {
      if (material->base_color_texture) return {true, fmt::format("material \"{}\" has a colour texture", material->name)};
      if (!IsGrey(material->base_color)) return {true, fmt::format("material \"{}\" is coloured", material->name)};
    }
    return {false, "every material is grey"};
  }

  Verdict NormalMap() const {
    for (const Material* material : materials_) {
      if (material->normal_texture) return {true, fmt::format("material \"{}\" has a normal map; it bends the normals in the G-buffer, so that shading pays nothing", material->name)};
    }
    return {false, "no material has a normal map"};
  }

  Verdict Aperture() const {
    if (scene_.aperture) return {true, "the scene asks for visibility, baked into apertures"};
    return {false, "the scene asks for no visibility"};
  }

  Verdict Sky() const {
    if (scene_.sky) return {true, "the scene has a sky"};
    return {false, "the scene has no sky"};
  }

  Verdict SkyTexture() const {
    if (scene_.sky && scene_.sky->texture) return {true, "the sky shows a texture"};
    return {false, scene_.sky ? "the sky is the same everywhere" : "the scene has no sky"};
  }

  Verdict ManyLights() const {
    if (lights_.size() > 1) return {true, fmt::format("{} lights emit", lights_.size())};
    return {false, lights_.empty() ? "no light emits" : "one light emits"};
  }

 private:
  static bool HasLobe(const Material& material) {
    return material.specular > 0.0f || material.metalness > 0.0f || material.metallic_roughness_texture;
  }

  Verdict OfGeometry(std::optional<std::string> GeometryNeeds::* need, const char* off) {
    if (!geometry_) geometry_ = LookAtGeometry();
    const std::optional<std::string>& why = (*geometry_).*need;
    return why ? Verdict{true, *why} : Verdict{false, off};
  }

  GeometryNeeds LookAtGeometry() const {
    GeometryNeeds needs;
    for (const Light& light : lights_) {
      needs.any_back = needs.any_back || HasBack(light.shape);
      needs.any_two_sided = needs.any_two_sided || (IsFlat(light.shape) && light.two_sided);
    }
    for (const Mesh& mesh : scene_.meshes) {
      const Material& material = scene_.materials.at(static_cast<std::size_t>(mesh.material));
      for (std::size_t i = 0; i + 2 < mesh.indices.size() && !needs.All(); i += 3) {
        Patch patch;
        for (std::size_t corner = 0; corner < 3; ++corner) {
          const Vertex& vertex = mesh.vertices.at(mesh.indices[i + corner]);
          patch.position[corner] = glm::dvec3(vertex.position);
          patch.normal[corner] = glm::dvec3(vertex.normal);
          patch.size = std::max(patch.size, glm::length(patch.position[corner]));
        }
        LookAtPatch(patch, material, needs);
      }
    }
    return needs;
  }

  void LookAtPatch(const Patch& patch, const Material& material, GeometryNeeds& needs) const {
    const auto because = [](std::optional<std::string>& need, const auto& reason) {
      if (!need) need = reason();
    };
    const bool bent = material.normal_texture != nullptr;
    const auto bends = [&] { return fmt::format("the normal map of material \"{}\" may turn its horizon any way", material.name); };
    const double view_margin = kMargin * (patch.size + glm::length(scene_.camera.position));
    const Range to_view = Heights(patch, scene_.camera.position, [](const glm::dvec3&) { return 0.0; });
    if (bent) {
      because(needs.turned_away, bends);
    } else {
      if (!(to_view.low > view_margin)) {
        because(needs.turned_away, [&] {
          return fmt::format("some of material \"{}\" turns from the camera or may seem to", material.name);
        });
      }
      if (to_view.high < -view_margin) return;  // black, whatever the lights do
    }
    for (std::size_t l = 0; l < lights_.size() && !needs.All(); ++l) {
      const Light& light = lights_[l];
      const double radius = BoundingRadius(light);
      const double margin = kMargin * (patch.size + glm::length(light.center) + radius);
      if (HasBack(light.shape)) {
        const Range before = Before(light, patch);
        if (!(before.low > margin)) {
          const auto behind = [&] {
            return fmt::format("some of material \"{}\" lies {} {}", material.name, IsFlat(light.shape) ? "behind" : "within the width of", Called(light, l));
          };
          because(needs.behind, behind);
          if (light.two_sided) because(needs.two_sided, [&] { return behind() + ", which is lit on both sides"; });
        }
        if (before.high < -margin && !light.two_sided) continue;  // unlit
      }
      if (bent) {
        because(needs.horizon, bends);
        because(needs.proxy_horizon, bends);
        continue;
      }
      if (needs.proxy_horizon && needs.horizon) continue;
      const Range stand_in =
          Heights(patch, light.center, [&](const glm::dvec3& n) { return kStandInRadii * radius * glm::length(n); });
      if (stand_in.Clear(margin)) continue;
      because(needs.proxy_horizon, [&] {
        return fmt::format("{} is within 2.42 of its radii of a horizon of material \"{}\"", Called(light, l), material.name);
      });
      const Range whole = Heights(patch, light.center, [&](const glm::dvec3& n) { return Reach(light, n); });
      if (whole.Clear(margin)) continue;
      because(needs.horizon, [&] { return fmt::format("{} may cross a horizon of material \"{}\"", Called(light, l), material.name); });
    }
  }

  const Scene& scene_;
  std::vector<Light> lights_;                // that emit
  std::vector<const Material*> materials_;   // that are used
  std::optional<GeometryNeeds> geometry_;
};

struct Rule {
  const char* name;
  Verdict (*decide)(Analysis&);
};

constexpr Rule kRules[] = {
    {"rectangle", [](Analysis& scene) { return scene.Shape(LightShape::kRectangle); }},
    {"disk", [](Analysis& scene) { return scene.Disk(); }},
    {"sphere", [](Analysis& scene) { return scene.Shape(LightShape::kSphere); }},
    {"polygon", [](Analysis& scene) { return scene.Shape(LightShape::kPolygon); }},
    {"ellipse", [](Analysis& scene) { return scene.Shape(LightShape::kEllipse); }},
    {"tube", [](Analysis& scene) { return scene.Shape(LightShape::kTube); }},
    {"thin", [](Analysis& scene) { return scene.Thin(); }},
    {"two_sided", [](Analysis& scene) { return scene.TwoSided(); }},
    {"behind", [](Analysis& scene) { return scene.Behind(); }},
    {"turned_away", [](Analysis& scene) { return scene.TurnedAway(); }},
    {"horizon", [](Analysis& scene) { return scene.Horizon(); }},
    {"proxy_horizon", [](Analysis& scene) { return scene.ProxyHorizon(); }},
    {"diffuse", [](Analysis& scene) { return scene.Diffuse(); }},
    {"specular", [](Analysis& scene) { return scene.Specular(); }},
    {"specular_weight", [](Analysis& scene) { return scene.SpecularWeight(); }},
    {"fresnel", [](Analysis& scene) { return scene.Fresnel(); }},
    {"metal", [](Analysis& scene) { return scene.Metal(); }},
    {"light_color", [](Analysis& scene) { return scene.LightColor(); }},
    {"material_color", [](Analysis& scene) { return scene.MaterialColor(); }},
    {"normal_map", [](Analysis& scene) { return scene.NormalMap(); }},
    {"aperture", [](Analysis& scene) { return scene.Aperture(); }},
    {"textured", [](Analysis& scene) { return scene.Textured(); }},
    {"sky", [](Analysis& scene) { return scene.Sky(); }},
    {"sky_texture", [](Analysis& scene) { return scene.SkyTexture(); }},
    {"many_lights", [](Analysis& scene) { return scene.ManyLights(); }},
};

Effect Decide(const Rule& rule, Analysis& analysis) {
  Verdict verdict = rule.decide(analysis);
  return {rule.name, verdict.on, std::move(verdict.reason)};
}

}  // namespace

std::string Effect::Define() const {
  std::string define = "EFFECT_" + name;
  std::transform(define.begin(), define.end(), define.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return define;
}

std::vector<Effect> SceneEffects(const Scene& scene) {
  Analysis analysis(scene);
  std::vector<Effect> effects;
  for (const Rule& rule : kRules) effects.push_back(Decide(rule, analysis));
  return effects;
}

Effect SceneEffect(const Scene& scene, const std::string& name) {
  Analysis analysis(scene);
  for (const Rule& rule : kRules) {
    if (name == rule.name) return Decide(rule, analysis);
  }
  throw InputError(fmt::format("unknown effect \"{}\"; expected one of {}", name, fmt::join(EffectNames(), ", ")));
}

std::vector<std::string> EffectNames() {
  std::vector<std::string> names;
  for (const Rule& rule : kRules) names.emplace_back(rule.name);
  return names;
}

EffectDefines Defines(const std::vector<Effect>& effects, const std::map<std::string, bool>& forced) {
  EffectDefines defines;
  for (const Effect& effect : effects) {
    const auto found = forced.find(effect.name);
    defines.emplace_back(effect.Define(), found == forced.end() ? effect.on : found->second);
  }
  return defines;
}

}  // namespace arealab
