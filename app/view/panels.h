// The window's controls: the bar above the picture, the column beside it, what is written on the picture.
#pragma once

#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "app/view/cycles.h"
#include "app/view/inspect.h"
#include "app/view/session.h"
#include "app/view/worker.h"

namespace arealab {

struct PanelContext {
  Session& session;
  const ViewState& state;
  double progress = 1.0;
  float unit = 16.0f;  // px: the height of the type
  std::string message;  // the last thing that was done or went wrong; empty: nothing
  bool trouble = false;
  const Inspection& inspection;
  bool inspecting = false;  // more of it is to come
  const Cycles& cycles;
  const std::map<std::string, std::vector<float>>& history;  // ns a lit pixel, by variant
  const std::vector<std::string>* ocio_views = nullptr;  // of the user's configuration; null: there is none
  std::string ocio_input = {};                           // the colour space that it takes the picture for
  std::string reading = {};                              // files that are being read or filtered; empty: none
  int flicker_pane = 0;
  bool over_wipe = false;
};

// What a person asked for that the window does.
struct PanelRequests {
  bool save = false, reload = false, screenshot = false, exr = false, turntable = false, snapshot = false, toggle_help = false;
  bool copy = false;  // the inspected pixel's test case, to the clipboard
};

// Where pane i of a grid of `count` lies in a picture of that size: left, top, width, height.
glm::vec4 GridCell(int i, int count, glm::vec2 size);

// Where snapshot i lies in the strip at the foot of a picture of that size, likewise, and how high the strip is: 0 where none is kept.
glm::vec4 StripCell(std::size_t i, glm::vec2 size, float unit);
float StripHeight(const PanelContext& context, glm::vec2 size);

// The light whose test case is copied; null where there is none.
const LightAtPixel* CaseLight(const Session& session, const Inspection& inspection);

float BarHeight(const PanelContext& context);
float ColumnWidth(const PanelContext& context);

void DrawBar(PanelContext& context, float width, PanelRequests& requests);
void DrawColumn(PanelContext& context, glm::vec2 position, glm::vec2 size, PanelRequests& requests);
// Names over the panes, the wipe's line, a map's legend, the pixel that is inspected. Origin top left, px.
void DrawOverlay(PanelContext& context, glm::vec2 origin, glm::vec2 size);
// The snapshots' frames and names; their pictures lie below.
void DrawStrip(PanelContext& context, glm::vec2 origin, glm::vec2 size);
// The lobe at the pixel that is inspected, in the picture's lower right: app/view/lobe_plot.cpp.
void DrawLobe(PanelContext& context, glm::vec2 origin, glm::vec2 size);
void DrawHelp(PanelContext& context, glm::vec2 window);

}  // namespace arealab
