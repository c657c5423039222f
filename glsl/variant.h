// A technique with its options chosen: what a person names on the command line and reads in the report.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glsl/effects.h"
#include "glsl/technique.h"

namespace arealab {

// What is done where the picture needs an effect in a part only: nothing; a branch in the program; tiles, classified once and each drawn by the
// program that it needs. What a pixel needs: glsl/needs.glsl.
enum class PerPixel { kNo, kBranch, kTiles };

struct Variant {
  const Technique* technique = nullptr;        // into the registry, which outlives it
  std::map<std::string, std::string> options;  // every option of the technique → choice
  std::map<std::string, bool> effects = {};    // forced on or off, by name; the scene decides the others
  PerPixel per_pixel = PerPixel::kNo;

  // Canonical: "ltc", "ltc+clip=switch+edge=rational"; keys in header order, defaults left out. Forced effects last:
  // "ltc+effect_horizon=1", "ltc+effects=all", "ltc+per_pixel=tiles".
  std::string Name() const;
  // "ltc@published" where these are its author's choices and differ from the defaults, else Name().
  std::string ShortName() const;
  bool operator==(const Variant& other) const;
};

Variant DefaultVariant(const Technique& technique);
Variant PublishedVariant(const Technique& technique);

// The variant with no shortcut of computation, where its technique has any: [ideal] of its header, as far as the choices go together
// and with a scene's BRDFs. Computed in double, it is the mathematics that the variant's own numbers stand for.
Variant IdealVariant(const Variant& variant, Brdfs brdfs = {});

// The variant with every effect forced on that its technique takes; shapes are left to the scene where it does not do them,
// apertures, textures and the sky always: without them there is nothing to look at.
Variant WithAllEffects(Variant variant);

// Reads "ltc", "ltc@published", "ltc+clip=switch", "ltc@published+edge=acos". Throws InputError that lists what exists.
Variant ParseVariant(const std::vector<Technique>& techniques, std::string_view name);

// Each technique's default and, where it differs, its published form: what `compare` shows.
std::vector<Variant> DefaultVariants(const std::vector<Technique>& techniques);

// Each technique's default and published form, and each of both with any one option chosen otherwise: every choice
// beside the others that it is likely to be seen with. (Every combination would be tens of thousands.)
std::vector<Variant> AllVariants(const std::vector<Technique>& techniques);

// The library's name of the file that a technique's table is read from, "tables/ltc_ggx_polygon.exr": its placeholders
// filled with the variant's choices and the scene's BRDFs.
std::string TableFile(const Variant& variant, const Table& table, Brdfs brdfs);

// The technique's tables that are read there: those of {diffuse} are not where it is Lambert's.
std::vector<Table> TablesOf(const Variant& variant, Brdfs brdfs);

// A sentence that says which of the variant's choices does not go with another, or nothing.
std::optional<std::string> WhyInconsistent(const Variant& variant);

// A sentence that says why the variant cannot shade the scene, or nothing.
std::optional<std::string> WhyUnsupported(const Variant& variant, const Scene& scene);

// The same where the scene's effects are known already; then its meshes are not looked at.
std::optional<std::string> WhyUnsupported(const Variant& variant, const Scene& scene, const std::vector<Effect>& effects);

}  // namespace arealab
