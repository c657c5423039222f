#include "app/view/truth_picture.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "app/view/session.h"
#include "compare/shadowed_truth.h"
#include "compare/truth.h"
#include "compare/truth_bands.h"

namespace arealab {
namespace {

// A part is laid out in short rows: truth is computed, and stopped, in bands of eight; 30 ms each where it is dear, of a textured sky.
constexpr std::size_t kRow = 16;
constexpr std::size_t kGrids[] = {8, 4, 2, 1};  // px between the pixels of a pass

bool SameLook(const Scene& a, const Scene& b) {
  return a.brdfs() == b.brdfs() && Same(a.camera, b.camera) && Same(Edits{a.lights, a.materials, 0.0, a.sky}, Edits{b.lights, b.materials, 0.0, b.sky});
}

}  // namespace

bool TruthPicture::Is(const Scene& scene, std::uint64_t geometry, glm::ivec2 size) const {
  return scene_ && geometry == geometry_ && size == glm::ivec2(pixels_.width, pixels_.height) && SameLook(scene, *scene_);
}

void TruthPicture::Begin(std::shared_ptr<const Scene> scene, std::uint64_t geometry, const SurfacePixels& pixels,
                         std::shared_ptr<const RadianceImage> stand_in) {
  if (Is(*scene, geometry, {pixels.width, pixels.height})) return;
  scene_ = std::move(scene);
  geometry_ = geometry;
  pixels_ = pixels;
  stand_in_ = std::move(stand_in);
  truth_ = {pixels.width, pixels.height, std::vector<glm::vec3>(pixels.size(), glm::vec3(0.0f)), std::vector<glm::vec3>(pixels.size(), glm::vec3(0.0f))};
  is_known_.assign(pixels.size(), false);
  order_.clear();
  ends_.clear();
  const auto width = static_cast<std::size_t>(pixels.width), height = static_cast<std::size_t>(pixels.height);
  std::size_t before = 0;
  for (const std::size_t grid : kGrids) {
    for (std::size_t y = 0; y < height; y += grid) {
      for (std::size_t x = 0; x < width; x += grid) {
        const std::size_t i = y * width + x;
        const bool done = before > 0 && x % before == 0 && y % before == 0;
        if (!done && pixels.IsSurface(i)) order_.push_back(static_cast<std::uint32_t>(i));
      }
    }
    const std::size_t first = ends_.empty() ? 0 : ends_.back(), count = order_.size() - first;
    const std::size_t parts = before == 0 ? 1 : 8 / grid;  // shown one by one
    for (std::size_t k = 1; k <= parts; ++k) ends_.push_back(first + count * k / parts);
    before = grid;
  }
  known_ = 0;
  errors_.clear();
  error_ = 0.0;
  Show();
}

void TruthPicture::Refine(const std::function<void(double)>& progress) {
  const auto end = std::ranges::find_if(ends_, [&](std::size_t e) { return e > known_; });
  if (end == ends_.end()) return;
  const std::size_t count = *end - known_, rows = (count + kRow - 1) / kRow;
  SurfacePixels part{static_cast<int>(kRow), static_cast<int>(rows), pixels_.view_position, {}, {}, {}, {}};
  part.position.resize(rows * kRow);
  part.normal.resize(rows * kRow);
  part.base_color.resize(rows * kRow);
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = order_[known_ + k];
    part.position[k] = pixels_.position[i];
    part.normal[k] = pixels_.normal[i];
    part.base_color[k] = pixels_.base_color[i];
  }
  const double begin = share(), reach = static_cast<double>(count) / static_cast<double>(order_.size());
  const bool shadows = scene_->aperture.has_value();  // techniques have visibility there
  TruthOptions options;
  options.progress = [&](double fraction) { progress(begin + reach * fraction * (shadows ? 0.3 : 1.0)); };
  Truth truth = ComputeTruth(*scene_, part, options);
  if (shadows) {
    ShadowOptions shadow_options;
    shadow_options.progress = [&](double fraction) { progress(begin + reach * (0.3 + 0.7 * fraction)); };
    ShadowedTruth shadowed = ComputeShadowedTruth(*scene_, part, truth.radiance, options, shadow_options);
    truth.radiance = std::move(shadowed.radiance);
    for (std::size_t k = 0; k < count; ++k) truth.relative_error[k] = std::max(truth.relative_error[k], shadowed.relative_error[k]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = order_[known_ + k];
    truth_.diffuse[i] = truth.radiance.diffuse[k];
    truth_.specular[i] = truth.radiance.specular[k];
    is_known_[i] = true;
    if (truth.radiance.Total(k) != glm::vec3(0.0f)) errors_.push_back(truth.relative_error[k]);
  }
  known_ += count;
  error_ = Quantile(errors_, 0.999);
  Show();
}

// What is not known yet has the value of a corner of its square of the finest grid that has one, else the stand-in's. Of the corners it
// is the one whose surface is most like its own: others may lie beyond an edge or a horizon, as the stand-in's texel may.
void TruthPicture::Show() {
  auto image = std::make_shared<RadianceImage>(truth_);
  const auto width = static_cast<std::size_t>(truth_.width), height = static_cast<std::size_t>(truth_.height);
  const auto known_near = [&](std::size_t i) {
    const std::size_t x = i % width, y = i / width;
    std::optional<std::size_t> nearest;
    for (auto grid = std::rbegin(kGrids); grid != std::rend(kGrids) && !nearest; ++grid) {
      float least = std::numeric_limits<float>::infinity();
      for (std::size_t k = 0; k < 4; ++k) {
        const std::size_t cx = (x / *grid + k % 2) * *grid, cy = (y / *grid + k / 2) * *grid, corner = cy * width + cx;
        if (cx >= width || cy >= height || !is_known_[corner]) continue;
        const glm::vec4 normals = pixels_.normal[i] - pixels_.normal[corner], colors = pixels_.base_color[i] - pixels_.base_color[corner];
        const float unlike = glm::dot(normals, normals) + glm::dot(colors, colors);
        if (unlike < least) least = unlike, nearest = corner;
      }
    }
    return nearest;
  };
  const auto stand_in_at = [&](std::size_t x, std::size_t y) {
    const int w = stand_in_->width, h = stand_in_->height;
    const int sx = static_cast<int>(x) * w / truth_.width, sy = static_cast<int>(y) * h / truth_.height;
    for (const auto& [dx, dy] : {std::pair(0, 0), std::pair(0, 1), std::pair(0, -1), std::pair(1, 0), std::pair(-1, 0)}) {
      if (sx + dx < 0 || sy + dy < 0 || sx + dx >= w || sy + dy >= h) continue;
      const auto at = static_cast<std::size_t>((sy + dy) * w + sx + dx);
      if (stand_in_->Total(at) != glm::vec3(0.0f)) return at;
    }
    return static_cast<std::size_t>(sy * w + sx);
  };
  for (std::size_t i = 0; !complete() && i < truth_.size(); ++i) {
    if (is_known_[i] || !pixels_.IsSurface(i)) continue;
    if (const auto known = known_near(i)) {
      image->diffuse[i] = truth_.diffuse[*known];
      image->specular[i] = truth_.specular[*known];
    } else if (stand_in_) {
      const std::size_t source = stand_in_at(i % width, i / width);
      image->diffuse[i] = stand_in_->diffuse[source];
      image->specular[i] = stand_in_->specular[source];
    }
  }
  image_ = std::move(image);
}

}  // namespace arealab
