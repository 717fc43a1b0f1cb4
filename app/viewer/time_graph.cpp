// SPDX-License-Identifier: Apache-2.0
#include "viewer/time_graph.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>

namespace catoptric::viewer {
namespace {

struct Portion {
  const char* name;
  float FrameHistory::Entry::*milliseconds;
  ImU32 colour;
};
constexpr std::array<Portion, 4> kPortions{
    {{"primary", &FrameHistory::Entry::primaryMs, IM_COL32(90, 150, 230, 255)},
     {"virtual vertices", &FrameHistory::Entry::verticesMs, IM_COL32(240, 180, 60, 255)},
     {"reflection", &FrameHistory::Entry::reflectionMs, IM_COL32(110, 200, 120, 255)},
     {"reading back", &FrameHistory::Entry::readMs, IM_COL32(150, 150, 160, 255)}}};

/// A column a frame, newest at the right, portions on top of each other.
void drawColumns(const FrameHistory& history, ImVec2 corner, ImVec2 size, float fullMs) {
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(corner, ImVec2(corner.x + size.x, corner.y + size.y), IM_COL32(20, 20, 24, 255));
  const float width = size.x / float(FrameHistory::kFrames);
  const std::size_t shown = std::min(history.count, FrameHistory::kFrames);
  for (std::size_t i = 0; i < shown; ++i) {
    const FrameHistory::Entry& entry = history.entries[(history.count - shown + i) % FrameHistory::kFrames];
    const float x = corner.x + size.x - float(shown - i) * width;
    float y = corner.y + size.y;
    for (const Portion& portion : kPortions) {
      const float height = entry.*portion.milliseconds / fullMs * size.y;
      list->AddRectFilled(ImVec2(x, std::max(corner.y, y - height)),
                          ImVec2(x + std::max(1.0f, width - 0.5f), y), portion.colour);
      y = std::max(corner.y, y - height);
    }
  }
}

}  // namespace

void drawTimes(const Model& model) {
  const FrameHistory& history = model.history;
  const FrameHistory::Entry* newest = history.newest();
  if (newest == nullptr || !model.frame.frame) return;
  float fullMs = 20;
  for (const FrameHistory::Entry& entry : history.entries) fullMs = std::max(fullMs, entry.sum());
  const ImVec2 corner = ImGui::GetCursorScreenPos(), size(300, 70);
  drawColumns(history, corner, size, fullMs);
  ImGui::Dummy(size);
  for (const Portion& portion : kPortions) {
    ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(portion.colour), "%s %.1f ms", portion.name,
                       double(newest->*portion.milliseconds));
    if (&portion == &kPortions[0] || &portion == &kPortions[2]) ImGui::SameLine();
  }
  const FrameResult& frame = model.frame;
  const renderer::FrameCounters& counters = frame.frame->counters;
  ImGui::TextUnformatted(
      fmt::format(
          "{:.1f} ms at {}x{} (graph: up to {:.0f} ms)\n{} triangles, {} virtual vertices, {} virtual "
          "triangles\n{} mirrors drawn, {} culled",
          newest->sum(), frame.picture.width(), frame.picture.height(), fullMs,
          frame.request.scene->geometry.triangleCount(), counters.virtualVertices, counters.virtualTriangles,
          counters.reflectorsDrawn, counters.reflectorsCulled)
          .c_str());
}

}  // namespace catoptric::viewer
