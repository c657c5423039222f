#include "app/view/ocio.h"

#include <OpenImageIO/color.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "scenes/error.h"

namespace arealab {
namespace {

// Names that configurations give to linear light with the primaries of sRGB; the role is what is left where there is none.
constexpr const char* kLinearSrgb[] = {"lin_rec709", "Linear Rec.709 (sRGB)", "lin_rec709_srgb", "Utility - Linear - Rec.709", "Utility - Linear - sRGB",
                                       "lin_srgb",   "Linear Rec.709",         "Linear sRGB"};

class OiioConfig final : public OcioConfig {
 public:
  explicit OiioConfig(const std::string& file) : file_(file), config_(file) {
    if (!OIIO::ColorConfig::supportsOpenColorIO() || config_.has_error()) Refuse(config_.geterror());
    const std::vector<std::string> spaces = config_.getColorSpaceNames();
    for (const char* name : kLinearSrgb) {
      if (input_.empty() && std::ranges::find(spaces, name) != spaces.end()) input_ = name;
    }
    const char* role = config_.getColorSpaceNameByRole("scene_linear");
    if (input_.empty() && role != nullptr) input_ = role;
    if (input_.empty()) Refuse("no colour space for linear light");
    const char* display = config_.getDefaultDisplayName();
    if (display == nullptr) Refuse("no display");
    display_ = display;
    const char* first = config_.getDefaultViewName(display_);
    if (first != nullptr) views_.emplace_back(first);
    for (int i = 0; i < config_.getNumViews(display_); ++i) {
      const std::string view = config_.getViewNameByIndex(display_, i);
      if (std::ranges::find(views_, view) == views_.end()) views_.push_back(view);
    }
    if (views_.empty()) Refuse(fmt::format("the display {} has no view", display_));
  }

  const std::vector<std::string>& views() const override { return views_; }
  const std::string& input() const override { return input_; }

  std::vector<glm::vec4> Bake(const std::string& view) const override {
    const OIIO::ColorProcessorHandle processor = config_.createDisplayTransform(display_, view, input_);
    if (!processor) Refuse(config_.geterror());
    const auto level = [](int i) { return std::exp2(std::lerp(kViewTableLow, kViewTableHigh, static_cast<float>(i) / (kViewTableSize - 1))); };
    std::vector<glm::vec4> nodes;
    nodes.reserve(static_cast<std::size_t>(kViewTableSize) * kViewTableSize * kViewTableSize);
    for (int b = 0; b < kViewTableSize; ++b) {
      for (int g = 0; g < kViewTableSize; ++g) {
        for (int r = 0; r < kViewTableSize; ++r) nodes.emplace_back(level(r), level(g), level(b), 1.0f);
      }
    }
    constexpr OIIO::stride_t kPixel = sizeof(glm::vec4), kRow = kPixel * kViewTableSize * kViewTableSize;
    processor->apply(&nodes.front().x, kViewTableSize * kViewTableSize, kViewTableSize, 3, sizeof(float), kPixel, kRow);
    return nodes;
  }

 private:
  [[noreturn]] void Refuse(std::string why) const {
    std::ranges::replace(why, '\n', ' ');
    throw InputError(fmt::format("{}: {}; expected an OpenColorIO configuration in OCIO, or none", file_, why.empty() ? "cannot be read" : why));
  }

  std::string file_, display_, input_;
  mutable OIIO::ColorConfig config_;  // which forgets an error as it tells it
  std::vector<std::string> views_;
};

}  // namespace

std::unique_ptr<const OcioConfig> OcioConfig::FromEnvironment() {
  const char* file = std::getenv("OCIO");
  if (file == nullptr || *file == '\0') return nullptr;
  return std::make_unique<const OiioConfig>(file);
}

}  // namespace arealab
