// The few controls and colours that every panel is made of.
#pragma once

#include <imgui.h>

#include <glm/glm.hpp>
#include <string>

#include "app/view/session.h"

namespace arealab::widgets {

constexpr ImGuiWindowFlags kFixedWindow = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                          ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;

// A calm dark style and the program's typeface at `pixels` of height.
void ApplyStyle(float pixels);

void Dim(const std::string& text);
void Note(const std::string& text);     // a sentence, wrapped, dim
void Heading(const std::string& text);  // of a group
void Gap(float width);                  // on the same line
void Tooltip(const std::string& text);
void Tip(const std::string& text);  // for the item before
// A label and its unit in the left column; the next control fills the right one.
void Row(const std::string& label, const std::string& unit, const std::string& tip);
// Buttons of which one is chosen.
void Segments(const char* id, const char* const* names, int count, int& chosen, const std::string& tip);

// The colours of a map from end to end with their values, its bottom right corner at `corner`.
void DrawLegend(ImDrawList& draw, const Session& session, ImVec2 corner, float unit);

// "two_sided" → "Two sided".
std::string EffectLabel(const std::string& effect);

// The colour of a black body, linear sRGB of luminance 1, negative parts cut off; kelvin from 1667 to 25000
// [Kim et al. 2002, cubic approximation of the Planckian locus].
glm::dvec3 PlanckianColor(double kelvin);

}  // namespace arealab::widgets
