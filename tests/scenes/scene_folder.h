// A folder of its own for each test, gone at its end, and a sound scene to spoil.
#pragma once

#include <OpenImageIO/imageio.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "scenes/error.h"
#include "scenes/scene.h"

namespace arealab {

class SceneFolder : public ::testing::Test {
 protected:
  SceneFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "arealab_scenes_XXXXXX").string();
    if (!mkdtemp(name.data())) ADD_FAILURE() << "no temporary folder " << name;
    outside_ = name;
    folder_ = outside_ / "scene";
    std::filesystem::create_directory(folder_);
  }
  ~SceneFolder() override { std::filesystem::remove_all(outside_); }

  std::filesystem::path Write(const std::filesystem::path& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }

  // One grey row of floats.
  void WriteImage(const std::filesystem::path& name, const std::vector<float>& row) const {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(name.string());
    ASSERT_TRUE(output && output->open((folder_ / name).string(), OIIO::ImageSpec(static_cast<int>(row.size()), 1, 1, OIIO::TypeDesc::FLOAT)));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, row.data()) && output->close());
  }

  Scene Load(const std::string& text) const { return LoadScene(Write("test.toml", text)); }

  // The error of loading `text`, or "" where there is none.
  std::string Error(const std::string& text) const {
    try {
      Load(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path outside_;
  std::filesystem::path folder_;
};

inline const std::string kCamera = R"([camera]
position = [0.0, -4.0, 1.5]
target = [0.0, 0.0, 0.0]
)";
inline const std::string kMaterial = R"([[material]]
name = "grey"
)";
inline const std::string kSurface = R"([[surface]]
type = "plane"
size = [2.0, 2.0]
material = "grey"
)";
inline const std::string kLight = R"([[light]]
name = "lamp"
shape = "rectangle"
position = [0.0, 0.0, 2.0]
target = [0.0, 0.0, 0.0]
size = [1.0, 0.5]
radiance = 1.0
)";

}  // namespace arealab
