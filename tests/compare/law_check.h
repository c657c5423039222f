// Measures by how much a technique's forms miss each law of glsl/technique.h, for every shape, lobe and BRDF that the
// header names, and judges that against what the header says.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <optional>

#include "tests/compare/technique_laws.h"

namespace arealab {

struct LawMeasure {
  std::string law, variant, lobe;
  LightShape shape = LightShape::kRectangle;
  Brdfs brdfs;
  std::map<std::string, std::string> choices;  // the variant's options
  double error = 0.0;                          // relative RMSE
};

// What counts as kept, relative RMSE in double: the inputs' rounding to float, the polynomials of clips and edges, the truth's own
// tolerance. Measured where a law is kept: at most 1.6e-4 (`lambert_sphere` of ltc), but for the limits, whose light and lobe are finite.
inline double KeptBelow(const std::string& law) {
  if (law == "radiance") return 0.0;
  if (law == "mirror_limit") return 1e-2;  // at alpha = 1e-4
  return law == "point_limit" || law.starts_with("specular_") ? 2e-3 : 2e-4;  // at a size of 1e-3
}

class LawCheck {
 public:
  // With GGX the default and published form and the default with any one option chosen otherwise, the two forms with every other BRDF
  // that the header names, of the diffuse ones the diffuse lobe alone. In double: a law is the mathematics'; what rounding does to it `arealab stress` shows.
  std::vector<LawMeasure> Measure(const Technique& technique) {
    std::vector<LawMeasure> measures;
    const std::vector<Technique> alone{technique};
    const std::vector<Variant> forms = DefaultVariants(alone);
    const auto options_away = [&](const Variant& variant) {
      return std::ranges::count_if(variant.options, [&](const auto& option) { return forms.front().options.at(option.first) != option.second; });
    };
    for (const Variant& variant : AllVariants(alone)) {
      const bool is_form = std::ranges::count(forms, variant) > 0;
      if (!is_form && options_away(variant) > 1) continue;
      for (const std::string& name : technique.brdfs) {
        const Brdf brdf = *std::ranges::find(kBrdfs, name, [](Brdf b) { return std::string(Name(b)); });
        if (brdf == Brdf::kGgx || is_form) MeasureForm(variant, brdf, is_form || DepartsByName(technique, variant), measures);
      }
      for (const Brdf diffuse : kDiffuseBrdfs) {
        // Its double text takes minutes with two lobes; tests/compare/reference_technique_test.cpp holds it to the truth.
        const bool known = std::ranges::count(technique.diffuse_brdfs, Name(diffuse)) > 0 && technique.name != "reference";
        if (diffuse != Brdf::kLambert && known && is_form) MeasureForm(variant, {Brdf::kGgx, diffuse}, true, measures);
      }
    }
    return measures;
  }

  // One line for each statement of the header that the measures contradict, and for each that it owes.
  static std::vector<std::string> Judge(const Technique& technique, const std::vector<LawMeasure>& measures) {
    std::vector<std::string> complaints;
    std::vector<double> largest(technique.departures.size(), -1.0);
    std::vector<bool> departs(technique.departures.size(), false);
    for (const LawMeasure& m : measures) {
      bool covered = false;
      for (std::size_t i = 0; i < largest.size(); ++i) {
        if (!Covers(technique.departures[i], m)) continue;
        covered = true;
        largest[i] = std::max(largest[i], m.error);
        if (!(m.error <= KeptBelow(m.law))) departs[i] = true;
      }
      const bool stated = std::ranges::count(technique.exact, m.law) > 0 || Held(m.law);
      if (!stated && !covered && !Claimable(m.law))
        complaints.push_back(fmt::format("{}: the header neither claims {} nor departs from it", Where(m), m.law));
      if (stated && !covered && !(m.error <= KeptBelow(m.law)))
        complaints.push_back(fmt::format("{}: {} is off by {:.3g}", Where(m), m.law, m.error));
    }
    for (const std::string& law : technique.exact) {
      if (std::ranges::find(measures, law, &LawMeasure::law) == measures.end())
        complaints.push_back(fmt::format("{}: nothing measures {}", technique.name, law));
    }
    for (std::size_t i = 0; i < largest.size(); ++i) {
      const Departure& d = technique.departures[i];
      const double slack = 0.15;  // relative: the figure has two digits
      if (!departs[i])
        complaints.push_back(fmt::format("{}: departs from {} by {:.3g}: that is none", technique.name, d.law, largest[i]));
      else if (!(std::abs(largest[i] - d.error) <= slack * d.error))
        complaints.push_back(
            fmt::format("{}: departs from {} {} by {:.3g}, the header says {:.3g}", technique.name, d.law, d.lobe, largest[i], d.error));
    }
    return complaints;
  }

  static std::string Where(const LawMeasure& m) {
    return fmt::format("{}, {} {} {} {}", m.variant, Name(m.shape), m.lobe, Name(m.brdfs.specular), Name(m.brdfs.diffuse));
  }

 private:
  enum Kind { kPlain, kSmall, kMirror };
  static constexpr std::size_t kCases = 64;  // of each shape

  // Cases of one kind and their truths.
  struct Batch {
    std::vector<PointCase> cases;
    std::map<std::pair<Brdf, Brdf>, std::vector<Shaded>> truth;
  };

  static bool Held(const std::string& law) { return law == "scale" || law == "rotation" || law == "radiance"; }
  static bool Claimable(const std::string& law) { return law.starts_with("lambert_") || law.starts_with("specular_"); }

  static bool Covers(const Departure& d, const LawMeasure& m) {
    if (d.law != m.law || (!d.lobe.empty() && d.lobe != m.lobe)) return false;
    std::map<std::string, std::string> choices = m.choices;
    choices["shape"] = Name(m.shape);
    choices["brdf"] = Name(m.brdfs.specular);
    choices["diffuse"] = Name(m.brdfs.diffuse);
    return std::ranges::all_of(d.when, [&](const auto& when) { return std::ranges::count(when.second, choices.at(when.first)) > 0; });
  }

  // Lights of all kinds, also cut by the horizon; the same very small; over a mirror.
  Batch& BatchOf(LightShape shape, Kind kind) {
    Batch& batch = batches_[{shape, kind}];
    PointRandom random(100 + kind);
    while (batch.cases.size() < kCases) {
      PointCase c = RandomPoint(random, shape);
      if (shape == LightShape::kPolygon) SetOutline(c, RandomOutline(random, 3 + static_cast<int>(batch.cases.size()) % 6, c.half_size));
      c.f0 = random(0.1, 1.0);
      if (kind == kSmall && !MakeSmall(c, random)) continue;
      if (kind == kMirror && !MakeMirror(c, random)) continue;
      batch.cases.push_back(c.Rounded());
    }
    return batch;
  }

  const std::vector<Shaded>& TruthOfBatch(LightShape shape, Kind kind, Brdfs brdfs) {
    Batch& batch = BatchOf(shape, kind);
    std::vector<Shaded>& truth = batch.truth[{brdfs.specular, brdfs.diffuse}];
    if (truth.empty()) truth = TruthOf(batch.cases, 1e-4, brdfs);
    return truth;
  }

  static bool MakeSmall(PointCase& c, PointRandom& random) {
    const glm::dvec3 to_light = glm::normalize(c.center - c.position);
    Enlarge(c, 1e-3);
    c.roughness = random(0.3, 1.0);
    return glm::dot(c.normal, to_light) > 0.2 && glm::dot(c.light_normal, -to_light) > 0.2 && glm::dot(c.normal, c.to_view) > 0.2;
  }

  // The mirror ray meets the light well inside, or passes it by.
  static bool MakeMirror(PointCase& c, PointRandom& random) {
    const bool hit = random(0.0, 1.0) < 0.7;
    const double reach = hit ? 0.5 : 2.0;
    const double y = random(-1.0, 1.0), x = random(-1.0, 1.0);
    const glm::dvec3 target = c.center + reach * x * c.half_size.x * c.axis_x + reach * y * c.half_size.y * c.axis_y;
    const glm::dvec3 to_target = glm::normalize(target - c.position);
    c.normal = glm::normalize(to_target + c.to_view);
    c.roughness = 0.02;
    if (glm::dot(c.normal, c.to_view) < 0.3 || glm::dot(c.light_normal, -to_target) < 0.3) return false;
    PointCase sharper = c;
    sharper.roughness = 0.01;
    const double at = c.Truth(1e-3).specular, limit = sharper.Truth(1e-3).specular;
    c.roughness = 0.01;
    return std::abs(at - limit) < 0.01 && (hit || limit < 0.01);
  }

  static std::vector<PointCase> Changed(std::vector<PointCase> cases, const std::function<void(PointCase&)>& change) {
    for (PointCase& c : cases) change(c);
    return cases;
  }

  // Whether the header says of a choice that it departs from a law of polygons or ellipses.
  static bool DepartsByName(const Technique& technique, const Variant& variant) {
    return std::ranges::any_of(technique.departures, [&](const Departure& departure) {
      if (!departure.law.ends_with("_polygon") && !departure.law.ends_with("_ellipse")) return false;
      return std::ranges::all_of(departure.when, [&](const auto& when) {
        const auto option = variant.options.find(when.first);
        return option == variant.options.end() || std::ranges::count(when.second, option->second) > 0;
      });
    });
  }

  static void Enlarge(PointCase& c, double scale) {
    c.half_size *= scale;
    for (glm::dvec2& corner : c.corners) corner *= scale;
  }

  // One half of a light, where its halves are lights of its shape; a polygon is cut from the middle of a side to a corner.
  static void Halve(PointCase& c, double side) {
    if (c.shape == LightShape::kPolygon) {
      const std::vector<glm::dvec2> all = c.corners;
      const std::size_t across = (all.size() + 1) / 2;
      std::vector<glm::dvec2> half{0.5 * (all[0] + all[1])};
      if (side > 0.0) {
        half.insert(half.end(), all.begin() + 1, all.begin() + static_cast<std::ptrdiff_t>(across) + 1);
      } else {
        half.insert(half.end(), all.begin() + static_cast<std::ptrdiff_t>(across), all.end());
        half.push_back(all[0]);
      }
      SetOutline(c, half);
    }
    if (c.shape != LightShape::kRectangle && c.shape != LightShape::kTube) return;
    c.half_size.x *= 0.5;
    c.center += side * c.half_size.x * c.axis_x;
  }

  // `all_shapes`: polygons and ellipses too, which make programs long; the forms stand for the choices that no header names there.
  void MeasureForm(const Variant& variant, Brdfs brdfs, bool all_shapes, std::vector<LawMeasure>& measures) {
    std::vector<LightShape> shapes;
    for (const LightShape shape : variant.technique->shapes) {
      // The reference's double text takes minutes over these; tests/compare/polygon_technique_test.cpp holds it to the truth.
      if ((!all_shapes || variant.technique->name == "reference") && (shape == LightShape::kPolygon || shape == LightShape::kEllipse)) continue;
      Scene scene;
      scene.brdf = brdfs.specular;
      scene.diffuse = brdfs.diffuse;
      scene.lights.resize(1);
      scene.lights[0].shape = shape;
      if (!WhyUnsupported(variant, scene)) shapes.push_back(shape);
    }
    // All shapes at once: one program.
    const auto all = [&](Kind kind) {
      std::vector<PointCase> cases;
      for (const LightShape shape : shapes) std::ranges::copy(BatchOf(shape, kind).cases, std::back_inserter(cases));
      return cases;
    };
    const auto truth = [&](Kind kind) {
      std::vector<Shaded> truths;
      for (const LightShape shape : shapes) std::ranges::copy(TruthOfBatch(shape, kind, brdfs), std::back_inserter(truths));
      return truths;
    };
    const auto shade = [&](const std::vector<PointCase>& cases) {
      PointOptions options;
      options.precision = Precision::kDouble;
      options.brdfs = brdfs;
      return points_.Shade(variant, cases, options);
    };
    // `only`: of one shape. Each lobe is the same text whatever the other's BRDF.
    const bool lambert = brdfs.diffuse == Brdf::kLambert;
    const auto measure = [&](const std::string& law, const std::vector<Shaded>& result, const std::vector<Shaded>& expected,
                             bool diffuse, bool specular, std::optional<LightShape> only = {}) {
      for (std::size_t s = 0; s < shapes.size(); ++s) {
        if (only && shapes[s] != *only) continue;
        const auto part = [&](const std::vector<Shaded>& of) { return std::vector<Shaded>(of.begin() + s * kCases, of.begin() + (s + 1) * kCases); };
        const auto add = [&](const char* lobe, double Shaded::*value) {
          measures.push_back({law, variant.Name(), lobe, shapes[s], brdfs, variant.options, RelativeRmse(part(result), part(expected), value)});
        };
        if (diffuse && variant.technique->diffuse && brdfs.specular == Brdf::kGgx) add("diffuse", &Shaded::diffuse);
        if (specular && variant.technique->specular && lambert) add("specular", &Shaded::specular);
      }
    };
    if (shapes.empty()) return;
    const std::vector<PointCase> cases = all(kPlain);
    const std::vector<Shaded> plain = shade(cases);
    for (const LightShape shape : shapes) {
      if (!lambert) break;  // not what these laws are about
      measure(fmt::format("lambert_{}", Name(shape)), plain, truth(kPlain), true, false, shape);
      measure(fmt::format("specular_{}", Name(shape)), plain, truth(kPlain), false, true, shape);
    }
    measure("point_limit", shade(all(kSmall)), truth(kSmall), true, true);
    if (lambert) measure("mirror_limit", shade(all(kMirror)), truth(kMirror), false, true);
    const auto enlarge = [](PointCase& c) {
      c.center = 1000.0 * c.center;
      Enlarge(c, 1000.0);
    };
    measure("scale", shade(Changed(cases, enlarge)), plain, true, true);
    const glm::dmat3 turn = TurnedFrame();
    const auto rotate = [&](PointCase& c) {
      for (glm::dvec3* v : {&c.position, &c.normal, &c.to_view, &c.center, &c.axis_x, &c.axis_y, &c.light_normal}) *v = turn * *v;
    };
    measure("rotation", shade(Changed(cases, rotate)), plain, true, true);
    std::vector<Shaded> doubled = plain;
    for (Shaded& s : doubled) s = {2.0 * s.diffuse, 2.0 * s.specular};
    measure("radiance", shade(Changed(cases, [](PointCase& c) { c.radiance = 2.0; })), doubled, true, true);
    const std::array halved{LightShape::kRectangle, LightShape::kPolygon, LightShape::kTube};
    if (std::ranges::find_first_of(shapes, halved) == shapes.end()) return;
    std::vector<Shaded> sum = shade(Changed(cases, [](PointCase& c) { Halve(c, 1.0); }));
    const std::vector<Shaded> other = shade(Changed(cases, [](PointCase& c) { Halve(c, -1.0); }));
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] = {sum[i].diffuse + other[i].diffuse, sum[i].specular + other[i].specular};
    for (const LightShape shape : halved) measure("additive", sum, plain, true, true, shape);
  }

  static glm::dmat3 TurnedFrame() {
    const glm::dvec3 x = glm::normalize(glm::dvec3(0.3, -0.8, 0.5)), z = glm::normalize(glm::cross(x, glm::dvec3(0.9, 0.2, -0.4)));
    return {x, glm::cross(z, x), z};
  }

  TechniquePoints points_;
  std::map<std::pair<LightShape, Kind>, Batch> batches_;
};

}  // namespace arealab
