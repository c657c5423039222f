// Small scenes drawn at random, many of which do without some effect: a light clear of every horizon, one shape, white light on grey
// matter, a wall seen from its front. The same seed is the same scene.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "scenes/scene.h"
#include "scenes/shapes.h"

namespace arealab {

class RandomScenes {
 public:
  // `kind` fixes what materials and shapes there are, so that many seeds share a program; geometry goes by the seed.
  static constexpr int kKinds = 12;

  static Scene Make(unsigned seed) {
    RandomScenes random(seed);
    return random.Draw(static_cast<int>(seed) % kKinds);
  }

 private:
  explicit RandomScenes(unsigned seed) : engine_(seed) {}

  // mt19937's own numbers, since the library's distributions are not the same everywhere.
  double Uniform(double low, double high) { return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0); }
  bool Chance(double share) { return Uniform(0.0, 1.0) < share; }
  double LogUniform(double low, double high) { return low * std::pow(high / low, Uniform(0.0, 1.0)); }
  glm::dvec3 Direction() {
    const double z = Uniform(-1.0, 1.0), angle = Uniform(0.0, 6.283185307179586);
    const double r = std::sqrt(1.0 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

  Scene Draw(int kind) {
    Scene scene;
    scene.name = "random";
    scene.camera.position = {Uniform(-1.5, 1.5), -4.0, Uniform(0.4, 3.0)};
    scene.camera.target = {Uniform(-0.5, 0.5), Uniform(-0.5, 0.5), Uniform(0.0, 0.8)};
    const bool grey = kind % 2 == 0, matte = kind % 6 == 4, metal = kind % 6 == 5, curved = kind % 3 == 1, bent = kind == 7;
    AddMaterial(scene, grey, matte, metal, kind == 11, bent, kind == 8);
    AddSurfaces(scene, curved);
    const bool high = Chance(0.4);
    const int lights = kind % 4 == 3 ? 3 : 1;
    for (int i = 0; i < lights; ++i) AddLight(scene, kind < 8 ? kind % 3 : i % 3, kind % 4 < 2, kind == 2 || kind == 9, high);
    return scene;
  }

  void AddMaterial(Scene& scene, bool grey, bool matte, bool metal, bool mirror, bool bent, bool weighted) {
    Material material;
    material.name = "stuff";
    const double g = Uniform(0.05, 0.95);
    material.base_color = grey ? glm::vec3(static_cast<float>(g)) : glm::vec3(glm::dvec3(g, Uniform(0.0, 1.0), Uniform(0.0, 1.0)));
    material.roughness = {static_cast<float>(Uniform(0.05, 1.0)), static_cast<float>(Uniform(0.05, 1.0))};
    if (metal || mirror) material.metalness = 1.0f;
    if (mirror) material.base_color = glm::vec3(1.0f);
    if (matte) material.specular = 0.0f;
    if (weighted) material.specular = static_cast<float>(Uniform(0.1, 0.9));
    if (bent) {
      Image image{4, 4, {}};
      for (int i = 0; i < 16; ++i) {
        image.pixels.emplace_back(glm::dvec4(Uniform(0.2, 0.8), Uniform(0.2, 0.8), 1.0, 1.0));
      }
      material.normal_texture = std::make_shared<Image>(std::move(image));
    }
    scene.materials.push_back(material);
  }

  void AddSurfaces(Scene& scene, bool curved) {
    const glm::dmat3 tilt = RotationFromDegrees({Uniform(-15.0, 15.0), Uniform(-15.0, 15.0), Uniform(0.0, 360.0)});
    scene.meshes.push_back(MakePlane({Uniform(1.0, 6.0), Uniform(1.0, 6.0)}, {{0.0, 0.3, 0.0}, tilt}));
    if (!curved) return;
    const glm::dvec3 place(Uniform(-0.8, 0.8), Uniform(-0.8, 0.8), Uniform(0.2, 0.6));
    if (Chance(0.5)) {
      scene.meshes.push_back(MakeBox({Uniform(0.2, 0.8), Uniform(0.2, 0.8), Uniform(0.2, 0.8)}, {place, tilt}));
    } else {
      const double height = LogUniform(0.01, 0.5);
      scene.meshes.push_back(MakeHeightField(
          {2.0, 2.0}, {12, 12},
          [&](double x, double y) {
            return glm::dvec3(height * std::sin(2.0 * x) * std::cos(y), 2.0 * height * std::cos(2.0 * x) * std::cos(y),
                              -height * std::sin(2.0 * x) * std::sin(y));
          },
          {place, tilt}));
    }
  }

  void AddLight(Scene& scene, int shape, bool white, bool two_sided, bool high) {
    Light light;
    light.shape = static_cast<LightShape>(shape);
    light.half_size.x = LogUniform(0.05, 1.0);
    light.half_size.y = light.shape == LightShape::kRectangle ? LogUniform(0.05, 1.0) : light.half_size.x;
    light.center = {Uniform(-2.0, 2.0), Uniform(-1.0, 2.5), high ? Uniform(3.0, 8.0) : Uniform(-0.3, 1.5)};
    light.normal = Direction();
    const bool down = Chance(0.7);
    if (down) light.normal = glm::normalize(glm::dvec3(0.0, 0.0, 0.3) - light.center);
    light.axis_x = glm::normalize(glm::cross(light.normal, glm::normalize(Direction() + glm::dvec3(1e-3, 0.0, 0.0))));
    light.axis_y = glm::cross(light.normal, light.axis_x);
    light.two_sided = two_sided;
    const double radiance = LogUniform(0.1, 100.0);
    light.radiance = white ? glm::dvec3(radiance) : radiance * glm::dvec3(1.0, Uniform(0.2, 1.0), Uniform(0.2, 1.0));
    scene.lights.push_back(light);
  }

  std::mt19937 engine_;
};

}  // namespace arealab
