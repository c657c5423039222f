// What shading costs on GPUs that are not there: the GL's own shader text, compiled by Mesa's RADV for a named AMD family on
// its null device, and what that compiler says of the code. Nothing is run: these are estimates, never measurements.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "compare/results.h"
#include "glsl/expand.h"
#include "glsl/variant.h"
#include "scenes/scene.h"

namespace arealab {

// RADV's names of the families that its null device compiles for; others crash it.
std::span<const char* const> GpuNames();

// Throws InputError that lists them where one of `gpus` is none of them.
void CheckGpuNames(const std::vector<std::string>& gpus);

// Milliseconds of a full-screen pass of 1920×1080 pixels where clock and width are documented, else NaN. bonaire: a
// PlayStation 4's 18 compute units of 4 SIMDs at 0.8 GHz [Drobot 2014 and Hill 2016 measured on one].
double MillisecondsAt1080p(const std::string& gpu, double cycles);

// The libraries that compile for a GPU (Debian: libvulkan1, mesa-vulkan-drivers).
struct CostTools {
  std::string vulkan = "libvulkan.so.1";  // as dlopen takes it
  std::string driver;                     // RADV's manifest, radeon_icd.*.json; empty: where Debian installs it

  // The above, or what AREALAB_VULKAN and AREALAB_RADV say instead.
  static CostTools FromEnvironment();
};

class CostMeter {
 public:
  // Results are kept under `cache` by content: shader text (and its SPIR-V, which many texts share), compilers' versions, GPU. Throws InputError with one line where
  // a tool is missing or a GPU has another name.
  CostMeter(std::vector<std::string> gpus, std::filesystem::path cache, CostTools tools = CostTools::FromEnvironment());

  const std::vector<std::string>& gpus() const { return gpus_; }
  // "radv Mesa 22.3.6 by glslang 11:12.0.0": the figures repeat exactly for the same two.
  const std::string& compilers() const { return compilers_; }

  // Per variant, GPU → cost of shading `scene` (its effects and BRDF; lights and meshes do not matter); empty for a
  // variant that does not support it. Throws InputError where a text does not compile, with the author's file and line, and
  // where a GPU crashes the driver. `progress` gets the fraction done.
  std::vector<std::map<std::string, GpuCost>> Measure(const ShaderLibrary& library, const std::vector<Variant>& variants,
                                                      const Scene& scene,
                                                      const std::function<void(double)>& progress = {}) const;

  // Of full-screen passes by themselves, per GPU.
  std::vector<std::map<std::string, ShaderCost>> MeasurePasses(const ShaderLibrary& library, const std::vector<ExpandedSource>& passes) const;

 private:
  struct Text;
  struct Entry;
  struct Job;
  static std::vector<std::uint32_t> Translate(const Text& text);
  std::string CacheName(std::string_view vertex, std::string_view fragment, int targets, const std::string& gpu) const;
  std::vector<std::pair<std::string, std::string>> WorkerEnvironment(const std::string& gpu) const;
  void Find(const ShaderLibrary& library, std::vector<Entry>& entries, const std::function<void(double)>& progress) const;
  void Compile(std::span<const Job> jobs, const std::string& gpu) const;
  void Store(const std::string& name, const ShaderCost& cost) const;

  std::vector<std::string> gpus_;
  std::filesystem::path cache_;
  CostTools tools_;
  std::string compilers_;
  std::string worker_;
};

// A scene that calls for exactly these effects and for all that are not named here ("rectangle", "disk", "sphere", "two_sided", "diffuse", "specular",
// "fresnel", "textured", "many_lights"). Throws InputError that lists them, or says that there is no such scene.
Scene SceneOfEffects(const std::vector<std::string>& effects);

}  // namespace arealab
