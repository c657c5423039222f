// The truth of a whole picture, refined while nothing moves: one of 64 of its pixels, then of 16, of 4, then all, in parts between
// which it may stop and go on later.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "glsl/pixels.h"
#include "scenes/scene.h"

namespace arealab {

class TruthPicture {
 public:
  // Whether it is the truth of that.
  bool Is(const Scene& scene, std::uint64_t geometry, glm::ivec2 size) const;
  // Keeps what it has where it is the truth of that already. `stand_in`, of any size, is shown where
  // nothing is known yet; it may be null.
  void Begin(std::shared_ptr<const Scene> scene, std::uint64_t geometry, const SurfacePixels& pixels,
             std::shared_ptr<const RadianceImage> stand_in);

  // The next part, on all processors. What `progress`, which gets the fraction done of the whole and is called often, throws ends it:
  // the part is lost, those before stay.
  void Refine(const std::function<void(double)>& progress);

  bool complete() const { return known_ == order_.size(); }
  double share() const { return order_.empty() ? scene_ ? 1.0 : 0.0 : static_cast<double>(known_) / static_cast<double>(order_.size()); }
  // The truth's own, relative, at 99.9 % of the lit pixels known so far.
  double error() const { return error_; }
  std::shared_ptr<const RadianceImage> image() const { return image_; }

 private:
  void Show();

  std::shared_ptr<const Scene> scene_;
  std::uint64_t geometry_ = 0;
  SurfacePixels pixels_;
  std::shared_ptr<const RadianceImage> stand_in_, image_;
  RadianceImage truth_;
  std::vector<bool> is_known_;        // by pixel
  std::vector<std::uint32_t> order_;  // surface pixels, those of the coarsest grid first
  std::vector<std::size_t> ends_;     // of the parts
  std::size_t known_ = 0;             // how many of them
  std::vector<float> errors_;
  double error_ = 0.0;
};

}  // namespace arealab
