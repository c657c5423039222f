// What the whole sky does to a point: for the truth.
#pragma once

#include <map>
#include <vector>

#include "compare/truth.h"

namespace arealab {

// Of unit radiance: form factor 1, the lobe's energy by the quadrature that the tables are fitted with; errors are what half as fine
// a rule differs by.
LightIntegrals IntegrateSky(const ShadingPoint& point);

// The same for a picture's points. The integrals depend on α and n·v alone: an α that more pixels share than a table has nodes
// gets one over √(n·v), read by a polynomial of fifth degree whose difference to that of third degree is added to the errors.
class SkyIntegrals {
 public:
  // Empty where the scene has no sky; then At is not to be called.
  SkyIntegrals(const Scene& scene, const SurfacePixels& pixels);

  LightIntegrals At(const ShadingPoint& point) const;

 private:
  std::map<double, std::vector<LightIntegrals>> tables_;  // by α
};

}  // namespace arealab
