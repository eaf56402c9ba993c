#include "src/forecast/mesh_quality.hpp"

#include <algorithm>
#include <cmath>

#include "src/base/index.hpp"
#include "src/deck/element_quality.hpp"
#include "src/model/part_shape.hpp"

namespace brio {

namespace {

double smallest_step(const Model& model, std::size_t block) {
  double least = HUGE_VAL;
  for (std::size_t t = 0; t < model.schedule.tasks.size(); ++t)
    if (model.schedule.tasks[t].block == block) least = std::min(least, model.sweep_results[t].stable_step);
  return least;
}

}  // namespace

MeshQuality quality_of(const Model& model, std::size_t number) {
  const PartInModel& part = model.parts[number];
  MeshQuality quality;
  quality.step = smallest_step(model, part.block);
  std::vector<Corner> corners;
  for (std::size_t e = 0; e < part.element_slot.size(); ++e) {
    std::vector<int> nodes = nodes_of_element(model, part, e);
    corners.clear();
    for (const int node : nodes) {
      const double* x = model.nodes.record[index(node)].position;
      corners.push_back({x[0], x[1], x[2]});
    }
    quality.aspect = std::max(quality.aspect, aspect_of(corners));
    quality.warp = std::max(quality.warp, warp_of(corners));
    quality.jacobian = std::min(quality.jacobian, scaled_jacobian_of(corners));
    std::sort(nodes.begin(), nodes.end());
    if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end()) ++quality.degenerate;
  }
  return quality;
}

}  // namespace brio
