#include <fmt/format.h>

#include "app/commands.h"
#include "app/progress.h"
#include "compare/harness.h"
#include "compare/image_files.h"
#include "compare/aperture_cache.h"
#include "compare/shadowed_truth.h"
#include "compare/truth_cache.h"
#include "scenes/error.h"

namespace arealab {
namespace {

struct RenderArguments {
  CommonOptions common;
  std::string scene;
  std::string technique = "ltc";
  std::string out;
  std::vector<std::string> knobs;
  double exposure = 0.0;
  double tolerance = 1e-4;
  bool fp64 = false;
  bool fp16 = false;
};

// "NAME=VALUE" of each --set, checked against what the technique declares.
std::map<std::string, double> ParseKnobs(const std::vector<std::string>& texts, const Technique& technique) {
  std::map<std::string, double> knobs;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const std::string name = text.substr(0, equals);
    const auto knob = std::find_if(technique.knobs.begin(), technique.knobs.end(),
                                   [&](const Knob& candidate) { return candidate.name == name; });
    if (knob == technique.knobs.end()) {
      std::string known;
      for (const Knob& candidate : technique.knobs) known += (known.empty() ? "" : ", ") + candidate.name;
      throw InputError(fmt::format("--set {}: {} has no knob \"{}\"; expected {}", text, technique.name, name,
                                   known.empty() ? "none, since it declares none" : "one of " + known));
    }
    std::size_t used = 0;
    double value = 0.0;
    try {
      if (equals != std::string::npos) value = std::stod(text.substr(equals + 1), &used);
    } catch (const std::exception&) {
      used = 0;
    }
    if (used == 0 || equals + 1 + used != text.size() || !(value >= knob->min && value <= knob->max)) {
      throw InputError(fmt::format("--set {}: expected {}=NUMBER from {} to {}", text, name, knob->min, knob->max));
    }
    knobs[name] = value;
  }
  return knobs;
}

void RunRender(const RenderArguments& arguments) {
  const std::filesystem::path out = arguments.out;
  if (out.extension() != ".exr" && out.extension() != ".png") {
    throw InputError(fmt::format("{}: not a picture's name; expected one that ends in .exr or .png", arguments.out));
  }
  const ShaderLibrary library = arguments.common.Library();
  const std::vector<Technique> techniques = LoadTechniques(library);
  const bool truth = arguments.technique == "truth";
  const Variant variant = truth ? Variant() : ParseVariant(techniques, arguments.technique);
  const std::map<std::string, double> knobs =
      truth ? std::map<std::string, double>() : ParseKnobs(arguments.knobs, *variant.technique);
  Scene scene = LoadScene(FindScene(arguments.scene));
  if (!truth) {
    if (const auto reason = WhyUnsupported(variant, scene)) {
      throw InputError(fmt::format("{}: {}; expected a technique that supports the scene", scene.file.string(), *reason));
    }
  }

  const std::unique_ptr<Context> context = arguments.common.MakeContext();
  {
    Progress progress;
    CachedApertures(scene, arguments.common.CacheFolder(), [&](double fraction) { progress.Show("apertures", fraction); });
  }
  Renderer renderer(context->gl(), library);
  const SurfacePixels& pixels = renderer.DrawScene(scene, arguments.common.Size());
  RadianceImage image;
  if (truth) {
    Progress progress;
    TruthOptions options;
    options.tolerance = arguments.tolerance;
    options.progress = [&](double fraction) { progress.Show("truth", fraction); };
    image = CachedTruth(scene, pixels, options, arguments.common.CacheFolder()).radiance;
    if (scene.aperture) {
      ShadowOptions shadow_options;
      shadow_options.progress = [&](double fraction) { progress.Show("truth with shadows", fraction); };
      image = CachedShadowedTruth(scene, pixels, image, options, shadow_options, arguments.common.CacheFolder()).radiance;
    }
  } else {
    const Precision precision = arguments.fp64   ? Precision::kDouble
                                : arguments.fp16 ? Precision::kHalf
                                                 : Precision::kFloat;
    image = renderer.Shade(variant, precision, knobs);
  }
  if (out.extension() == ".exr") {
    WriteExr(out, image);
  } else {
    WritePng(out, Picture(image, EmissionImage(scene, pixels)), image.width, scene.exposure + arguments.exposure);
  }
  fmt::print("{}\n", out.string());
}

}  // namespace

void AddRender(CLI::App& app, int& /*status*/) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App* command = app.add_subcommand("render", "Render one scene with one technique, or with the truth");
  command->add_option("scene", arguments->scene, "a built-in name or a scene file")->required();
  command->add_option("--technique", arguments->technique, "a variant, or truth")->capture_default_str();
  command->add_option("-o,--out", arguments->out, "the picture: .exr (linear, lobes as layers) or .png (sRGB)")->required();
  command->add_option("--set", arguments->knobs, "NAME=VALUE: a knob that the technique declares; may be given several times");
  command->add_option("--exposure", arguments->exposure, "EV added to the scene's, for .png")->capture_default_str();
  command->add_option("--tolerance", arguments->tolerance, "of the truth, relative")
      ->capture_default_str()
      ->check(Within(1e-8, 1e-1));
  CLI::Option* fp64 = command->add_flag("--fp64", arguments->fp64, "the same shader text in double precision");
  command->add_flag("--fp16", arguments->fp16, "the same with every result rounded to a half float, as mediump may be")->excludes(fp64);
  command->add_option("--cache", arguments->common.cache, "folder of truths already computed (default: the user's cache)");
  arguments->common.AddContext(*command);
  arguments->common.AddSize(*command);
  arguments->common.AddGlsl(*command);
  command->callback([arguments] { RunRender(*arguments); });
}

}  // namespace arealab
