// How error and cost grow along one axis: scenes made for each value, their results joined, drawn as curves.
#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace arealab {

struct SweepAxis {
  std::string name;   // "roughness"
  std::string title;  // with its unit, for the curves
  bool logarithmic = false;
  std::vector<double> values;  // the usual ones
};

const std::vector<SweepAxis>& SweepAxes();

// Throws InputError that lists the axes.
const SweepAxis& FindSweepAxis(const std::string& name);

// One point: a scene file's text, and the picture's size.
struct SweepPoint {
  std::string scene;
  glm::ivec2 size{0};
};

// Throws InputError where the axis does not reach that value. `size` is that of every axis but pixels.
SweepPoint MakeSweepPoint(const SweepAxis& axis, double value, glm::ivec2 size);

// Joins results of one axis, texts of results.json whose scenes have "sweep": {"axis", "title", "logarithmic", "value"}, into a
// folder with results.json, curves.csv and the page that draws them. Parts may come from several machines; a value that two
// have counts once. Returns the cost's fitted exponents as a table for a terminal. Throws InputError where parts do not fit.
std::string WriteSweep(const std::vector<std::string>& parts, const std::filesystem::path& directory);

// results.json with that field in every scene.
std::string SweepResults(const std::string& results, const SweepAxis& axis, const std::vector<double>& values);

}  // namespace arealab
