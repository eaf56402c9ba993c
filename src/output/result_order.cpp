#include "src/output/result_order.hpp"

#include <algorithm>

#include "src/base/index.hpp"

namespace brio {

bool can_be_damaged(const Model& model) {
  return std::any_of(model.blocks.begin(), model.blocks.end(),
                     [](const Block& block) { return has_failure(block.material); });
}

std::int64_t deleted_so_far(const Model& model) { return model.erosion ? model.erosion->total_deleted() : 0; }

std::vector<std::int64_t> points_of_nodes(const Model& model) {
  std::vector<std::int64_t> points(model.nodes.size(), -1);
  std::int64_t count = 0;
  for (const PartInModel& part : model.parts)
    for (int node : part.node)
      // One of a part before, which shares it, has its number.
      if (std::int64_t& point = points[index(node)]; point < 0) point = count++;
  return points;
}

void balance_momentum(Model& model, Momentum now) {
  add_momentum(model.rigid, now);
  model.momentum.now = now.total;
  model.momentum.linear_scale = std::max(model.momentum.linear_scale, now.linear_size);
  model.momentum.angular_scale = std::max(model.momentum.angular_scale, now.angular_size);
}

}  // namespace brio
