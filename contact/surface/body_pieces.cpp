#include "contact/surface/body_pieces.hpp"

#include <vector>

#include "src/base/disjoint_sets.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

class SeparationOfPieces {
 public:
  SeparationOfPieces(Surface& surface, SurfaceTopology& topology, std::span<const int> elements)
      : surface_(surface), topology_(topology), fronts_(elements.size()), joined_(elements.size()) {
    base_ = topology_.last_mark + 1;
    topology_.last_mark += static_cast<int>(elements.size());
    apart_ = elements.size();
    growing_.assign(elements.size(), 1);
    for (int g = 0; g < static_cast<int>(elements.size()); ++g) reach(g, elements[index(g)]);
  }

  bool run() {
    bool separated = false;
    while (apart_ > 1)
      for (int g = 0; g < static_cast<int>(fronts_.size()) && apart_ > 1; ++g) separated |= step(g);
    return separated;
  }

 private:
  struct Front {
    std::vector<int> element;  // reached, in order
    std::size_t next = 0;
    bool exhausted = false;
  };
  Front& front(int g) { return fronts_[index(g)]; }
  // Fronts of a group of joined ones that are not exhausted.
  int& growing(int g) { return growing_[index(joined_.root(g))]; }

  // \returns whether a piece is complete that hangs together with nothing else.
  bool step(int g) {
    if (front(g).exhausted) return false;
    if (front(g).next < front(g).element.size()) {
      const int element = front(g).element[front(g).next++];
      for_elements_around(surface_, topology_, element, [&](int other) { reach(g, other); });
      return false;
    }
    front(g).exhausted = true;
    if (--growing(g) > 0 || apart_ == 1) return false;
    --apart_;
    give_number(joined_.root(g));
    return true;
  }

  void reach(int g, int element) {
    ++topology_.visits;
    int& mark = topology_.mark[index(element)];
    if (mark < base_) {
      mark = base_ + g;
      front(g).element.push_back(element);
      return;
    }
    const int other = mark - base_;
    if (joined_.root(other) == joined_.root(g)) return;
    const int both = growing(g) + growing(other);
    joined_.join(g, other);
    growing(g) = both;
    --apart_;
  }

  void give_number(int group) {
    const int number = surface_.body_count++;
    for (int g = 0; g < static_cast<int>(fronts_.size()); ++g) {
      if (joined_.root(g) != group) continue;
      for (int element : front(g).element) {
        topology_.body[index(element)] = number;
        for_faces_of(topology_, element, [&](int f) {
          Face& face = surface_.face[index(f)];
          face.body = number;
          for (int node : face.node) surface_.body[index(surface_.slave(node))] = number;
        });
      }
    }
  }

  Surface& surface_;
  SurfaceTopology& topology_;
  std::vector<Front> fronts_;
  DisjointSets joined_;
  std::vector<int> growing_;
  std::size_t apart_ = 0;  // groups that may be pieces
  int base_ = 0;           // mark of the first front
};

}  // namespace

bool separate_pieces(Surface& surface, SurfaceTopology& topology, std::span<const int> elements) {
  return SeparationOfPieces(surface, topology, elements).run();
}

}  // namespace brio
