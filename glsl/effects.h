// The effects: 0/1 defines by which the shading text leaves out what a scene does not call for.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenes/scene.h"

namespace arealab {

// What a scene calls for, or is proven not to call for.
struct Effect {
  std::string name;  // "horizon"; the shading text asks EFFECT_HORIZON
  bool on = true;
  std::string reason;  // a sentence without its full stop

  std::string Define() const;
};

// All effects, derived from the scene's lights that emit, its materials that are used, and its geometry; each is off only where
// that is proven for every pixel that the camera can see lit. What each stands for: README.md, "Effects".
std::vector<Effect> SceneEffects(const Scene& scene);

// One of them; what it does not need is not looked at.
Effect SceneEffect(const Scene& scene, const std::string& name);

// Their names, in order.
std::vector<std::string> EffectNames();

// All EFFECT_* with 0 or 1 as the expander wants them; `forced` has the last word, by name.
using EffectDefines = std::vector<std::pair<std::string, int>>;
EffectDefines Defines(const std::vector<Effect>& effects, const std::map<std::string, bool>& forced = {});

}  // namespace arealab
