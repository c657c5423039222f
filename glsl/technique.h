// What a technique file says of itself in its header comment (TOML), and the registry read from those
// headers.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "glsl/shader_library.h"
#include "scenes/scene.h"

namespace arealab {

struct Choice {
  std::string name;                               // "arc"
  std::string summary;                            // one line
  // Other options and the choices of theirs that it goes with; under "brdf" and "diffuse" the one BRDF of a scene that it does.
  std::map<std::string, std::string> needs = {};
};

// A compile-time choice. Where the folder glsl/NAME/ exists, each choice is a file in it and `#include
// "NAME"` resolves to the chosen one; in every case the host emits `#define NAME_CHOICE 0|1` (upper case) for
// all choices.
struct Option {
  std::string name;  // "clip"
  std::string summary;
  std::vector<Choice> choices;  // the default first
};

// A uniform float that a person may turn: `uniform float knob_NAME`.
struct Knob {
  std::string name, label, unit;
  double initial = 0.0, min = 0.0, max = 1.0;
};

// A texture that the technique samples: `uniform sampler2D table_NAME`, loaded from glsl/tables/FILE, in
// which
// "{option}" stands for that option's choice, "{brdf}" and "{diffuse}" for the scene's BRDFs.
struct Table {
  std::string name;
  std::string file;
};

// Where a technique does not keep a law that it else claims, or that each must keep or depart from, and by how much.
struct Departure {
  std::string law;   // one of Laws()
  std::string lobe;  // "diffuse", "specular"; empty: both
  // What it covers: option → choices; under "shape", "brdf" and "diffuse" of the light and the scene; what is not named is covered.
  std::map<std::string, std::vector<std::string>> when;
  double error = 0.0;  // relative RMSE over the law's own cases (tests/compare/laws_test.cpp), the largest of what it covers
  std::string why;     // one line
};

struct Technique {
  std::string name;         // the file's stem: "ltc"
  std::string summary;      // one line
  std::string citation;     // bibliography key and section: "Heitz et al. 2016; Hill & Heitz 2016"
  std::string author_note;  // where published and default form are the same, or what ours changes; one line
  std::vector<LightShape> shapes;
  bool diffuse = true;  // lobes it shades
  bool specular = true;
  bool yardstick = false;  // what a user would otherwise do: compared only where asked for
  std::vector<std::string> brdfs;    // "ggx"
  std::vector<std::string> diffuse_brdfs{"lambert"};  // "lambert", which every technique knows
  std::vector<std::string> effects;  // EFFECT_* it takes: "two_sided", "fresnel", …
  std::vector<std::string> exact;  // the laws it keeps: "lambert_rectangle", "point_limit", …; departures excepted
  std::vector<Departure> departures;
  std::vector<Option> options;
  std::vector<Knob> knobs;
  std::vector<Table> tables;
  std::map<std::string, std::string>
      published;  // option → choice of the form its author published; empty: no options
  // option → choice that is the technique's own mathematics, with no shortcut of computation; what is not in it stays.
  std::map<std::string, std::string> ideal;
};

// Every law by name. Those that a header may claim: "lambert_SHAPE" and "specular_SHAPE" of each shape, equal to the truth of
// any BRDF it takes. Those that each technique claims or departs from: "point_limit", a light that shrinks tends to the
// truth of a point's; "mirror_limit", the specular lobe tends to the truth as roughness tends to 0; "additive", two halves
// of a light are the whole. Those that hold unless it departs: "scale", lengths a thousand times as large change nothing;
// "rotation", nor does turning everything; "radiance", twice the radiance is twice the picture, to the bit.
std::vector<std::string> Laws();

// What `text`, the file techniques/NAME.glsl, says of itself. Throws InputError with file and line.
Technique ReadTechnique(const ShaderLibrary& library, const std::string& name, std::string_view text);

// All techniques of the library, sorted by name. A wrong header throws InputError with file and line.
std::vector<Technique> LoadTechniques(const ShaderLibrary& library);

}  // namespace arealab
