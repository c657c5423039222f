#include "glsl/light_textures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "scenes/light_texture.h"
#include "scenes/texture_weights.h"

namespace arealab {
namespace {

struct Form {
  const char* name;
  GLuint unit;  // as in glsl/platform_inputs.glsl
};
constexpr Form kForms[] = {{"light_image", 8}, {"light_weights", 9}, {"light_means", 10}, {"light_cosine", 11}, {"light_cosine_border", 12},
                          {"light_solid_angle", 13}, {"light_phong", 7}, {"light_straight", 15}};

constexpr int kSide = 128;           // of level 0 of means and blurred forms
constexpr int kMeanLevels = 8;       // 128 … 1
constexpr int kMostWeightLevels = 7; // 64 × 64 squares of 3 × 3 nodes
constexpr double kBorder = 0.125;    // of a bordered form's side, on each side of the light

TextureLevels ImageLevels(const ShownTexture& texture, const std::vector<ShownTexture>& like) {
  TextureLevels result;
  for (const ShownTexture& other : like) result.size = glm::max(result.size, glm::ivec2(other.image->width, other.image->height));
  std::vector<glm::vec4>& texels = result.levels.emplace_back(static_cast<std::size_t>(result.size.x) * static_cast<std::size_t>(result.size.y), glm::vec4(0.0f));
  for (int y = 0; y < texture.image->height; ++y) {
    const auto row = texture.image->pixels.begin() + static_cast<std::ptrdiff_t>(y) * texture.image->width;
    std::copy(row, row + texture.image->width, texels.begin() + static_cast<std::ptrdiff_t>(y) * result.size.x);
  }
  return result;
}

TextureLevels WeightLevels(const Image& image, std::size_t nodes, int levels) {
  const TextureWeights weights(image, nodes, levels);
  const auto n = static_cast<int>(nodes);
  TextureLevels result{glm::ivec2(n << (levels - 1)), {}};
  for (int level = levels - 1; level >= 0; --level) {
    const int squares = 1 << level, side = n * squares;
    std::vector<glm::vec4>& texels = result.levels.emplace_back(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const glm::vec3& weight = weights.Of(level, x / n, y / n)[static_cast<std::size_t>(y % n * n + x % n)];
        texels[static_cast<std::size_t>(y) * static_cast<std::size_t>(side) + static_cast<std::size_t>(x)] = glm::vec4(weight, 1.0f);
      }
    }
  }
  return result;
}

TextureLevels StraightLevels(const Image& image) {
  Image straight = image, alpha = image;
  for (glm::vec4& texel : straight.pixels) texel = texel.a > 0.0f ? texel / texel.a : glm::vec4(0.0f);
  for (glm::vec4& texel : alpha.pixels) texel = glm::vec4(texel.a);
  TextureLevels levels = WeightLevels(straight, 1, kMeanLevels);
  const TextureLevels alphas = WeightLevels(alpha, 1, kMeanLevels);
  for (std::size_t level = 0; level < levels.levels.size(); ++level) {
    for (std::size_t i = 0; i < levels.levels[level].size(); ++i) levels.levels[level][i].a = alphas.levels[level][i].r;
  }
  return levels;
}

// r of a level, in √area.
double FilterDistance(int level) { return (std::exp2(level) - 1.0) / 32.0; }

// The means of a texture, `means`[level] of 2^level squares a side, averaged around each texel of `side` × `side` with a weight that
// depends on the distance in √area alone. `kernel` of the squared distance; `begin` and `end` are the texels' range of uv;
// where not `inside`, those on the light are left out.
std::vector<glm::vec4> Blurred(const TextureWeights& means, int mean_level, double aspect, int side, double begin, double end,
                               bool inside, const std::function<double(double)>& kernel) {
  const int squares = 1 << mean_level;
  const double width = std::sqrt(aspect), height = 1.0 / width;
  // The kernel over the distance, whose square root spreads the steps towards 0, where it is steepest.
  constexpr int kSteps = 8192;
  const double reach2 = (width * width + height * height) * std::max(end * end, 1.0);
  std::vector<float> table(kSteps + 2);
  for (int i = 0; i < kSteps + 2; ++i) table[static_cast<std::size_t>(i)] = static_cast<float>(kernel(reach2 * i * i / (static_cast<double>(kSteps) * kSteps)));
  std::vector<glm::vec3> texels(static_cast<std::size_t>(squares) * static_cast<std::size_t>(squares));
  for (int y = 0; y < squares; ++y) {
    for (int x = 0; x < squares; ++x) texels[static_cast<std::size_t>(y * squares + x)] = means.Of(mean_level, x, y)[0];
  }
  std::vector<glm::vec4> blurred(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
  tbb::parallel_for(0, side, [&](int y) {
    for (int x = 0; x < side; ++x) {
      const double u = begin + (end - begin) * (x + 0.5) / side, v = begin + (end - begin) * (y + 0.5) / side;
      if (!inside && u == std::clamp(u, 0.0, 1.0) && v == std::clamp(v, 0.0, 1.0)) continue;
      glm::vec3 sum(0.0f);
      float weight = 0.0f;
      for (int j = 0; j < squares; ++j) {
        const auto dy = static_cast<float>((v - (j + 0.5) / squares) * height);
        glm::vec3 row(0.0f);
        float row_weight = 0.0f;
        for (int i = 0; i < squares; ++i) {
          const auto dx = static_cast<float>((u - (i + 0.5) / squares) * width);
          const float at = std::sqrt((dx * dx + dy * dy) / static_cast<float>(reach2)) * kSteps;
          const auto step = static_cast<std::size_t>(std::min(at, static_cast<float>(kSteps)));
          const float w = table[step] + (table[step + 1] - table[step]) * (at - static_cast<float>(step));
          row += w * texels[static_cast<std::size_t>(j * squares + i)];
          row_weight += w;
        }
        sum += row;
        weight += row_weight;
      }
      blurred[static_cast<std::size_t>(y * side + x)] = glm::vec4(sum / weight, 1.0f);
    }
  });
  return blurred;
}

// kernel(r²) gives the weight as a function of ρ².
TextureLevels BlurredLevels(const ShownTexture& texture, bool border, const std::function<double(double, double)>& kernel) {
  if (texture.image->pixels.size() == 1) return WeightLevels(*texture.image, 1, kMeanLevels);  // layer 0
  const TextureWeights means(*texture.image, 1, kMeanLevels);
  const double around = border ? kBorder / (1.0 - 2.0 * kBorder) : 0.0;
  TextureLevels result{glm::ivec2(kSide), {}};
  for (int level = 0; level < kMeanLevels; ++level) {
    // The means that go into it are at least two to an r, and no coarser than 32 a side. Level 0 is the texture itself, around it
    // the limit of small r.
    const int from = level == 1 || level == 2 ? 6 : 5;
    const double r = level > 0 ? FilterDistance(level) : 0.25 / kSide;
    const int side = kSide >> level;
    std::vector<glm::vec4>& texels = result.levels.emplace_back(static_cast<std::size_t>(side) * static_cast<std::size_t>(side));
    if (level > 0 || border) {
      texels = Blurred(means, from, texture.aspect, side, -around, 1.0 + around, level > 0, [&](double rho2) { return kernel(r * r, rho2); });
    }
    if (level > 0) continue;
    for (int y = 0; y < side; ++y) {
      for (int x = 0; x < side; ++x) {
        const glm::dvec2 uv = -around + (1.0 + 2.0 * around) * (glm::dvec2(x, y) + 0.5) / static_cast<double>(side);
        if (uv != glm::clamp(uv, 0.0, 1.0)) continue;
        texels[static_cast<std::size_t>(y * side + x)] = glm::vec4(TextureAt(*texture.image, uv), 1.0f);
      }
    }
  }
  return result;
}

}  // namespace

std::vector<ShownTexture> LightTextureLayers(const std::vector<Light>& lights) {
  static const auto white = std::make_shared<const Image>(Image{1, 1, {glm::vec4(1.0f)}});
  std::vector<ShownTexture> shown = ShownTextures(lights);
  shown.insert(shown.begin(), {white, 1.0});
  return shown;
}

TextureLevels MakeTextureLevels(const std::string& name, const ShownTexture& texture, const std::vector<ShownTexture>& like) {
  if (name == "light_image") return ImageLevels(texture, like);
  if (name == "light_weights") {
    int levels = 1;
    for (const ShownTexture& other : like) levels = std::max(levels, TextureWeights::LevelsFor(*other.image, kMostWeightLevels));
    return WeightLevels(*texture.image, 3, levels);
  }
  if (name == "light_means") return WeightLevels(*texture.image, 1, kMeanLevels);
  if (name == "light_straight") return StraightLevels(*texture.image);
  // What does not depend on ρ falls out in the normalisation.
  if (name == "light_solid_angle") {
    return BlurredLevels(texture, false, [](double r2, double rho2) { return std::sqrt(r2) / std::pow(r2 + rho2, 1.5); });
  }
  if (name == "light_phong") {
    return BlurredLevels(texture, false, [](double r2, double rho2) {
      const double half_angle = std::atan(std::sqrt(r2)), exponent = std::max(2.0 / (half_angle * half_angle) - 2.0, 0.0);
      return std::pow(1.0 + rho2, -0.5 * (exponent + 3.0));  // cos^g × the solid angle
    });
  }
  return BlurredLevels(texture, name == "light_cosine_border", [](double r2, double rho2) { return r2 / ((r2 + rho2) * (r2 + rho2)); });
}

LightTextures::LightTextures(const GladGLContext& gl) : gl_(gl) { Take({}); }

void LightTextures::Take(const std::vector<Light>& lights) {
  std::vector<ShownTexture> shown = LightTextureLayers(lights);
  if (shown == shown_) return;
  shown_ = std::move(shown);
  forms_.clear();
}

void LightTextures::Bind(const Program& program) {
  for (const Form& form : kForms) {
    if (!program.Reads(form.name)) continue;
    GlObject& texture = forms_[form.name];
    const std::size_t missing = texture.id() == 0 ? shown_.size() : 0;
    for (std::size_t layer = 0; layer < missing; ++layer) {
      const TextureLevels made = MakeTextureLevels(form.name, shown_[layer], shown_);
      if (layer == 0) texture = MakeTextureArray(gl_, GL_RGBA32F, static_cast<int>(made.levels.size()), {made.size, shown_.size()});
      for (std::size_t level = 0; level < made.levels.size(); ++level) {
        const glm::ivec2 size = made.size >> static_cast<int>(level);
        gl_.TextureSubImage3D(texture.id(), static_cast<GLint>(level), 0, 0, static_cast<GLint>(layer), size.x, size.y, 1, GL_RGBA, GL_FLOAT,
                              made.levels[level].data());
      }
    }
    gl_.BindTextureUnit(form.unit, texture.id());
  }
}

}  // namespace arealab
