// SPDX-License-Identifier: Apache-2.0
// How the scene that is shown differs from the file: the time of its animations, what was moved, what
// materials were changed to. A value: each thread brings its own copy of the scene to it (posed_scene.h). And
// the edits that led there, to undo them.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <variant>
#include <vector>

#include "catoptric/scene/material_edit.h"

namespace catoptric::viewer {

struct SceneState {
  std::optional<double> timeS;                     ///< absent: the rest pose
  std::map<std::uint32_t, dvec3> shifts;           ///< by instance, metres; never zero
  std::map<int, scene::MaterialValues> materials;  ///< by material; only those that differ from the file

  bool operator==(const SceneState&) const = default;
  [[nodiscard]] bool hasEdits() const { return !shifts.empty() || !materials.empty(); }

  [[nodiscard]] dvec3 shiftOf(std::uint32_t instance) const {
    const auto found = shifts.find(instance);
    return found == shifts.end() ? dvec3(0) : found->second;
  }
  void setShift(std::uint32_t instance, const dvec3& shift) {
    if (shift == dvec3(0))
      shifts.erase(instance);
    else
      shifts[instance] = shift;
  }
  /// `original`: of the file.
  [[nodiscard]] scene::MaterialValues valuesOf(int material, const scene::Material& original) const {
    const auto found = materials.find(material);
    return found == materials.end() ? scene::readMaterialValues(original) : found->second;
  }
  void setValues(int material, const scene::Material& original, const scene::MaterialValues& values) {
    if (values == scene::readMaterialValues(original))
      materials.erase(material);
    else
      materials[material] = values;
  }
};

/// One thing that the user has done: what, as it was, as it is.
template <class Value>
struct ValueEdit {
  std::uint32_t index = 0;  ///< instance or material
  Value before, after;
};
using ShiftEdit = ValueEdit<dvec3>;
using MaterialEdit = ValueEdit<scene::MaterialValues>;
using Edit = std::variant<ShiftEdit, MaterialEdit>;

/// Edits in order; undone ones stay until the next new one.
class EditHistory {
 public:
  /// What changes nothing is not kept.
  void add(const Edit& edit) {
    if (std::visit([](const auto& e) { return e.before == e.after; }, edit)) return;
    edits_.resize(done_);
    edits_.push_back(edit);
    ++done_;
  }
  void clear() {
    edits_.clear();
    done_ = 0;
  }
  [[nodiscard]] bool canUndo() const { return done_ > 0; }
  [[nodiscard]] bool canRedo() const { return done_ < edits_.size(); }
  /// False where there is nothing to undo. `materials`: of the file.
  bool undo(SceneState& state, const std::vector<scene::Material>& materials) {
    if (!canUndo()) return false;
    apply(edits_[--done_], false, state, materials);
    return true;
  }
  bool redo(SceneState& state, const std::vector<scene::Material>& materials) {
    if (!canRedo()) return false;
    apply(edits_[done_++], true, state, materials);
    return true;
  }

 private:
  static void apply(const Edit& edit, bool forward, SceneState& state,
                    const std::vector<scene::Material>& materials) {
    if (const auto* shift = std::get_if<ShiftEdit>(&edit))
      state.setShift(shift->index, forward ? shift->after : shift->before);
    if (const auto* material = std::get_if<MaterialEdit>(&edit))
      state.setValues(int(material->index), materials[material->index],
                      forward ? material->after : material->before);
  }

  std::vector<Edit> edits_;
  std::size_t done_ = 0;
};

}  // namespace catoptric::viewer
