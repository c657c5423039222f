#include "app/view/inspector.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "glsl/renderer.h"
#include "glsl/variant.h"

namespace arealab {
namespace {

class Bench {
 public:
  Bench(std::optional<ContextKind> kind, const std::filesystem::path& shader_folder)
      : context_(CreateContext(kind)), library_(shader_folder.empty() ? ShaderLibrary() : ShaderLibrary(shader_folder)) {}

  void Look(const InspectJob& job, Inspector& inspector) {
    if (!renderer_ || job.library != library_version_) {
      techniques_ = LoadTechniques(library_);
      renderer_ = std::make_unique<Renderer>(context_->gl(), library_);
      library_version_ = job.library;
    }
    const SurfacePixels& pixels = renderer_->DrawScene(*job.scene, job.size, job.effects_off);
    const std::size_t pixel = static_cast<std::size_t>(job.pixel.y) * static_cast<std::size_t>(job.size.x) + static_cast<std::size_t>(job.pixel.x);
    Inspection inspection = InspectPixel(*job.scene, pixels, pixel);
    if (!inspection.surface) return inspector.Publish(inspection);
    const std::vector<Wanted> wanted = Choose(job);
    AddLobe(job, wanted, inspection);
    inspector.Publish(inspection);

    RadianceImage image;
    const auto shade = [&](const Wanted& one, Precision precision) {
      renderer_->ShadeRows(one.variant, one.knobs, job.pixel.y, 1, image, precision);
      return Lobes{glm::dvec3(image.diffuse[pixel]), glm::dvec3(image.specular[pixel])};
    };
    // All in float first: that is what a person waits for.
    std::vector<const Wanted*> shaded;
    for (const Wanted& one : wanted) {
      if (inspector.Overtaken()) return;
      try {
        inspection.values.push_back({one.name, shade(one, Precision::kFloat), std::nullopt});
        shaded.push_back(&one);
      } catch (const std::exception&) {
        continue;  // a shader that does not compile says so where it is shown
      }
      inspector.Publish(inspection);
    }
    for (std::size_t i = 0; i < shaded.size(); ++i) {
      if (inspector.Overtaken()) return;
      inspection.values[i].in_double = shade(*shaded[i], Precision::kDouble);
      inspector.Publish(inspection);
    }
  }

 private:
  struct Wanted {
    std::string name;
    Variant variant;
    std::map<std::string, double> knobs;
  };

  std::vector<Wanted> Choose(const InspectJob& job) const {
    std::vector<Wanted> wanted;
    const auto add = [&](const std::string& name, const std::map<std::string, double>& knobs) {
      if (std::ranges::any_of(wanted, [&](const Wanted& one) { return one.name == name; })) return;
      try {
        const Variant variant = ParseVariant(techniques_, name);
        if (!WhyUnsupported(variant, *job.scene)) wanted.push_back({name, variant, knobs});
      } catch (const std::exception&) {
        // The truth, or a technique whose file has gone.
      }
    };
    for (const ShownVariant& shown : job.variants) add(shown.name, shown.knobs);
    for (const Technique& technique : techniques_) {
      if (!technique.yardstick) add(DefaultVariant(technique).ShortName(), {});
    }
    return wanted;
  }

  // Of the first that is shown and looks one up, else of any.
  void AddLobe(const InspectJob& job, const std::vector<Wanted>& wanted, Inspection& inspection) const {
    for (const Wanted& one : wanted) {
      try {
        const auto lobe = FindFittedLobe(library_, one.variant, job.scene->brdf, inspection.roughness, inspection.n_dot_v);
        if (lobe) return AddFittedLobe(inspection, job.scene->brdf, *lobe, one.name);
      } catch (const std::exception&) {
        // Its table is missing: the technique itself says so.
      }
    }
  }

  std::unique_ptr<Context> context_;
  ShaderLibrary library_;
  std::vector<Technique> techniques_;
  std::unique_ptr<Renderer> renderer_;
  std::uint64_t library_version_ = 0;
};

}  // namespace

Inspector::Work MakeInspector(std::optional<ContextKind> kind, const std::filesystem::path& shader_folder) {
  return [kind, shader_folder, bench = std::shared_ptr<Bench>()](const InspectJob& job, Inspector& inspector) mutable {
    try {
      if (!bench) bench = std::make_shared<Bench>(kind, shader_folder);
      bench->Look(job, inspector);
    } catch (const std::exception& error) {
      Inspection trouble;
      trouble.what = error.what();
      inspector.Publish(trouble);
    }
  };
}

}  // namespace arealab
