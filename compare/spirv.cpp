#include "compare/spirv.h"

#include <fmt/format.h>
#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

namespace arealab {
namespace {

// Once, for all threads.
void Initialize() {
  static const struct Process {
    Process() { glslang::InitializeProcess(); }
    ~Process() { glslang::FinalizeProcess(); }
  } process;
}

}  // namespace

// As `glslangValidator -V --target-env vulkan1.1 -R --amb --aml --sub 16 --sbb 32 --sib 48`: the same words.
SpirvResult TranslateToSpirv(const std::string& text, SpirvStage stage) {
  Initialize();
  constexpr auto kMessages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules);
  constexpr int kClientVersion = 100, kUnstatedVersion = 100;
  const EShLanguage language = stage == SpirvStage::kVertex ? EShLangVertex : EShLangFragment;
  glslang::TShader shader(language);
  const char* const source = text.c_str();
  shader.setStrings(&source, 1);
  shader.setAutoMapBindings(true);
  shader.setAutoMapLocations(true);
  shader.setShiftBinding(glslang::EResUbo, 16);
  shader.setShiftBinding(glslang::EResSsbo, 32);
  shader.setShiftBinding(glslang::EResImage, 48);
  shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, kClientVersion);
  shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_1);
  shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_3);
  shader.setEnvInputVulkanRulesRelaxed();
  if (!shader.parse(GetDefaultResources(), kUnstatedVersion, false, kMessages)) return {{}, shader.getInfoLog()};
  glslang::TProgram program;  // ends before the shader that it holds
  program.addShader(&shader);
  if (!program.link(kMessages) || !program.mapIO()) return {{}, program.getInfoLog()};
  SpirvResult result;
  glslang::GlslangToSpv(*program.getIntermediate(language), result.words);
  return result;
}

std::string GlslangVersion() {
  const glslang::Version version = glslang::GetVersion();
  return fmt::format("{}:{}.{}.{}{}", glslang::GetSpirvGeneratorVersion(), version.major, version.minor, version.patch, version.flavor);
}

}  // namespace arealab
