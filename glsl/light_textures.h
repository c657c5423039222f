// The textures of a scene's lights on the GL: array textures with a layer for each, layer 0 white, in the forms that shading text
// looks up. A form is made once, when a program first reads it.
//   light_image          the texels, in the layer's upper left corner
//   light_weights        TextureWeights of 3 × 3 nodes: a level's squares side by side, the finest in level 0
//   light_means          means over 128 × 128 squares, then half as many a side at each level
//   light_cosine         blurred: level l by what a cosine lobe that faces the light from r = (2^l − 1)/32 of its √area away throws
//                        on its plane, r²/(π (ρ² + r²)²), normalised over the light: what is a constant stays one, up to the edge
//   light_cosine_border  the same with what it is around the light: the light's own square is 0.125 … 0.875
//   light_solid_angle    blurred as light_cosine, by the light's solid angle from a point r before each place of it
//   light_phong          by Phong's lobe from √area before each place, along the normal, of the exponent whose importance cone
//                        (half angle √(2/(g + 2)) [Drobot 2014, eq. 1.18]) throws a trace of radius r there
//   light_straight       as light_means, of the colours not multiplied by alpha (black where it is 0) and, in w, of alpha
#pragma once

#include <map>
#include <string>
#include <vector>

#include "glsl/gl_objects.h"
#include "glsl/light_block.h"
#include "glsl/program.h"

namespace arealab {

// One form of one texture: a level's texels row by row, its sides halved from level to level, down to 1.
struct TextureLevels {
  glm::ivec2 size{0};
  std::vector<std::vector<glm::vec4>> levels;
};

// What the layers show, white first.
std::vector<ShownTexture> LightTextureLayers(const std::vector<Light>& lights);

// `name` as above. `like`: all textures of the array, since layers share sizes.
TextureLevels MakeTextureLevels(const std::string& name, const ShownTexture& texture, const std::vector<ShownTexture>& like);

class LightTextures {
 public:
  explicit LightTextures(const GladGLContext& gl);

  // Those of a scene's lights from now on; forms stay where they are the same.
  void Take(const std::vector<Light>& lights);

  // Binds the forms that the program reads.
  void Bind(const Program& program);

 private:
  const GladGLContext& gl_;
  std::vector<ShownTexture> shown_;  // white first
  std::map<std::string, GlObject> forms_;
};

}  // namespace arealab
