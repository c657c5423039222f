// The reader of technique files' headers.
#include "glsl/technique.h"

#include <cmath>

#include "glsl/variant.h"
#include "tests/fuzz/targets.h"

namespace arealab::fuzz {

void TechniqueHeader(Bytes bytes) {
  static const ShaderLibrary library;
  Technique technique;
  if (!Reads([&] { technique = ReadTechnique(library, "fuzz", Text(bytes)); })) return;
  Require(!technique.shapes.empty() && !technique.brdfs.empty() && (technique.diffuse || technique.specular), "supports nothing");
  for (const Option& option : technique.options) Require(option.choices.size() > 1, "an option without a choice");
  for (const Knob& knob : technique.knobs) Require(knob.min <= knob.initial && knob.initial <= knob.max, "a knob out of range");
  // Its forms are names that read back.
  const std::vector<Technique> techniques = {technique};
  for (const Variant& variant : DefaultVariants(techniques)) {
    Require(ParseVariant(techniques, variant.Name()) == variant, "a name that is another's: " + variant.Name());
  }
}

}  // namespace arealab::fuzz
