#include "glsl/sky_maps.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scenes/sky.h"

namespace arealab {
namespace {

struct SkyForm {
  const char* name;
  GLuint unit;  // as in glsl/platform_inputs.glsl
};
constexpr SkyForm kSkyForms[] = {{"sky_image", 16}, {"sky_lobes", 17}, {"sky_cosine", 18}};

constexpr double kTau = 2.0 * glm::pi<double>();
constexpr int kCoarsest = 8;        // texels around of a form's last level
constexpr unsigned kMostAround = 2048;
constexpr int kLobesAround = 512;   // of level 0 of sky_lobes
constexpr int kLobeLayers = 4;      // as in glsl/sky_texture.glsl
constexpr int kLobeLevels = 6;      // the last holds α = 1
constexpr int kCosineAround = 128;
constexpr int kRings = 16, kSpokes = 24;  // of a lobe's directions

// Compiled for wider vectors too.
#if defined(__x86_64__) && !defined(__clang__)
#define AREALAB_SKY_CLONES __attribute__((target_clones("avx2", "default")))
#else
#define AREALAB_SKY_CLONES
#endif
// Adds to each of `count` texels, four floats, weights × the two texels above and the two below; those of the next are `step` floats on.
AREALAB_SKY_CLONES void AddTexels(float* to, const float* above, const float* below, const glm::vec4& weights, int count, int step) {
  const float a = weights.x, b = weights.y, c = weights.z, d = weights.w;
  if (step == 4) {
    for (int i = 0; i < 4 * count; ++i) to[i] += a * above[i] + b * above[i + 4] + c * below[i] + d * below[i + 4];
  } else {
    for (int i = 0; i < count; ++i, to += 4, above += step, below += step) {
      for (int k = 0; k < 4; ++k) to[k] += a * above[k] + b * above[k + 4] + c * below[k] + d * below[k + 4];
    }
  }
}
AREALAB_SKY_CLONES void AddScaled(float* to, const float* from, float weight, int count) {
  for (int i = 0; i < count; ++i) to[i] += weight * from[i];
}

// A map of `around` × around/2 texels that goes around, with its margins: rows of 5/4 · around.
struct SkyMap {
  int around;
  std::vector<glm::vec4> texels;

  explicit SkyMap(int a) : around(a), texels(static_cast<std::size_t>(Width()) * static_cast<std::size_t>(Height())) {}
  int Width() const { return around + around / 4; }
  int Height() const { return around / 2; }
  int Margin() const { return around / 8; }
  // Column x of the sky's own, 0 … around − 1.
  glm::vec4& At(int x, int y) { return texels[static_cast<std::size_t>(y * Width() + Margin() + x)]; }
  const glm::vec4& At(int x, int y) const { return texels[static_cast<std::size_t>(y * Width() + Margin() + x)]; }
  // Of a texel's middle; of one in a form whose first and last rows are the poles.
  glm::dvec2 Place(int x, int y) const { return {(x + 0.5) / around, (y + 0.5) / Height()}; }
  glm::dvec2 PoleToPole(int x, int y) const { return {(x + 0.5) / around, y / (Height() - 1.0)}; }
  // Of a texel of row y, sr.
  double SolidAngle(int y) const { return kTau / around * (std::cos(glm::pi<double>() * y / Height()) - std::cos(glm::pi<double>() * (y + 1) / Height())); }

  void FillMargins() {
    for (int y = 0; y < Height(); ++y) {
      for (int x = 0; x < Margin(); ++x) {
        At(x - Margin(), y) = At(x + around - Margin(), y);
        At(around + x, y) = At(x, y);
      }
    }
  }
  // Adds to each texel of a row of another map, whose first is at `place`, weight × what is there, bilinear. The widths are powers of
  // two: where that map is `phases` times as wide as this one, texels that many apart lie alike between this one's, and the row has
  // those of one phase after those of the other (Ordered puts them right).
  void AddRow(const glm::dvec2& place, float weight, std::vector<glm::vec4>& row) const {
    const double py = std::clamp(place.y * Height() - 0.5, 0.0, Height() - 1.0);
    const int y = static_cast<int>(py), below = std::min(y + 1, Height() - 1);
    const auto fy = static_cast<float>(py - y);
    const int width = static_cast<int>(row.size()), phases = std::max(width / around, 1), stride = std::max(around / width, 1), count = width / phases;
    for (int phase = 0; phase < phases; ++phase) {
      const double px = place.x * around - 0.5 + around + static_cast<double>(phase) / phases, left = std::floor(px);
      const auto fx = static_cast<float>(px - left);
      const glm::vec4 weights = weight * glm::vec4((1.0f - fx) * (1.0f - fy), fx * (1.0f - fy), (1.0f - fx) * fy, fx * fy);
      for (int i = 0, x = static_cast<int>(left) % around; i < count;) {  // as far as the map's right end, then from its left
        const int piece = std::min(count - i, (around - x + stride - 1) / stride);
        AddTexels(&row[static_cast<std::size_t>(phase * count + i)].x, &At(x, y).x, &At(x, below).x, weights, piece, 4 * stride);
        i += piece;
        x += piece * stride - around;
      }
    }
  }
  // Texel x of a row that AddRow has added to.
  const glm::vec4& Ordered(const std::vector<glm::vec4>& row, int x) const {
    const int phases = std::max(static_cast<int>(row.size()) / around, 1);
    return row[static_cast<std::size_t>(x % phases) * (row.size() / static_cast<std::size_t>(phases)) + static_cast<std::size_t>(x / phases)];
  }
};

// The image, and its means over two texels by two, each by its solid angle.
std::vector<SkyMap> ImageMaps(const Image& image) {
  std::vector<SkyMap> maps;
  const auto around = static_cast<int>(std::clamp(std::bit_ceil(static_cast<unsigned>(image.width)), 2U * kCoarsest, kMostAround));
  SkyMap& first = maps.emplace_back(around);
  const int finer = std::max((image.width + around - 1) / around, 1);  // samples along a side of a texel
  const bool centres = image.width == finer * around && image.height == finer * first.Height();  // of the image's texels, which they are
  tbb::parallel_for(0, first.Height(), [&](int y) {
    for (int x = 0; x < around; ++x) {
      glm::dvec3 sum(0.0);
      for (int k = 0; k < finer * finer; ++k) {
        if (centres) sum += glm::dvec3(image.pixels[static_cast<std::size_t>(finer * y + k / finer) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(finer * x + k % finer)]);
        else sum += SkyTexel(image, (glm::dvec2(x, y) + (glm::dvec2(k % finer, k / finer) + 0.5) / static_cast<double>(finer)) / glm::dvec2(around, first.Height()));
      }
      first.At(x, y) = glm::vec4(glm::vec3(sum / static_cast<double>(finer * finer)), 1.0f);
    }
  });
  first.FillMargins();
  while (maps.back().around > kCoarsest) {
    const SkyMap& fine = maps.back();
    SkyMap coarse(fine.around / 2);
    for (int y = 0; y < coarse.Height(); ++y) {
      const auto upper = static_cast<float>(fine.SolidAngle(2 * y)), lower = static_cast<float>(fine.SolidAngle(2 * y + 1));
      for (int x = 0; x < coarse.around; ++x) {
        const glm::vec4 above = fine.At(2 * x, 2 * y) + fine.At(2 * x + 1, 2 * y), below = fine.At(2 * x, 2 * y + 1) + fine.At(2 * x + 1, 2 * y + 1);
        coarse.At(x, y) = (above * upper + below * lower) / (2.0f * (upper + lower));
      }
    }
    coarse.FillMargins();
    maps.push_back(std::move(coarse));
  }
  return maps;
}

TextureLevels Levels(std::vector<SkyMap> maps) {
  TextureLevels result{{maps.front().Width(), maps.front().Height()}, {}};
  for (SkyMap& map : maps) result.levels.push_back(std::move(map.texels));
  return result;
}

// Directions of the lobe about +z, with weights that add up to 1, each to look up in the level of the image whose texels are half as
// high again as what it stands for, so that a small sun leaves no gaps between them. By the density D(h)/4 of h = (l + z)/2:
// tan²θh = α² u/(1 − u), u up to where l sets; its steps grow shorter towards the lobe's tail, which reaches far.
struct LobeDirection {
  glm::dvec3 direction;
  float weight;
  std::size_t level;
};
std::vector<LobeDirection> LobeDirections(double alpha, const std::vector<SkyMap>& image) {
  std::vector<LobeDirection> directions;
  double sum = 0.0;
  for (int ring = 0; ring < kRings; ++ring) {
    const double left = 1.0 - (ring + 0.5) / kRings, most = 1.0 / (1.0 + alpha * alpha), u = most * (1.0 - left * left);
    const double tan2_h = alpha * alpha * u / (1.0 - u), cos2_h = 1.0 / (1.0 + tan2_h);
    const double cosine = 2.0 * cos2_h - 1.0, sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
    const double density = alpha * alpha / (glm::pi<double>() * cos2_h * cos2_h * (alpha * alpha + tan2_h) * (alpha * alpha + tan2_h)) / 4.0;
    const double solid_angle = 2.0 * most * left / (density * kRings * kSpokes);
    const double level = std::log2(image.front().around * 1.5 * std::sqrt(solid_angle) / kTau);
    const double share = left * 2.0 / (1.0 + std::sqrt(1.0 + alpha * alpha * (1.0 / (cosine * cosine) - 1.0)));
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double phi = kTau * (spoke + (ring % 2 == 0 ? 0.25 : 0.75)) / kSpokes;
      directions.push_back({{sine * std::cos(phi), sine * std::sin(phi), cosine}, static_cast<float>(share),
                            static_cast<std::size_t>(std::clamp(std::round(level), 0.0, static_cast<double>(image.size() - 1)))});
      sum += share;
    }
  }
  for (LobeDirection& direction : directions) direction.weight /= static_cast<float>(sum);
  return directions;
}

SkyMap LobeMap(const std::vector<SkyMap>& image, int around, double alpha) {
  SkyMap map(around);
  const std::vector<LobeDirection> lobe = LobeDirections(alpha, image);
  tbb::parallel_for(0, map.Height(), [&](int y) {
    // Along a row the directions' places only move.
    const glm::dvec2 first = map.PoleToPole(0, y);
    const glm::dvec3 axis = SkyDirection(first, 0.0), side = SkyDirection({first.x + 0.25, 0.5}, 0.0), up = glm::cross(side, axis);
    std::vector<std::vector<glm::vec4>> rows(image.size());  // by level of the image; empty where none is looked up
    for (const LobeDirection& d : lobe) {
      const glm::dvec2 place = SkyCoordinates(side * d.direction.x + up * d.direction.y + axis * d.direction.z, 0.0);
      rows[d.level].resize(static_cast<std::size_t>(around), glm::vec4(0.0f));
      image[d.level].AddRow(place, d.weight, rows[d.level]);
    }
    for (int x = 0; x < around; ++x) {
      glm::vec4 sum(0.0f);
      for (std::size_t level = 0; level < image.size(); ++level) {
        if (!rows[level].empty()) sum += image[level].Ordered(rows[level], x);
      }
      map.At(x, y) = glm::vec4(glm::vec3(sum), 1.0f);
    }
  });
  map.FillMargins();
  return map;
}

SkyMap CosineMap(const std::vector<SkyMap>& image) {
  SkyMap map(kCosineAround);
  const SkyMap& source = *std::ranges::find_if(image, [](const SkyMap& level) { return level.around <= kCosineAround; });
  const int phases = map.around / source.around;
  tbb::parallel_for(0, map.Height(), [&](int y) {
    // The cosine depends on how far around a texel is from the normal alone.
    std::vector<glm::vec4> row(static_cast<std::size_t>(map.around), glm::vec4(0.0f));
    std::vector<float> sums(static_cast<std::size_t>(phases), 0.0f);
    for (int phase = 0; phase < phases; ++phase) {
      const glm::dvec3 normal = SkyDirection(map.PoleToPole(phase, y), 0.0);
      glm::vec4* to = &row[static_cast<std::size_t>(phase * source.around)];
      for (int j = 0; j < source.Height(); ++j) {
        for (int turn = 0; turn < source.around; ++turn) {
          const auto weight = static_cast<float>(std::max(glm::dot(normal, SkyDirection(source.Place(turn, j), 0.0)), 0.0) * source.SolidAngle(j));
          if (weight == 0.0f) continue;
          sums[static_cast<std::size_t>(phase)] += weight;
          const int ahead = source.around - turn;
          AddScaled(&to[0].x, &source.At(turn, j).x, weight, 4 * ahead);
          AddScaled(&to[ahead].x, &source.At(0, j).x, weight, 4 * turn);
        }
      }
    }
    for (int x = 0; x < map.around; ++x) map.At(x, y) = glm::vec4(glm::vec3(source.Ordered(row, x)) / sums[static_cast<std::size_t>(x % phases)], 1.0f);
  });
  map.FillMargins();
  return map;
}

std::vector<TextureLevels> SkyLevels(const std::string& name, const std::vector<SkyMap>& maps) {
  if (name == "sky_image") return {Levels(maps)};
  if (name == "sky_cosine") return {Levels({CosineMap(maps)})};
  std::vector<TextureLevels> layers;
  const double first = 2.0 * kTau / kLobesAround;  // kFirstSkyAlpha of glsl/sky_texture.glsl
  for (int layer = 0; layer < kLobeLayers; ++layer) {
    std::vector<SkyMap> levels;
    for (int level = 0; level < kLobeLevels; ++level) {
      levels.push_back(LobeMap(maps, kLobesAround >> level, first * std::exp2(level + static_cast<double>(layer) / kLobeLayers)));
    }
    layers.push_back(Levels(std::move(levels)));
  }
  return layers;
}

}  // namespace

std::vector<TextureLevels> MakeSkyLevels(const std::string& name, const Image& image) { return SkyLevels(name, ImageMaps(image)); }

void SkyMaps::Take(std::shared_ptr<const Image> image) {
  if (image == image_) return;
  image_ = std::move(image);
  forms_.clear();
}

void SkyMaps::Bind(const Program& program) {
  if (!image_) return;
  std::vector<SkyMap> maps;  // once a form is missing
  for (const SkyForm& form : kSkyForms) {
    if (!program.Reads(form.name)) continue;
    GlObject& texture = forms_[form.name];
    if (texture.id() == 0) {
      if (maps.empty()) maps = ImageMaps(*image_);
      const std::vector<TextureLevels> layers = SkyLevels(form.name, maps);
      texture = MakeTextureArray(gl_, GL_RGBA32F, static_cast<int>(layers[0].levels.size()), {layers[0].size, layers.size()});
      for (std::size_t layer = 0; layer < layers.size(); ++layer) {
        for (std::size_t level = 0; level < layers[layer].levels.size(); ++level) {
          const glm::ivec2 size = layers[layer].size >> static_cast<int>(level);
          gl_.TextureSubImage3D(texture.id(), static_cast<GLint>(level), 0, 0, static_cast<GLint>(layer), size.x, size.y, 1, GL_RGBA, GL_FLOAT,
                                layers[layer].levels[level].data());
        }
      }
    }
    gl_.BindTextureUnit(form.unit, texture.id());
  }
}

}  // namespace arealab
