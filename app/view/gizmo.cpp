#include "app/view/gizmo.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <optional>
#include <string>

#include "app/view/camera.h"
#include "app/view/outline.h"

namespace arealab {
namespace {

constexpr int kCenter = 3;  // the handle in the middle; 0 … 2 are the axes
constexpr double kReach = 5.5;    // handles' length and rings' radius, in heights of the type
constexpr double kSnapMetres = 0.1;
constexpr double kSnapAngle = 15.0 * glm::pi<double>() / 180.0;

constexpr ImU32 kAxisColors[3] = {IM_COL32(226, 92, 92, 255), IM_COL32(128, 196, 92, 255), IM_COL32(92, 148, 232, 255)};
constexpr ImU32 kAccent = IM_COL32(240, 176, 92, 255);
constexpr ImU32 kQuiet = IM_COL32(235, 235, 235, 130);
constexpr ImU32 kHot = IM_COL32(255, 236, 180, 255);

ImVec2 ToImGui(glm::dvec2 p) { return {static_cast<float>(p.x), static_cast<float>(p.y)}; }

double ToSegment(glm::dvec2 p, glm::dvec2 a, glm::dvec2 b) {
  const glm::dvec2 along = b - a;
  const double length2 = glm::dot(along, along);
  const double t = length2 > 0.0 ? std::clamp(glm::dot(p - a, along) / length2, 0.0, 1.0) : 0.0;
  return glm::distance(p, a + t * along);
}

// Where on the line c + t a the ray from o along d passes closest; m.
std::optional<double> AlongLine(const glm::dvec3& o, const glm::dvec3& d, const glm::dvec3& c, const glm::dvec3& a) {
  const glm::dvec3 w = o - c;
  const double ad = glm::dot(a, d), denominator = 1.0 - ad * ad;
  if (denominator < 1e-4) return std::nullopt;  // seen end on
  return (glm::dot(a, w) - ad * glm::dot(d, w)) / denominator;
}

std::array<glm::dvec3, 3> Axes(const Light& light, GizmoMode mode) {
  if (mode == GizmoMode::kMove) return {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
  return {light.axis_x, light.axis_y, light.normal};
}

// Whether it is scaled along each of its axes by itself.
bool HasTwoSizes(LightShape shape) { return shape != LightShape::kDisk && shape != LightShape::kSphere; }

bool Exists(const Light& light, GizmoMode mode, int handle) {
  if (light.shape == LightShape::kSphere) return mode == GizmoMode::kMove || (mode == GizmoMode::kScale && handle == kCenter);
  if (mode == GizmoMode::kTurn) return handle != kCenter;
  if (mode == GizmoMode::kScale) return handle == kCenter || (handle < 2 && HasTwoSizes(light.shape));
  return true;
}

}  // namespace

bool Gizmo::Run(Session& session, glm::dvec2 origin, glm::dvec2 size, glm::dvec2 pointer, bool pointer_free) {
  ImDrawList& draw = *ImGui::GetBackgroundDrawList();
  draw.PushClipRect(ToImGui(origin), ToImGui(origin + size), true);
  const ImGuiIO& io = ImGui::GetIO();
  const Projection view(session.scene.camera, size);
  const float line = ImGui::GetFontSize() / 16.0f;
  const auto pixel = [&](const glm::dvec3& p) { return view.Pixel(p); };
  const auto polyline = [&](const std::vector<glm::dvec3>& points, ImU32 color, float width) {
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const auto a = pixel(points[i]), b = pixel(points[i + 1]);
      if (!a || !b) continue;
      nearest = std::min(nearest, ToSegment(pointer, *a, *b));
      if (width > 0.0f) draw.AddLine(ToImGui(origin + *a), ToImGui(origin + *b), color, width);
    }
    return nearest;
  };

  bool taken = false;
  for (std::size_t i = 0; i < session.scene.lights.size(); ++i) {
    const Light& light = session.scene.lights[i];
    const bool selected = static_cast<int>(i) == session.light;
    if (selected) polyline(Outline(light, view.position), kAccent, 1.5f * line);
    const auto at = pixel(light.center);
    if (!at || selected) continue;
    const double radius = 5.0 * line;
    const bool over = pointer_free && handle_ < 0 && glm::distance(pointer, *at) < 2.0 * radius;
    draw.AddCircleFilled(ToImGui(origin + *at), static_cast<float>(radius) + 1.5f * line, IM_COL32(0, 0, 0, 90));
    draw.AddCircle(ToImGui(origin + *at), static_cast<float>(radius), over ? kHot : kQuiet, 0, 1.5f * line);
    if (over) {
      taken = true;
      ImGui::SetTooltip("%s", light.name.c_str());
      if (ImGui::IsMouseClicked(0)) session.light = static_cast<int>(i);
    }
  }
  if (session.light < 0) {
    handle_ = -1;
    draw.PopClipRect();
    return taken;
  }

  Light& light = session.scene.lights[static_cast<std::size_t>(session.light)];
  const auto center = pixel(light.center);
  if (!center) {
    handle_ = -1;
    draw.PopClipRect();
    return taken;
  }
  const auto axes = Axes(light, session.gizmo);
  const double reach = kReach * ImGui::GetFontSize();
  const double length = reach * view.PixelSize(light.center);
  const double near = 7.0 * line;

  // What the pointer is on: the nearest handle within reach of it.
  int hovered = -1;
  double best = near;
  const auto offer = [&](int handle, double distance) {
    if (distance < best) best = distance, hovered = handle;
  };
  for (int i = 0; i < 3; ++i) {
    if (!Exists(light, session.gizmo, i)) continue;
    const auto k = static_cast<std::size_t>(i);
    if (session.gizmo == GizmoMode::kTurn) {
      offer(i, polyline(Circle(light.center, length * axes[(k + 1) % 3], length * axes[(k + 2) % 3]), 0, 0.0f));
    } else if (const auto end = pixel(light.center + length * axes[k])) {
      offer(i, ToSegment(pointer, *center + 0.25 * (*end - *center), *end));
    }
  }
  if (Exists(light, session.gizmo, kCenter) && glm::distance(pointer, *center) < 1.4 * near) hovered = kCenter;
  if (!pointer_free) hovered = -1;

  if (handle_ < 0 && hovered >= 0 && ImGui::IsMouseClicked(0)) {
    handle_ = hovered;
    grabbed_ = pointer;
    before_ = light;
  }
  const bool released = handle_ >= 0 && !ImGui::IsMouseDown(0);

  if (handle_ >= 0) {
    const auto held = static_cast<std::size_t>(std::min(handle_, 2));
    const auto from = Axes(before_, session.gizmo);
    const auto before_center = pixel(before_.center);
    const auto snapped = [&](double v, double step) { return io.KeyCtrl ? std::round(v / step) * step : v; };
    if (session.gizmo == GizmoMode::kMove && handle_ == kCenter) {
      const glm::dvec2 moved = pointer - grabbed_;
      light.center = before_.center + view.PixelSize(before_.center) * (moved.x * view.right - moved.y * view.up);
    } else if (session.gizmo == GizmoMode::kMove) {
      const auto then = AlongLine(view.position, view.Direction(grabbed_), before_.center, from[held]);
      const auto now = AlongLine(view.position, view.Direction(pointer), before_.center, from[held]);
      if (then && now) light.center = before_.center + snapped(*now - *then, kSnapMetres) * from[held];
    } else if (session.gizmo == GizmoMode::kTurn && before_center) {
      const auto angle_at = [&](glm::dvec2 p) { return std::atan2(-(p.y - before_center->y), p.x - before_center->x); };
      double angle = angle_at(pointer) - angle_at(grabbed_);
      if (glm::dot(from[held], before_.center - view.position) > 0.0) angle = -angle;  // the axis points away from us
      angle = snapped(std::remainder(angle, 2.0 * glm::pi<double>()), kSnapAngle);
      light.axis_x = glm::normalize(glm::angleAxis(angle, from[held]) * before_.axis_x);
      light.normal = glm::normalize(glm::angleAxis(angle, from[held]) * before_.normal);
      light.axis_y = glm::cross(light.normal, light.axis_x);
    } else if (before_center) {
      const double ratio = glm::distance(pointer, *before_center) / std::max(glm::distance(grabbed_, *before_center), 4.0 * line);
      for (int i = 0; i < 2; ++i) {
        const bool whole = handle_ == kCenter || !HasTwoSizes(before_.shape);
        const double grown = handle_ == kCenter ? std::exp2((pointer.x - grabbed_.x) / reach) : ratio;
        if (!whole && handle_ != i) continue;
        light.half_size[i] = std::clamp(before_.half_size[i] * grown, 5e-4, 1e5);
        for (std::size_t k = 0; k < light.corners.size(); ++k) {
          light.corners[k][i] = before_.corners[k][i] * (light.half_size[i] / before_.half_size[i]);
        }
      }
    }
  }

  if (released) handle_ = -1;

  const int shown = handle_ >= 0 ? handle_ : hovered;
  for (int i = 0; i < 3; ++i) {
    if (!Exists(light, session.gizmo, i)) continue;
    const auto k = static_cast<std::size_t>(i);
    const ImU32 color = shown == i ? kHot : kAxisColors[i];
    const float width = (shown == i ? 3.0f : 2.0f) * line;
    if (session.gizmo == GizmoMode::kTurn) {
      polyline(Circle(light.center, length * axes[(k + 1) % 3], length * axes[(k + 2) % 3]), color, width);
      continue;
    }
    const auto end = pixel(light.center + length * axes[k]);
    if (!end) continue;
    draw.AddLine(ToImGui(origin + *center), ToImGui(origin + *end), color, width);
    const glm::dvec2 along = *end - *center;
    const double shown_length = glm::length(along);
    if (shown_length < 4.0) continue;
    const glm::dvec2 d = along / shown_length, side(-d.y, d.x);
    if (session.gizmo == GizmoMode::kMove) {
      const double tip = 11.0 * line;
      draw.AddTriangleFilled(ToImGui(origin + *end + tip * d), ToImGui(origin + *end + 0.42 * tip * side),
                             ToImGui(origin + *end - 0.42 * tip * side), color);
    } else {
      const glm::dvec2 half(4.5 * line);
      draw.AddRectFilled(ToImGui(origin + *end - half), ToImGui(origin + *end + half), color, 1.5f * line);
    }
  }
  if (Exists(light, session.gizmo, kCenter)) {
    draw.AddCircleFilled(ToImGui(origin + *center), 5.5f * line, shown == kCenter ? kHot : kAccent);
    draw.AddCircle(ToImGui(origin + *center), 5.5f * line, IM_COL32(0, 0, 0, 140), 0, line);
  }
  draw.PopClipRect();
  return taken || hovered >= 0 || handle_ >= 0;
}

}  // namespace arealab
