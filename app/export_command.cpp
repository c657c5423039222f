#include <fmt/format.h>
#include <fmt/ranges.h>

#include <glm/gtc/packing.hpp>
#include <nlohmann/json.hpp>

#include <fstream>
#include <span>

#include "app/commands.h"
#include "compare/subprocess.h"
#include "glsl/effects.h"
#include "glsl/export.h"
#include "glsl/light_block.h"
#include "glsl/light_textures.h"
#include "glsl/table.h"
#include "scenes/error.h"
#include "scenes/write_image.h"

namespace arealab {
namespace {

const std::vector<std::string> kExportTargets{"glsl330", "essl300", "spirv", "hlsl"};

// With more than one light the array holds as many: 16 KiB, the least that OpenGL ES 3.0 promises of a uniform block.
constexpr int kExportedLights = 16384 / (16 * kLightRows);

// Spherical caps of the hemisphere that a point sees, baked per vertex or per texel [Oat 2006].
constexpr std::pair<const char*, const char*> kApertureSamplers[] = {
    {"gbuffer_aperture", "the cap about the mean direction that meets no surface"},
    {"gbuffer_first_region", "the cap of the largest contiguous region of such directions"},
    {"gbuffer_second_region", "the cap of the second largest, or of none"},
    {"gbuffer_blocked", "the cap about the mean direction that meets a surface"}};

// Forms of the lights' textures, as glsl/light_textures.h makes them.
constexpr std::pair<const char*, const char*> kLightTextures[] = {
    {"light_image", "the texels, in the layer's upper left corner"},
    {"light_weights", "rules of product integration of 3 x 3 nodes: a level's squares side by side, the finest in level 0"},
    {"light_means", "means over squares"},
    {"light_cosine", "level l blurred by what a cosine lobe throws on the light from (2^l - 1)/32 of its square root of the area away"},
    {"light_cosine_border", "the same with what it is around the light, whose own square is 0.125 ... 0.875"},
    {"light_solid_angle", "level l blurred by the solid angle from (2^l - 1)/32 of the square root of the area before each place"},
    {"light_phong", "level l blurred by Phong's lobe whose trace has the radius (2^l - 1)/32 of the square root of the area"},
    {"light_straight", "means over squares of the colours not multiplied by alpha, and of alpha"}};

struct ExportArguments {
  CommonOptions common;
  std::string scene;
  std::vector<std::string> effects;
  BrdfOptions brdfs;
  std::string technique = "ltc";
  std::vector<std::string> forced;
  std::vector<std::string> targets = kExportTargets;
  std::string out;
};

// What is written: a file under another name first.
class ExportFolder {
 public:
  explicit ExportFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) throw InputError(fmt::format("{}: not writable ({}); expected a folder", folder_.string(), error.message()));
  }

  std::filesystem::path Path(const std::string& name) const { return folder_ / name; }

  void Write(const std::string& name, std::string_view bytes) {
    const std::filesystem::path part = Path(name + ".part");
    std::ofstream out(part, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    out.close();
    Keep(name, static_cast<bool>(out));
  }

  // Moves what a tool wrote to NAME.part into its place.
  void Keep(const std::string& name, bool whole) {
    std::error_code error;
    if (whole) std::filesystem::rename(Path(name + ".part"), Path(name), error);
    if (whole && !error) return Add(name);
    std::filesystem::remove(Path(name + ".part"), error);
    throw InputError(fmt::format("{}: not writable; expected a folder with room", Path(name).string()));
  }

  // What is in its place already.
  void Add(const std::string& name) { written_.push_back(name); }

  const std::vector<std::string>& written() const { return written_; }

 private:
  std::filesystem::path folder_;
  std::vector<std::string> written_;
};

void RunTool(const std::vector<std::string>& command, const char* package) {
  const ProcessResult result = RunProcess(command, {}, {});
  if (!result.started) {
    throw InputError(fmt::format("{}: not installed; expected the Debian package {} (or --target glsl330,essl300)", command[0], package));
  }
  if (result.status != 0) throw InputError(fmt::format("{}: {}; expected a text that it takes", command[0], result.messages));
}

std::string CArray(const std::string& table, const TableTexels& texels) {
  std::string text = fmt::format(
      "/* {0} x {1} texels of RGBA, row 0 first; texel (i, j) lies at ((i + 0.5)/{0}, (j + 0.5)/{1}). Sample linearly, clamped to the edge. */\n",
      texels.size.x, texels.size.y);
  text += fmt::format("enum {{ {0}_width = {1}, {0}_height = {2} }};\n\nstatic const float {0}[{3}] = {{\n", table, texels.size.x,
                      texels.size.y, 4 * texels.texels.size());
  for (const glm::vec4& t : texels.texels) text += fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},\n", t.x, t.y, t.z, t.w);
  text += fmt::format("}};\n\n/* The same as IEEE half floats. */\nstatic const unsigned short {}_half[{}] = {{\n", table,
                      4 * texels.texels.size());
  for (const glm::vec4& t : texels.texels) {
    text += fmt::format("{},{},{},{},\n", glm::packHalf1x16(t.x), glm::packHalf1x16(t.y), glm::packHalf1x16(t.z), glm::packHalf1x16(t.w));
  }
  return text + "};\n";
}

struct TextureLevel {
  std::string file;
  glm::ivec3 size{0};  // of a layer, layers
};
using LightTextureFiles = std::map<std::string, std::vector<TextureLevel>>;  // by form, level by level

// The forms of the lights' textures that the shader samples, a file a level, its layers below each other as glTexImage3D takes them.
LightTextureFiles WriteLightTextures(const std::vector<std::string>& forms, const std::vector<Light>& lights, ExportFolder& folder) {
  const std::vector<ShownTexture> layers = LightTextureLayers(lights);
  LightTextureFiles files;
  for (const std::string& form : forms) {
    std::vector<TextureLevels> made;
    for (const ShownTexture& layer : layers) made.push_back(MakeTextureLevels(form, layer, layers));
    for (std::size_t level = 0; level < made[0].levels.size(); ++level) {
      std::vector<glm::vec4> texels;
      for (const TextureLevels& layer : made) texels.insert(texels.end(), layer.levels[level].begin(), layer.levels[level].end());
      const glm::ivec2 size = made[0].size >> static_cast<int>(level);
      const auto count = static_cast<int>(layers.size());
      const std::string file = fmt::format("{}_{}.exr", form, level);
      WriteImageFile(folder.Path(file), OIIO::ImageSpec(size.x, size.y * count, 4, OIIO::TypeFloat), texels.data());
      folder.Add(file);
      files[form].push_back({file, {size, count}});
    }
  }
  return files;
}

nlohmann::ordered_json InputsJson(const Variant& variant, const std::vector<Effect>& effects, Brdfs brdfs, int lights,
                                  const ExportedShader& shader, const LightTextureFiles& textures) {
  nlohmann::ordered_json json;
  json["variant"] = variant.Name();
  json["brdf"] = Name(brdfs.specular);
  json["diffuse_brdf"] = Name(brdfs.diffuse);
  json["effects"] = nlohmann::ordered_json::array();
  for (const Effect& effect : effects) {
    const auto forced = variant.effects.find(effect.name);
    json["effects"].push_back({{"name", effect.name}, {"on", forced == variant.effects.end() ? effect.on : forced->second}, {"reason", effect.reason}});
  }
  json["gbuffer"] = {
      {{"sampler", "gbuffer_position"}, {"format", "RGBA32F"}, {"rgb", "position, m, world"}, {"a", "1 where there is a surface, else 0"}},
      {{"sampler", "gbuffer_normal"}, {"format", "RGBA32F"}, {"rgb", "unit shading normal, world"}, {"a", "roughness, [0, 1]"}},
      {{"sampler", "gbuffer_base_color"},
       {"format", "RGBA32F"},
       {"rgb", "base colour, linear"},
       {"a", "metalness, or below 0 a non-metal whose specular lobe weighs 1 + a"}}};
  for (const auto& [sampler, meaning] : kApertureSamplers) {
    if (shader.text.find(fmt::format("sampler2D {};", sampler)) == std::string::npos) continue;
    json["gbuffer"].push_back({{"sampler", sampler}, {"format", "RGBA32F"}, {"rgb", fmt::format("unit axis, world, of {}; 0 where nothing was baked", meaning)},
                               {"a", "1 - cos of the cap's radius: its area over 2 pi"}});
  }
  json["uniforms"] = {{{"name", "view_position"}, {"type", "vec3"}, {"meaning", "the camera, m, world"}}};
  if (shader.text.find("uniform int light_count;") != std::string::npos) {
    json["uniforms"].push_back({{"name", "light_count"}, {"type", "int"}, {"meaning", fmt::format("lights in use, 1 to {}", lights)}});
  }
  if (shader.text.find("uniform vec3 sky_radiance;") != std::string::npos) {
    json["uniforms"].push_back({{"name", "sky_radiance"}, {"type", "vec3"}, {"meaning", "from every direction, in the lights' unit, linear RGB"}});
  }
  for (const Knob& knob : variant.technique->knobs) {
    if (std::ranges::find(shader.knobs, knob.name) == shader.knobs.end()) continue;
    json["uniforms"].push_back({{"name", "knob_" + knob.name}, {"type", "float"}, {"meaning", knob.label}, {"unit", knob.unit},
                                {"initial", knob.initial}, {"min", knob.min}, {"max", knob.max}});
  }
  json["tables"] = nlohmann::ordered_json::array();
  for (const std::string& table : shader.tables) {
    json["tables"].push_back({{"sampler", "table_" + table}, {"exr", "table_" + table + ".exr"}, {"c", "table_" + table + ".h"},
                              {"filter", "linear, clamped to the edge, one level"}});
  }
  for (const std::string& sampler : shader.light_textures) {
    const auto meaning = std::ranges::find(kLightTextures, sampler, [](const auto& form) { return std::string(form.first); })->second;
    nlohmann::ordered_json entry = {{"sampler", sampler}, {"type", "sampler2DArray"}, {"layer_0", "white"}, {"meaning", meaning},
                                    {"filter", "linear between texels and levels, clamped to the edge"}, {"levels", nlohmann::ordered_json::array()}};
    for (const TextureLevel& level : textures.at(sampler)) {
      entry["levels"].push_back({{"exr", level.file}, {"width", level.size.x}, {"height", level.size.y}, {"layers", level.size.z}});
    }
    json["light_textures"].push_back(std::move(entry));
  }
  json["light_block"] = {
      {"name", "LightBlock"},
      {"layout", "std140"},
      {"lights", lights},
      {"rows_per_light", kLightRows},
      {"rows",
       {"xyz centre (m, world), w shape: 0 rectangle, 1 disk or ellipse, 2 sphere, 3 polygon, 4 tube", "xyz unit normal of the lit side = axis_x × axis_y, w 1 if lit on both sides",
        "xyz unit axis_x, w half width (m); disk and sphere: radius; ellipse: half axis; polygon: reach; tube: half its length", "xyz unit axis_y, w half height (m); tube: radius; else as above",
        "xyz axis_x × half width, w area of one side (m²); sphere: π radius²", "xyz axis_y × half height, w corners of a polygon or texels across",
        "xyz radiance, linear RGB, w layer of the texture, 0 without one", "xyz half width², half height², twice their product (m²), w texels down"}}};
  if (shader.text.find("uniform CornerBlock") != std::string::npos) {
    json["corner_block"] = {{"name", "CornerBlock"},
                            {"layout", "std140"},
                            {"lights", lights},
                            {"rows_per_light", kCornerRows},
                            {"rows", "two corners each of a polygon, m, from the centre along axis_x and axis_y, counter-clockwise seen from the lit side"}};
  }
  json["outputs"] = {{{"location", 0}, {"name", "out_diffuse"}, {"meaning", "diffuse radiance towards the viewer, in the lights' unit"}},
                     {{"location", 1}, {"name", "out_specular"}, {"meaning", "specular radiance"}}};
  return json;
}

// As in LICENSE, a paragraph a line.
constexpr const char* kLicense =
    R"(MIT License. Copyright (c) 2026 The AreaLab authors
Permission is hereby granted, free of charge, to any person obtaining a copy of this software and associated documentation files (the "Software"), to deal in the Software without restriction, including without limitation the rights to use, copy, modify, merge, publish, distribute, sublicense, and/or sell copies of the Software, and to permit persons to whom the Software is furnished to do so, subject to the following conditions:
The above copyright notice and this permission notice shall be included in all copies or substantial portions of the Software.
THE SOFTWARE IS PROVIDED "AS IS", WITHOUT WARRANTY OF ANY KIND, EXPRESS OR IMPLIED, INCLUDING BUT NOT LIMITED TO THE WARRANTIES OF MERCHANTABILITY, FITNESS FOR A PARTICULAR PURPOSE AND NONINFRINGEMENT. IN NO EVENT SHALL THE AUTHORS OR COPYRIGHT HOLDERS BE LIABLE FOR ANY CLAIM, DAMAGES OR OTHER LIABILITY, WHETHER IN AN ACTION OF CONTRACT, TORT OR OTHERWISE, ARISING FROM, OUT OF OR IN CONNECTION WITH THE SOFTWARE OR THE USE OR OTHER DEALINGS IN THE SOFTWARE.
)";

std::string Readme(const Variant& variant, const std::string& stem, const std::vector<std::string>& targets, const ExportedShader& shader) {
  std::string samplers, textures;
  if (!shader.light_textures.empty()) {
    textures = "- Lights' textures: `light_…_N.exr`, level N of an array texture, its layers below each other, the first white. Prefiltered for\n"
               "  these pictures on lights of these proportions: `arealab export SCENE` makes them for yours.\n";
  }
  for (const std::string& table : shader.tables) samplers += fmt::format("{}`table_{}.exr` or `table_{}.h`", samplers.empty() ? "" : ", ", table, table);
  return fmt::format(
      R"(# {}
{}

- `{}.330.frag` (GLSL 3.30), `{}.300es.frag` (GLSL ES 3.00, WebGL 2), `{}.spv` and `{}.hlsl` (Vulkan, Direct3D): the same lighting pass; here: {}.
- To paste it into a shader of yours take all but `main`, which shows the use: make a `Surface`, then
  `LoadLight`, `FaceLight`, `ShadeLight` per light, and add up what comes back. `to_view` is unit and above the surface.
- Inputs: `inputs.json`. Lengths in metres, colours linear, right-handed frames; a light's rows are computed once on the CPU.
- Tables: {}. RGBA float, linear filter, clamped to the edge; half floats serve.
{}- The effects that `inputs.json` lists as off are left out because the scene was proven not to need them: other
  lights and surfaces may. Export with `--effect NAME=1`, or with `--effects`, what yours need.
- No shadows: multiply by yours. Emitters and tone mapping are yours too.
- In OpenGL ES the float targets need EXT_color_buffer_float and the tables OES_texture_float_linear, or take half floats.
- In SPIR-V and HLSL loose uniforms are gathered in a block; bindings are the compiler's, as its reflection lists them.
- Tested: 3.30 on llvmpipe, 3.00 ES in WebGL 2, HLSL by way of glslang on lavapipe. Untested: GPUs, Direct3D's compilers.

## Licence

{})",
      variant.Name(), variant.technique->summary + ". " + variant.technique->citation + ".", stem, stem, stem, stem, fmt::join(targets, ", "),
      samplers.empty() ? "none" : samplers, textures, kLicense);
}

std::vector<Effect> NamedEffects(const std::vector<std::string>& names) {
  const std::vector<std::string> known = EffectNames();
  for (const std::string& name : names) {
    if (std::ranges::find(known, name) == known.end()) {
      throw InputError(fmt::format("--effects: unknown effect \"{}\"; expected of {}", name, fmt::join(known, ", ")));
    }
  }
  std::vector<Effect> effects;
  for (const std::string& name : known) {
    const bool on = std::ranges::find(names, name) != names.end();
    effects.push_back({name, on, on ? "asked for" : "not asked for"});
  }
  return effects;
}

void RunExport(const ExportArguments& arguments) {
  if (arguments.scene.empty() == arguments.effects.empty()) throw InputError("export: expected either a scene or --effects");
  const auto wants = [&](const char* target) { return std::ranges::find(arguments.targets, target) != arguments.targets.end(); };
  const ShaderLibrary library = arguments.common.Library();
  const std::vector<Technique> techniques = LoadTechniques(library);
  std::string name = arguments.technique;
  for (const std::string& effect : arguments.forced) name += "+effect_" + effect;
  const Variant variant = ParseVariant(techniques, name);
  std::vector<Effect> effects;
  std::vector<Light> shown;
  Brdfs brdfs = arguments.brdfs.Chosen();
  if (arguments.scene.empty()) {
    effects = NamedEffects(arguments.effects);
  } else {
    const Scene scene = LoadScene(FindScene(arguments.scene));
    effects = SceneEffects(scene);
    brdfs = scene.brdfs();
    shown = EmittingLights(scene);
    if (const auto reason = WhyUnsupported(variant, scene, effects)) {
      throw InputError(fmt::format("{}: {}; expected a technique that supports the scene", scene.file.string(), *reason));
    }
  }
  const EffectDefines defines = Defines(effects, variant.effects);
  if (std::ranges::find(defines, std::pair<std::string, int>("EFFECT_SKY_TEXTURE", 1)) != defines.end()) {
    throw InputError("export: a sky's texture is not exported; expected a scene with an even sky, or --effect sky_texture=0");
  }
  const int lights = std::ranges::find(defines, std::pair<std::string, int>("EFFECT_MANY_LIGHTS", 1)) == defines.end() ? 1 : kExportedLights;

  ExportFolder folder(arguments.out);
  const std::string& stem = variant.technique->name;
  const ExportedShader core = ExportShader(library, variant, effects, brdfs, GlslDialect::kCore330, lights);
  folder.Write(stem + ".330.frag", core.text);
  if (wants("essl300")) {
    folder.Write(stem + ".300es.frag", ExportShader(library, variant, effects, brdfs, GlslDialect::kEs300, lights).text);
  }
  if (wants("spirv") || wants("hlsl")) {
    RunTool({"glslangValidator", "-V", "--target-env", "vulkan1.1", "-R", "--amb", "--aml", "--sub", "16", "--sbb", "32", "--sib", "48", "-S",
             "frag", "-o", folder.Path(stem + ".spv.part").string(), folder.Path(stem + ".330.frag").string()},
            "glslang-tools");
    folder.Keep(stem + ".spv", true);
  }
  if (wants("hlsl")) {
    RunTool({"spirv-cross", "--hlsl", "--shader-model", "50", folder.Path(stem + ".spv").string(), "--output",
             folder.Path(stem + ".hlsl.part").string()},
            "spirv-cross");
    folder.Keep(stem + ".hlsl", true);
  }
  for (const Table& table : TablesOf(variant, brdfs)) {
    if (std::ranges::find(core.tables, table.name) == core.tables.end()) continue;
    const std::string file = TableFile(variant, table, brdfs);
    const std::optional<std::string> bytes = library.Find(file);
    if (!bytes) throw InputError(fmt::format("{}: does not exist; expected a table that `arealab fit` wrote", library.DisplayPath(file)));
    folder.Write("table_" + table.name + ".exr", *bytes);
    folder.Write("table_" + table.name + ".h", CArray("table_" + table.name, DecodeTable(*bytes, library.DisplayPath(file))));
  }
  const LightTextureFiles textures = WriteLightTextures(core.light_textures, shown, folder);
  folder.Write("inputs.json", InputsJson(variant, effects, brdfs, lights, core, textures).dump(1) + "\n");
  folder.Write("README.md", Readme(variant, stem, arguments.targets, core));
  for (const std::string& file : folder.written()) fmt::print("{}\n", folder.Path(file).string());
}

}  // namespace

void AddExport(CLI::App& app, int& /*status*/) {
  auto arguments = std::make_shared<ExportArguments>();
  CLI::App* command = app.add_subcommand("export", "The shader that a scene calls for, as text, tables and a description to take home");
  command->add_option("scene", arguments->scene, "a built-in name or a scene file");
  command->add_option("--effects", arguments->effects, "instead of a scene: the effects that are on")->delimiter(',');
  arguments->brdfs.Add(*command);
  command->add_option("--technique", arguments->technique, "a variant")->capture_default_str();
  command->add_option("--effect", arguments->forced, "NAME=0 or NAME=1: forced off or on; may be given several times");
  command->add_option("--target", arguments->targets, "what to write beside the GLSL 3.30 text; hlsl writes spirv too")
      ->capture_default_str()
      ->delimiter(',')
      ->check(CLI::IsMember(kExportTargets));
  command->add_option("--out", arguments->out, "folder")->required();
  arguments->common.AddGlsl(*command);
  command->callback([arguments] { RunExport(*arguments); });
}

}  // namespace arealab
