// What a scene calls for of a variant, and what each effect costs there.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "compare/context.h"
#include "compare/cost.h"
#include "compare/results.h"
#include "glsl/renderer.h"

namespace arealab {

struct EffectPrice {
  Effect effect;
  bool forced = false;  // by the user
  bool asked = true;    // whether the variant's text asks for it; where not it costs nothing
  // Time of the lighting pass with the effect over the time without it, all else as the scene wants it; not measured
  // where the technique does not take the effect, or where without it another scene would be drawn.
  Estimate time_ratio;
  std::map<std::string, int> cycles;  // more with it than without, by GPU
};

struct Explanation {
  std::string variant;  // canonical name
  std::vector<EffectPrice> effects;
  Saving saving;
};

struct ExplainOptions {
  bool prices = true;            // of each effect, or of all together only
  bool per_pixel = true;         // and what asking each pixel would save
  const CostMeter* meter = nullptr;  // for the cycles; null: none
  double seconds = 20.0;         // of the clock
  std::function<void(double)> progress;
};

// Of the scene that `renderer` drew last. Throws InputError where the variant does not support it.
Explanation Explain(const Context& context, Renderer& renderer, const ShaderLibrary& library, const Scene& scene, const Variant& variant,
                    const ExplainOptions& options = {});

}  // namespace arealab
