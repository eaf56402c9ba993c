#include "src/sweep/release_ties.hpp"

#include <algorithm>

#include "src/motion/constraints.hpp"

namespace brio {

std::optional<Contribution> release_ties(Ties& ties, const Erosion& erosion, Nodes& nodes) {
  bool any = false;
  for (TiedNode& tied : ties.node) {
    const DeletedElement owner{tied.face_part, tied.element};
    tied.released = std::binary_search(erosion.deleted.begin(), erosion.deleted.end(), owner) ||
                    std::binary_search(erosion.freed.begin(), erosion.freed.end(), tied.tie.node);
    any = any || tied.released;
  }
  if (!any) return {};
  const NodeMotion lost = release(ties, nodes);
  return Contribution{.deleted = lost.energy, .dropped = {to_vector(lost.linear), to_vector(lost.angular)}};
}

}  // namespace brio
