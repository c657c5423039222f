#include <fmt/format.h>

#include "app/commands.h"
#include "app/view/view.h"
#include "scenes/error.h"

namespace arealab {

void AddView(CLI::App& app, int& /*status*/) {
  struct Arguments {
    CommonOptions common;
    ViewOptions view;
    std::string size;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("view", "Open a scene in a window: edit it live, compare variants side by side");
  ViewOptions& view = arguments->view;
  command->add_option("scene", view.scene, "a built-in name, a scene file, or a mesh (.gltf, .glb, .obj, .ply, .stl, .3ds); default: the last one");
  command->add_option("--technique", view.techniques, "a variant, or truth, for pane A, then B, C, D (default: ltc, truth)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->add_option("--layout", view.layout, "how panes are compared (default: by the number of techniques)")
      ->check(CLI::IsMember({"single", "wipe", "difference", "flicker", "grid"}));
  command->add_option("--size", arguments->size, "of the window, WxH in pixels (default: as it was left, first 1280x720)");
  command->add_option("--transform", view.transform, "view transform (default: srgb; ocio: the first view of the configuration that OCIO names)")
      ->check(CLI::IsMember({"srgb", "aces", "neutral", "agx", "ocio", "false"}));
  command->add_flag("--captions", view.captions, "the picture and its captions, without controls (Tab in the window)");
  command->add_flag("--bare", view.bare, "the picture alone, without controls (Tab in the window)");
  command->add_option("--frames", view.frames, "draws so many frames of the whole picture, then leaves (default: until closed)")
      ->check(CLI::Range(1, 1000000));
  command->add_option("--screenshot", view.screenshot, "with --frames, written before leaving: .png as seen, .exr pane A's radiance");
  command->add_option("--turntable", view.turntable, "folder for --frames pictures once round the camera's target (default 72 frames)");
  command->add_flag("--json", view.json, "prints times of this session at the end, milliseconds");
  arguments->common.AddContext(*command);
  arguments->common.AddGlsl(*command);
  command->callback([arguments] {
    ViewOptions options = arguments->view;
    const CommonOptions& common = arguments->common;
    if (!arguments->size.empty()) {
      CommonOptions sized;
      sized.size = arguments->size;
      options.size = sized.Size();
    }
    if (!options.screenshot.empty()) {
      if (options.screenshot.extension() != ".png" && options.screenshot.extension() != ".exr") {
        throw InputError(fmt::format("{}: not a picture's name; expected one that ends in .png or .exr", options.screenshot.string()));
      }
      if (options.frames == 0) options.frames = 1;
    }
    if (!options.turntable.empty() && options.frames == 0) options.frames = 72;
    common.Library();  // refuses a folder that is not there
    options.shader_folder = common.glsl;
    options.cache = common.CacheFolder();
    if (!common.context.empty()) options.context = common.context == "egl" ? ContextKind::kEgl : ContextKind::kOsmesa;
    RunView(options);
  });
}

}  // namespace arealab
