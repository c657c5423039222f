// The user's own OpenColorIO configuration: the views of its default display, each baked into a table for the display pass.
#pragma once

#include <glm/glm.hpp>
#include <memory>
#include <string>
#include <vector>

namespace arealab {

// Nodes per axis of a baked view, and the stops of radiance after exposure that its first and last stand for: log2. Half a code
// between the nodes of a curve such as sRGB's: (22/63)²/8 · (ln 2/2.4)² · 255 = 0.3.
constexpr int kViewTableSize = 64;
constexpr float kViewTableLow = -14.0f, kViewTableHigh = 8.0f;

class OcioConfig {
 public:
  // The configuration that the environment variable OCIO names; null where it names none. Throws InputError where it cannot be used.
  static std::unique_ptr<const OcioConfig> FromEnvironment();
  virtual ~OcioConfig() = default;

  virtual const std::vector<std::string>& views() const = 0;
  virtual const std::string& input() const = 0;  // the colour space that the picture's linear sRGB is taken for
  // Display codes at the nodes, red fastest. Throws InputError.
  virtual std::vector<glm::vec4> Bake(const std::string& view) const = 0;
};

}  // namespace arealab
