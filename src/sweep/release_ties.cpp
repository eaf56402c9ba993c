#include "src/sweep/release_ties.hpp"

#include <algorithm>

namespace brio {

bool release_ties(Ties& ties, const Erosion& erosion, Nodes& nodes, EnergyBalance& energy,
                  MomentumBalance& momentum) {
  bool any = false;
  for (TiedNode& tied : ties.node) {
    const DeletedElement owner{tied.face_part, tied.element};
    tied.released = std::binary_search(erosion.deleted.begin(), erosion.deleted.end(), owner) ||
                    std::binary_search(erosion.freed.begin(), erosion.freed.end(), tied.tie.node);
    any = any || tied.released;
  }
  if (!any) return false;
  const NodeMotion lost = release(ties, nodes);
  energy.deleted += lost.energy;
  for (std::size_t i = 0; i < 3; ++i) {
    momentum.dropped.linear[i] += lost.linear[static_cast<Eigen::Index>(i)];
    momentum.dropped.angular[i] += lost.angular[static_cast<Eigen::Index>(i)];
  }
  return true;
}

}  // namespace brio
