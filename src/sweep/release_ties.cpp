#include "src/sweep/release_ties.hpp"

#include <algorithm>

#include "src/motion/constraints.hpp"

namespace brio {

namespace {

Contribution release_marked(Ties& ties, Nodes& nodes) {
  const NodeMotion lost = release(ties, nodes);
  return {.deleted = lost.energy, .dropped = {lost.linear, lost.angular}};
}

}  // namespace

std::optional<Contribution> release_ties(Ties& ties, const Erosion& erosion, Nodes& nodes) {
  bool any = false;
  for (TiedNode& tied : ties.node) {
    const DeletedElement owner{tied.face_part, tied.element};
    tied.released = std::binary_search(erosion.deleted.begin(), erosion.deleted.end(), owner) ||
                    std::binary_search(erosion.freed.begin(), erosion.freed.end(), tied.tie.node);
    any = any || tied.released;
  }
  if (!any) return {};
  return release_marked(ties, nodes);
}

std::optional<Contribution> fail_ties(Ties& ties, double step, Nodes& nodes) {
  if (mark_failed(ties, step, nodes) == 0) return {};
  return release_marked(ties, nodes);
}

}  // namespace brio
