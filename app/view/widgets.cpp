#include "app/view/widgets.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

namespace arealab::widgets {
namespace {

const ImVec4 kText{0.86f, 0.87f, 0.88f, 1.0f};
const ImVec4 kDim{0.53f, 0.55f, 0.58f, 1.0f};

// Debian: fonts-dejavu-core. Latin, Greek, the superscripts of units, arrows.
constexpr const char* kTypeface = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
constexpr ImWchar kGlyphs[] = {0x20, 0x17f, 0x370, 0x3ff, 0x2010, 0x2044, 0x2070, 0x209f, 0x2190, 0x21ff, 0x2200, 0x22ff, 0};

ImVec4 Gray(float v, float alpha = 1.0f) { return {v, v + 0.004f, v + 0.012f, alpha}; }

}  // namespace

void ApplyStyle(float pixels) {
  ImGuiIO& io = ImGui::GetIO();
  io.Fonts->Clear();
  ImFontConfig config;
  config.OversampleH = 2;
  config.RasterizerMultiply = 1.1f;
  if (std::filesystem::exists(kTypeface)) {
    io.Fonts->AddFontFromFileTTF(kTypeface, std::round(0.94f * pixels), &config, kGlyphs);
  } else {
    config.SizePixels = pixels;
    io.Fonts->AddFontDefault(&config);
  }
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  const float u = pixels;
  style.WindowPadding = {0.8f * u, 0.6f * u};
  style.FramePadding = {0.5f * u, 0.28f * u};
  style.ItemSpacing = {0.5f * u, 0.42f * u};
  style.ItemInnerSpacing = {0.35f * u, 0.3f * u};
  style.ScrollbarSize = 0.7f * u;
  style.GrabMinSize = 0.6f * u;
  style.FrameRounding = 0.25f * u;
  style.PopupRounding = 0.3f * u;
  style.GrabRounding = 0.2f * u;
  style.TabRounding = 0.25f * u;
  style.ScrollbarRounding = 0.35f * u;
  style.WindowBorderSize = 0.0f;
  style.ChildBorderSize = 0.0f;
  style.PopupBorderSize = 1.0f;
  ImVec4* c = style.Colors;
  c[ImGuiCol_Text] = kText;
  c[ImGuiCol_TextDisabled] = kDim;
  c[ImGuiCol_WindowBg] = Gray(0.118f);
  c[ImGuiCol_ChildBg] = Gray(0.0f, 0.0f);
  c[ImGuiCol_PopupBg] = Gray(0.145f, 0.98f);
  c[ImGuiCol_Border] = Gray(0.24f);
  c[ImGuiCol_FrameBg] = Gray(0.175f);
  c[ImGuiCol_FrameBgHovered] = Gray(0.215f);
  c[ImGuiCol_FrameBgActive] = Gray(0.25f);
  c[ImGuiCol_Button] = Gray(0.19f);
  c[ImGuiCol_ButtonHovered] = Gray(0.25f);
  c[ImGuiCol_ButtonActive] = Gray(0.30f);
  c[ImGuiCol_Header] = Gray(0.25f);
  c[ImGuiCol_HeaderHovered] = Gray(0.22f);
  c[ImGuiCol_HeaderActive] = Gray(0.28f);
  c[ImGuiCol_Tab] = Gray(0.118f);
  c[ImGuiCol_TabHovered] = Gray(0.24f);
  c[ImGuiCol_TabActive] = Gray(0.21f);
  c[ImGuiCol_TabUnfocused] = c[ImGuiCol_Tab];
  c[ImGuiCol_TabUnfocusedActive] = c[ImGuiCol_TabActive];
  c[ImGuiCol_Separator] = Gray(0.2f);
  c[ImGuiCol_SliderGrab] = Gray(0.42f);
  c[ImGuiCol_SliderGrabActive] = {0.94f, 0.69f, 0.36f, 1.0f};
  c[ImGuiCol_CheckMark] = {0.94f, 0.69f, 0.36f, 1.0f};
  c[ImGuiCol_PlotLines] = c[ImGuiCol_PlotHistogram] = {0.94f, 0.69f, 0.36f, 1.0f};
  c[ImGuiCol_PlotLinesHovered] = {0.94f, 0.69f, 0.36f, 1.0f};
  c[ImGuiCol_ScrollbarBg] = Gray(0.0f, 0.0f);
  c[ImGuiCol_ScrollbarGrab] = Gray(0.25f);
  c[ImGuiCol_TextSelectedBg] = {0.94f, 0.69f, 0.36f, 0.35f};
  c[ImGuiCol_NavHighlight] = {0.94f, 0.69f, 0.36f, 0.8f};
}

void Dim(const std::string& text) { ImGui::TextDisabled("%s", text.c_str()); }

void Note(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, kDim);
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}

void Heading(const std::string& text) {
  ImGui::Dummy({1.0f, 0.25f * ImGui::GetFontSize()});
  ImGui::TextUnformatted(text.c_str());
  ImGui::Separator();
}

void Gap(float width) { ImGui::SameLine(0.0f, width); }

void Tooltip(const std::string& text) {
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(22.0f * ImGui::GetFontSize());
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void Tip(const std::string& text) {
  if (!text.empty() && ImGui::IsItemHovered() && ImGui::GetCurrentContext()->HoveredIdTimer > 0.35f) Tooltip(text);
}

void Row(const std::string& label, const std::string& unit, const std::string& tip) {
  const float width = 0.45f * ImGui::GetWindowContentRegionWidth();
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(label.c_str());
  Tip(tip);
  if (!unit.empty()) {
    ImGui::SameLine(0.0f, 0.4f * ImGui::GetFontSize());
    Dim(unit);
  }
  ImGui::SameLine(ImGui::GetCursorStartPos().x + width);
  ImGui::SetNextItemWidth(-1.0f);
}

void Segments(const char* id, const char* const* names, int count, int& chosen, const std::string& tip) {
  ImGui::PushID(id);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {1.0f, ImGui::GetStyle().ItemSpacing.y});
  for (int i = 0; i < count; ++i) {
    if (i > 0) ImGui::SameLine();
    const bool on = i == chosen;
    if (on) {
      ImGui::PushStyleColor(ImGuiCol_Button, Gray(0.33f));
      ImGui::PushStyleColor(ImGuiCol_ButtonHovered, Gray(0.35f));
    } else {
      ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.70f, 0.71f, 0.73f, 1.0f));
    }
    if (ImGui::Button(names[i])) chosen = i;
    ImGui::PopStyleColor(on ? 2 : 1);
    Tip(tip);
  }
  ImGui::PopStyleVar();
  ImGui::PopID();
}

void DrawLegend(ImDrawList& draw, const Session& session, ImVec2 corner, float unit) {
  const float width = 18.0f * unit, height = 0.7f * unit;
  const ImVec2 low(corner.x - width - 0.6f * unit, corner.y - height - 1.9f * unit);
  const bool stops = session.false_color && session.layout != Layout::kDifference;
  const bool two_sided = !stops && session.display.kind != PictureKind::kMagnitude;
  draw.AddRectFilled({low.x - 0.9f * unit, low.y - 0.6f * unit}, {corner.x + 0.3f * unit, corner.y + 0.2f * unit},
                     IM_COL32(18, 19, 22, 215), 0.35f * unit);
  constexpr int kSteps = 128;
  for (int i = 0; i < kSteps; ++i) {
    const double t = (i + 0.5) / kSteps;
    const glm::vec3 c = two_sided ? SignedColor(2.0 * t - 1.0) : MagnitudeColor(t);
    const float x0 = low.x + width * static_cast<float>(i) / kSteps, x1 = low.x + width * static_cast<float>(i + 1) / kSteps;
    draw.AddRectFilled({x0, low.y}, {x1 + 0.5f, low.y + height}, ImGui::ColorConvertFloat4ToU32({c.r, c.g, c.b, 1.0f}));
  }
  const auto tick = [&](double t, const std::string& text) {
    const float x = low.x + width * static_cast<float>(t);
    const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
    draw.AddLine({x, low.y + height}, {x, low.y + height + 0.25f * unit}, IM_COL32(200, 200, 204, 200));
    const float left = std::clamp(x - 0.5f * extent.x, low.x - 0.6f * unit, corner.x - extent.x);
    draw.AddText({left, low.y + height + 0.35f * unit}, IM_COL32(220, 220, 224, 255), text.c_str());
  };
  if (stops) {
    for (int ev = -8; ev <= 4; ev += 4) tick((ev + 8.0) / 12.0, fmt::format("{:+d} EV", ev));
    return;
  }
  // The ticks of a logarithmic map are decades below its end, of a linear one quarters.
  const double end = 100.0 * session.display.range;
  std::vector<std::pair<double, double>> marks{{1.0, end}};
  if (session.display.logarithmic) {
    marks.insert(marks.end(), {{0.5, 0.1 * end}, {0.0, 0.01 * end}});
  } else {
    marks.insert(marks.end(), {{0.5, 0.5 * end}, {0.0, 0.0}});
  }
  for (const auto& [t, percent] : marks) {
    const bool middle = t == 0.0;
    if (!two_sided) {
      tick(t, fmt::format("{:.3g} %", percent));
    } else if (middle) {
      tick(0.5, session.display.logarithmic ? fmt::format("±{:.3g} %", percent) : "0");
    } else {
      tick(0.5 + 0.5 * t, fmt::format("+{:.3g} %", percent));
      tick(0.5 - 0.5 * t, fmt::format("−{:.3g} %", percent));
    }
  }
}

std::string EffectLabel(const std::string& effect) {
  std::string label = effect;
  std::replace(label.begin(), label.end(), '_', ' ');
  label[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(label[0])));
  return label;
}

glm::dvec3 PlanckianColor(double kelvin) {
  const double t = std::clamp(kelvin, 1667.0, 25000.0);
  const double x = t <= 4000.0
                       ? -0.2661239e9 / (t * t * t) - 0.2343589e6 / (t * t) + 0.8776956e3 / t + 0.179910
                       : -3.0258469e9 / (t * t * t) + 2.1070379e6 / (t * t) + 0.2226347e3 / t + 0.240390;
  const double y = t <= 2222.0   ? ((-1.1063814 * x - 1.34811020) * x + 2.18555832) * x - 0.20219683
                   : t <= 4000.0 ? ((-0.9549476 * x - 1.37418593) * x + 2.09137015) * x - 0.16748867
                                 : ((3.0817580 * x - 5.87338670) * x + 3.75112997) * x - 0.37001483;
  const glm::dvec3 xyz(x / y, 1.0, (1.0 - x - y) / y);
  // [IEC 61966-2-1]
  glm::dvec3 rgb(glm::dot(glm::dvec3(3.2406, -1.5372, -0.4986), xyz), glm::dot(glm::dvec3(-0.9689, 1.8758, 0.0415), xyz),
                 glm::dot(glm::dvec3(0.0557, -0.2040, 1.0570), xyz));
  rgb = glm::max(rgb, glm::dvec3(0.0));
  return rgb / Luminance(rgb);
}

}  // namespace arealab::widgets
