// From shaded pictures to the window: textures of linear radiance, and the one pass that turns them into a display's codes.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "glsl/gl_objects.h"
#include "glsl/pixels.h"

namespace arealab {

enum class Lobe { kTotal, kDiffuse, kSpecular };
enum class PictureKind { kPlain, kSigned, kMagnitude, kFalseColor };
enum class ViewTransform { kSrgb, kAces, kPbrNeutral, kAgx, kOcio };

// The maps' colours are the report's: OKLCH, lightness linear along the scale [Ottosson 2020]. sRGB codes, 0 … 1.
glm::vec3 SignedColor(double t);     // t in [−1, 1]: blue below, nearly black at 0, orange above
glm::vec3 MagnitudeColor(double t);  // t in [0, 1]

struct DisplaySettings {
  PictureKind kind = PictureKind::kPlain;
  double exposure = 0.0;  // EV, the scene's included
  ViewTransform transform = ViewTransform::kSrgb;
  double range = 1.0;  // relative difference at the end of a map
  bool logarithmic = true;
  double floor_luminance = 0.0;
};

class Display {
 public:
  explicit Display(const GladGLContext& gl);

  static constexpr int kSlots = 16;

  // Slot 0 … kSlots − 1. Uploads what is not there yet.
  void SetPicture(int slot, const std::shared_ptr<const RadianceImage>& image,
                  const std::shared_ptr<const std::vector<glm::vec3>>& emission, Lobe lobe);
  // What kOcio shows: kViewTableSize³ codes (app/view/ocio.h).
  void SetViewTable(const std::vector<glm::vec4>& nodes);
  bool HasPicture(int slot) const { return slots_[static_cast<std::size_t>(slot)].texture.id() != 0; }

  // `area`: px, left, bottom, width, height; `part` of its width alone is painted. Slot b is the reference of a difference.
  void Draw(const glm::ivec4& area, int slot_a, int slot_b, const DisplaySettings& settings, glm::vec2 part = {0.0f, 1.0f});

 private:
  struct Slot {
    GlObject texture;
    glm::ivec2 size{0};
    std::shared_ptr<const RadianceImage> image;
    Lobe lobe = Lobe::kTotal;
  };

  // One program per kind of picture, transform, and whether pictures are as large as the area: a software rasteriser
  // would compute both sides of every choice for every pixel.
  const GlObject& Program(PictureKind kind, ViewTransform transform, bool exact);

  const GladGLContext& gl_;
  std::map<std::tuple<PictureKind, ViewTransform, bool>, GlObject> programs_;
  GlObject vertex_array_;
  GlObject signed_scale_, magnitude_scale_, view_table_;
  std::array<Slot, kSlots> slots_;
  std::vector<glm::vec4> texels_;
};

}  // namespace arealab
