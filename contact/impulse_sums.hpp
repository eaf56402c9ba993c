#pragma once
/// Impulses of contact on nodes since the last dump of fields.

#include <cstddef>
#include <vector>

#include "src/base/index.hpp"
#include "src/base/tensor.hpp"

namespace brio {

struct ContactScene;

/// Of nodes that contact has pushed, in the order in which it did; nothing is held for others.
class ImpulseSums {
 public:
  struct OfNode {
    int node = -1;   ///< global
    int unused = 0;  // no byte of a saved state is left undefined
    Vector3d normal{0, 0, 0}, friction{0, 0, 0};
  };

  /// Of a step of contact. \param step over which its impulses act
  void add(const ContactScene& scene, std::size_t nodes, double step);
  /// Of the dump that was written; the next begins.
  void begin_interval();

  double duration() const { return duration_; }
  /// Null: contact has not pushed the node.
  const OfNode* of(int node) const {
    const auto n = index(node);
    return n < place_.size() && place_[n] >= 0 ? &sum_[index(place_[n])] : nullptr;
  }

  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(duration_, sum_, place_);
  }

 private:
  double duration_ = 0;
  std::vector<OfNode> sum_;
  std::vector<int> place_;  ///< of each global node, in `sum_`; -1: not pushed
};

}  // namespace brio
