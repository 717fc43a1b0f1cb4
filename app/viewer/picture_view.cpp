// SPDX-License-Identifier: Apache-2.0
#include "viewer/picture_view.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace catoptric::viewer {
namespace {

constexpr ImU32 kWhite = IM_COL32(255, 255, 255, 255);

/// What can be shown now: the rest waits for the truth of this view.
Comparison shownComparison(const Model& model) {
  if (!model.truthIsCurrent()) return Comparison::None;
  const bool needsFigures =
      model.view.comparison == Comparison::Difference || model.view.comparison == Comparison::Displacement;
  return needsFigures && model.truth->difference.isEmpty() ? Comparison::None : model.view.comparison;
}

void drawCaption(ImDrawList* list, ImVec2 at, const char* text) {
  const ImVec2 size = ImGui::CalcTextSize(text);
  list->AddRectFilled(ImVec2(at.x - 4, at.y - 2), ImVec2(at.x + size.x + 4, at.y + size.y + 2),
                      IM_COL32(0, 0, 0, 160));
  list->AddText(at, kWhite, text);
}

/// Panels are at the left.
void drawCaptionAtRight(ImDrawList* list, ImVec2 size, const char* text) {
  drawCaption(list, ImVec2(size.x - ImGui::CalcTextSize(text).x - 14, size.y - 60), text);
}

/// The box of the picked object.
void drawSelection(const Model& model, ImDrawList* list, ImVec2 size) {
  if (!model.view.selected || !model.geometry || !model.view.showPanels || model.view.isPlaying) return;
  const std::uint32_t instance = model.view.selected->instance;
  // The geometry is that of the last frame at rest; the box is where the object has been taken to since.
  const dvec3 shift = model.view.state.shiftOf(instance) - model.geometryState.shiftOf(instance);
  const auto corners = findBoxInPicture(*model.geometry, instance, shift, model.view.camera,
                                        double(size.x) / std::max(size.y, 1.0f));
  if (!corners) return;
  for (std::size_t a = 0; a < 8; ++a)
    for (const std::size_t bit : {1u, 2u, 4u}) {
      const std::size_t b = a | bit;
      if (b == a) continue;
      const auto at = [&](std::size_t k) {
        return ImVec2(float((*corners)[k].x) * size.x, float((*corners)[k].y) * size.y);
      };
      list->AddLine(at(a), at(b), IM_COL32(255, 190, 60, 160));
    }
}

void drawSplit(const Model& model, const ShownPictures& pictures, ImDrawList* list, ImVec2 size) {
  const float line = model.view.split * size.x;
  pictures.truth.drawOpaque(*list, vec2(line, 0), vec2(size.x, size.y), vec2(model.view.split, 0));
  list->AddLine(ImVec2(line, 0), ImVec2(line, size.y), kWhite, 2);
  list->AddTriangleFilled(ImVec2(line - 4, size.y / 2 - 8), ImVec2(line - 4, size.y / 2 + 8),
                          ImVec2(line - 14, size.y / 2), kWhite);
  list->AddTriangleFilled(ImVec2(line + 4, size.y / 2 + 8), ImVec2(line + 4, size.y / 2 - 8),
                          ImVec2(line + 14, size.y / 2), kWhite);
  const char* method = model.variants[model.view.variant].name.c_str();
  drawCaption(list, ImVec2(line - 14 - ImGui::CalcTextSize(method).x, size.y - 60), method);
  drawCaption(list, ImVec2(line + 14, size.y - 60), "truth");
}

}  // namespace

void drawPicture(const Model& model, const ShownPictures& pictures, const ivec2& windowPx) {
  if (pictures.method.isEmpty()) return;
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const ImVec2 size(float(windowPx.x), float(windowPx.y));
  const Comparison shown = shownComparison(model);
  const ShownPicture& picture = shown == Comparison::Difference     ? pictures.difference
                                : shown == Comparison::Displacement ? pictures.displacement
                                                                    : pictures.method;
  picture.drawOpaque(*list, vec2(0), vec2(size.x, size.y));
  drawSelection(model, list, size);
  if (shown == Comparison::Split) drawSplit(model, pictures, list, size);
  if (shown == Comparison::Difference) drawCaptionAtRight(list, size, "difference from the truth, 8 x");
  if (shown == Comparison::Displacement)
    drawCaptionAtRight(list, size, "displacement: dark blue 0, green 1, yellow 2, orange 8 px, red lost");
  if (model.view.comparison == Comparison::Split &&
      shown == Comparison::None)  // the line can be dragged already
    list->AddLine(ImVec2(model.view.split * size.x, 0), ImVec2(model.view.split * size.x, size.y),
                  IM_COL32(255, 255, 255, 90), 2);
}

core::ImageRgba8 composeShownPicture(const Model& model) {
  const Comparison shown = shownComparison(model);
  if (shown == Comparison::Difference) return model.truth->difference;
  if (shown == Comparison::Displacement) return model.truth->displacement;
  core::ImageRgba8 picture = model.frame.picture;
  if (shown != Comparison::Split || model.truth->picture.width() != picture.width()) return picture;
  const int line = int(std::lround(model.view.split * float(picture.width())));
  for (int y = 0; y < picture.height(); ++y)
    for (int x = std::max(line, 0); x < picture.width(); ++x)
      picture.at(x, y) = model.truth->picture.at(x, y);
  return picture;
}

}  // namespace catoptric::viewer
