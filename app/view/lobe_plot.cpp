#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "app/view/panels.h"
#include "app/view/widgets.h"

namespace arealab {
namespace {

constexpr ImU32 kRing = IM_COL32(255, 255, 255, 36);
constexpr ImU32 kHorizon = IM_COL32(255, 255, 255, 150);
constexpr ImU32 kBrdfLine = IM_COL32(235, 236, 240, 255);
constexpr ImU32 kLtcLine = IM_COL32(92, 176, 240, 255);
constexpr ImU32 kLightLine = IM_COL32(240, 176, 92, 255);
constexpr ImU32 kQuietText = IM_COL32(150, 152, 158, 255);

// A picture of the unit disc on the screen.
struct Disc {
  ImDrawList& draw;
  ImVec2 center;
  float radius;

  ImVec2 At(glm::vec2 p) const { return {center.x + radius * p.x, center.y - radius * p.y}; }
  void Line(const std::vector<glm::vec2>& points, ImU32 color, float width, bool closed = false) const {
    for (std::size_t i = 0; i + (closed ? 0 : 1) < points.size(); ++i) {
      draw.AddLine(At(points[i]), At(points[(i + 1) % points.size()]), color, width);
    }
  }
  void Text(glm::vec2 p, const char* text, float align, ImU32 color = kQuietText) const {
    const ImVec2 extent = ImGui::CalcTextSize(text);
    draw.AddText({std::round(At(p).x - align * extent.x), std::round(At(p).y - 0.5f * extent.y)}, color, text);
  }
  // Where the viewer is: a ray through the rim.
  void Viewer(glm::vec2 direction, float width) const {
    draw.AddLine(At({0.0f, 0.0f}), At(direction), kRing, width);
  }
};

void FromTheSide(const Disc& disc, const LobePicture& picture, float line) {
  const float pi = 3.14159265f;
  for (const float r : {1.0f, 2.0f / 3.0f, 1.0f / 3.0f}) disc.draw.PathArcTo(disc.center, r * disc.radius, -pi, 0.0f, 48), disc.draw.PathStroke(kRing, 0, line);
  disc.draw.AddLine(disc.At({-1.12f, 0.0f}), disc.At({1.12f, 0.0f}), kHorizon, line);
  disc.Viewer(picture.to_view, line);
  disc.draw.AddCircleFilled(disc.At(picture.to_view), 2.2f * line, kQuietText);
  for (const auto& [from, to] : picture.spans) {  // screen angles run clockwise from +x
    disc.draw.PathArcTo(disc.center, 1.05f * disc.radius, from - 0.5f * pi, to - 0.5f * pi, 32);
    disc.draw.PathStroke(kLightLine, 0, 3.5f * line);
  }
  disc.Line(picture.ltc, kLtcLine, 1.5f * line);
  disc.Line(picture.brdf, kBrdfLine, 1.5f * line);
}

void FromAbove(const Disc& disc, const LobePicture& picture, float line) {
  for (const std::vector<glm::vec2>& light : picture.lights) disc.Line(light, kLightLine, 2.5f * line, true);
  for (const auto& [a, b] : picture.ltc_contours) disc.draw.AddLine(disc.At(a), disc.At(b), kLtcLine, 1.5f * line);
  for (const auto& [a, b] : picture.brdf_contours) disc.draw.AddLine(disc.At(a), disc.At(b), kBrdfLine, 1.5f * line);
  disc.draw.AddCircle(disc.center, disc.radius, kHorizon, 96, line);
  disc.Viewer({picture.to_view.x, 0.0f}, line);
  disc.draw.AddCircleFilled(disc.At({picture.to_view.x, 0.0f}), 2.2f * line, kQuietText);
  const glm::vec2 mirror(-picture.to_view.x, 0.0f);
  const float arm = 0.05f;
  disc.draw.AddLine(disc.At(mirror - glm::vec2(arm, 0.0f)), disc.At(mirror + glm::vec2(arm, 0.0f)), kQuietText, line);
  disc.draw.AddLine(disc.At(mirror - glm::vec2(0.0f, arm)), disc.At(mirror + glm::vec2(0.0f, arm)), kQuietText, line);
}

}  // namespace

void DrawLobe(PanelContext& context, glm::vec2 origin, glm::vec2 size) {
  const LobePicture& picture = context.inspection.picture;
  if (!context.inspection.surface || !(picture.peak > 0.0)) return;
  const float u = context.unit, line = u / 16.0f, radius = 5.2f * u;
  const float width = 5.0f * radius, height = 2.0f * radius + 5.4f * u;
  // Above a map's legend and the snapshots where there are any.
  const bool legend = context.session.layout == Layout::kDifference || context.session.false_color;
  const float foot = std::max(legend ? 4.0f * u : 0.0f, StripHeight(context, size)) + u;
  ImGui::SetNextWindowPos({origin.x + size.x - width - u, std::max(origin.y, origin.y + size.y - height - foot)});
  ImGui::SetNextWindowSize({width, height});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.35f * u);
  ImGui::SetNextWindowBgAlpha(0.88f);
  ImGui::Begin("##lobe", nullptr, widgets::kFixedWindow);
  ImGui::PopStyleVar();
  ImDrawList& draw = *ImGui::GetWindowDrawList();
  ImGui::Text("Specular lobe");
  widgets::Tip("BRDF × cosine with Fresnel 1. Left: the plane of incidence, the radius logarithmic, 1/3 of it a tenth. Right: seen from above, "
               "a half, a tenth and a hundredth of the BRDF's peak; there a light's share of the disc is its form factor.");
  ImGui::SameLine();
  widgets::Dim(fmt::format("peak {:.3g} 1/sr", picture.peak));
  const ImVec2 panel = ImGui::GetWindowPos();
  const float middle = panel.y + 2.6f * u + radius;
  const Disc side{draw, {panel.x + 1.22f * radius, middle + 0.42f * radius}, 1.08f * radius}, above{draw, {panel.x + 3.75f * radius, middle}, radius};
  draw.PushClipRect(panel, {panel.x + width, panel.y + height});
  FromTheSide(side, picture, line);
  FromAbove(above, picture, line);
  side.Text({0.0f, -0.32f}, "plane of incidence", 0.5f);
  for (const auto& [r, text] : {std::pair(1.0f, "1"), std::pair(2.0f / 3.0f, "0.1"), std::pair(1.0f / 3.0f, "0.01")}) side.Text({r, -0.1f}, text, 0.5f);
  draw.PopClipRect();
  ImGui::SetCursorPos({0.8f * u, height - 2.0f * u});
  const auto key = [&](ImU32 color, const std::string& text) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float y = at.y + 0.5f * ImGui::GetTextLineHeight();
    draw.AddLine({at.x, y}, {at.x + 1.2f * u, y}, color, 2.0f * line);
    ImGui::Dummy({1.2f * u, 1.0f});
    ImGui::SameLine(0.0f, 0.4f * u);
    ImGui::TextUnformatted(text.c_str());
    ImGui::SameLine(0.0f, 1.2f * u);
  };
  key(kBrdfLine, "BRDF");
  if (!picture.ltc_name.empty()) key(kLtcLine, "LTC of " + picture.ltc_name);
  key(kLightLine, "light");
  key(kHorizon, "horizon");
  ImGui::NewLine();
  ImGui::End();
}

}  // namespace arealab
