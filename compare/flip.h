// HDR-FLIP: the difference that a viewer sees when two high-dynamic-range pictures alternate on a screen.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace arealab {

// A reference, prepared once, that many test images are held against.
//
// [Andersson, Nilsson, Shirley, Akenine-Möller 2021, Visualizing Errors in Rendered High Dynamic Range
// Images]: LDR-FLIP [Andersson et al. 2020] of both images tone-mapped (ACES fit) at N exposures; per pixel
// the largest; 67.02 pixels per degree (a 0.7 m wide screen of 3840 pixels at 0.7 m). The shortest exposure
// brings the reference's brightest luminance to 0.85, the longest its median; N = max(2, ceil(their distance
// in stops)). Departure: where half of the picture or more is black (its median is 0, which the paper leaves
// open) the median is that of the pixels that are not black.
class FlipReference {
 public:
  // Linear sRGB, row by row; negative values count as 0. Throws std::invalid_argument where width does not
  // divide the size.
  FlipReference(std::span<const glm::vec3> reference, int width);

  int width() const { return width_; }
  int height() const { return height_; }
  std::span<const glm::vec3> reference() const { return reference_; }
  const std::vector<float>& exposures() const {
    return exposures_;
  }  // EV; empty where the reference is not finite

  // Per pixel in [0, 1]; empty where a pixel of either is not finite. Throws std::invalid_argument on another
  // size.
  std::vector<float> MapOf(std::span<const glm::vec3> test) const;
  // The map's mean; NaN where there is no map.
  double MeanOf(std::span<const glm::vec3> test) const;

  // What one exposure of one image comes to, per pixel: Hunt-adjusted L*a*b* after the eye's filters, and how
  // much of an edge and of a point there is.
  struct Percept {
    std::vector<float> lightness, a, b, edge, point;
  };

 private:
  int width_ = 0, height_ = 0;
  std::vector<glm::vec3> reference_;
  std::vector<float> exposures_;
  std::vector<Percept> percepts_;  // one per exposure
};

}  // namespace arealab
