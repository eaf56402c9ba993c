#include "src/step/laid_open.hpp"

#include <algorithm>

#include "contact/pairs/laid_open.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

/// Place in the block of a part of an element of the surface; -1: none.
int place_of(const Model& model, std::size_t part, int surface_element) {
  const std::vector<int>& known = model.surface_numbers->element[part];
  const auto at = std::find(known.begin(), known.end(), surface_element);
  if (at == known.end()) return -1;
  return model.parts[part].element_slot[index(at - known.begin())];
}

void give_up(Model& model, std::size_t b, std::span<const int> places) {
  Block& block = model.blocks[b];
  const auto width = index(block.lanes);
  for (std::size_t t = 0; t < model.schedule.tasks.size(); ++t) {
    const SweepTask& task = model.schedule.tasks[t];
    if (task.block != b) continue;
    const std::size_t first = task.chunk.first_pack * width, end = first + task.chunk.element_count;
    SweepResult& result = model.sweep_results[t];
    for (int place : places) {
      if (index(place) < first || index(place) >= end) continue;
      block.lost.data()[first + result.lost++] = place;
      ++result.lost_by[index(DeletionCause::distortion)];
    }
  }
}

}  // namespace

bool give_up_crossed(Model& model, ThreadTeam& team) {
  for (SweepResult& result : model.sweep_results) {
    result.lost = 0;
    result.lost_by = {};
  }
  bool any = false;
  if (!model.surface_numbers || model.surface_numbers->deleted.empty()) return any;
  for (ContactScene& scene : model.contacts) {
    const std::vector<SurfaceElement> crossed = find_crossed_elements(
        scene.surface, scene.pairs, scene.motion, model.nodes, scene.erosion->change.new_face, team);
    for (std::size_t part = 0; part < model.parts.size(); ++part) {
      if (!model.blocks[part].loses_elements) continue;
      std::vector<int> places;
      for (const SurfaceElement& one : crossed)
        if (one.part == model.surface_numbers->part[part])
          if (const int place = place_of(model, part, one.element); place >= 0) places.push_back(place);
      std::sort(places.begin(), places.end());
      give_up(model, part, places);
      any = any || !places.empty();
    }
  }
  return any;
}

}  // namespace brio
