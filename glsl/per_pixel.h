// Programs for pictures that need an effect in a part only.
#pragma once

#include "glsl/expand.h"
#include "scenes/scene.h"

namespace arealab {

// An effect that some pixels may do without, and its bit in what glsl/needs.glsl finds.
struct PixelNeed {
  const char* effect;
  int bit;
};
constexpr int kNeedsLight = 1;  // some light faces the pixel, or the sky does: else it is black
constexpr PixelNeed kPixelNeeds[] = {{"horizon", 2}, {"proxy_horizon", 4}, {"diffuse", 8}, {"specular", 16}};
constexpr int kHorizonNeeds = 2 | 4;

// Pixels along a tile's side: a tile is a wave of 64.
constexpr int kTileSize = 8;

// The bits that are worth asking for: of effects that are on, that the variant's text asks for (any, where it has no technique), and that some
// material or place may do without.
int NeedsToAsk(const ShaderLibrary& library, const Variant& variant, const std::vector<Effect>& effects, const Scene& scene);

// What asks them of tiles of a size (glsl/needs.frag); of one pixel, for what it costs there.
ExpandedSource NeedsSource(const ShaderLibrary& library, const Variant& variant, const std::vector<Effect>& effects, int asked, int tile_size);

// The variant without the effects among those asked for that `needs` lacks.
Variant VariantFor(Variant variant, int needs, int asked);

// One program of two lighting passes: the variant's, and where its pixel's own needs allow it the same without horizons. Functions that differ
// stand there twice, the second time under other names.
ExpandedSource BranchSource(const ShaderLibrary& library, const Variant& variant, const std::vector<Effect>& effects, Precision precision, Brdfs brdfs);

}  // namespace arealab
