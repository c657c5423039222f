// The window's controls: the bar above the picture, the column beside it, what is written on the picture.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/view/session.h"
#include "app/view/worker.h"

namespace arealab {

// What is known of one pixel.
struct Inspection {
  bool surface = false;
  std::string what;  // it is where it is no surface
  glm::ivec2 pixel{0};
  glm::dvec3 position{0.0};  // m
  double roughness = 0.0;
  double n_dot_v = 0.0;
  double form_factor = 0.0;  // of all lights
  std::string clipping;
  glm::dvec3 truth{0.0};     // of the lobe that is shown
  double truth_error = 0.0;  // relative
  std::vector<std::pair<std::string, glm::dvec3>> values;  // by variant
};

struct PanelContext {
  Session& session;
  const ViewState& state;
  double progress = 1.0;
  float unit = 16.0f;  // px: the height of the type
  std::string message;  // the last thing that was done or went wrong; empty: nothing
  bool trouble = false;
  Inspection inspection;
  int flicker_pane = 0;
  bool over_wipe = false;
};

// What a person asked for that the window does.
struct PanelRequests {
  bool save = false, reload = false, screenshot = false, exr = false, turntable = false, snapshot = false, toggle_help = false;
};

// Where pane i of a grid of `count` lies in a picture of that size: left, top, width, height.
glm::vec4 GridCell(int i, int count, glm::vec2 size);

float BarHeight(const PanelContext& context);
float ColumnWidth(const PanelContext& context);

void DrawBar(PanelContext& context, float width, PanelRequests& requests);
void DrawColumn(PanelContext& context, glm::vec2 position, glm::vec2 size, PanelRequests& requests);
// Names over the panes, the wipe's line, a map's legend, the pixel that is inspected. Origin top left, px.
void DrawOverlay(PanelContext& context, glm::vec2 origin, glm::vec2 size);
void DrawHelp(PanelContext& context, glm::vec2 window);

}  // namespace arealab
