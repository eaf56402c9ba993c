#pragma once
/// Neighbour search: pairs of particles, by cells whose edge is half of the largest reach of a pair.
/// Particles are sorted by cells, so that five cells in a row are one range of memory: of each particle 25
/// ranges are looked through, eight particles at a time. Cells are numbered and not stored: particles that
/// have flown far apart cost no more than others.

#include <cstdint>
#include <span>
#include <vector>

#include "src/base/parallel.hpp"

namespace brio {

/// \param reach two are neighbours that are closer than the sum of theirs; negative: left out
struct ReachingPoint {
  double position[3];
  double reach;
};

class NeighbourSearch {
 public:
  /// The same lists in the same order with any number of threads; allocates nothing once as many points and
  /// neighbours have been seen.
  void find(std::span<const ReachingPoint> points, ThreadTeam& team);

  /// Neighbours of a point, without itself.
  std::span<const int> of(std::size_t point) const {
    const Place& place = place_[point];
    return {lists_[place.list].neighbour.data() + place.first, static_cast<std::size_t>(place.count)};
  }

 private:
  struct Cell {
    std::int64_t number;
    int point;
  };
  struct Place {
    std::uint32_t list = 0;
    int count = 0;
    std::size_t first = 0;
  };
  /// Of the points of a task.
  struct List {
    std::vector<int> neighbour;
    std::size_t used = 0;
  };
  class Ranges;

  void sort_by_cells(std::span<const ReachingPoint> points);
  void find_of_range(std::size_t begin, std::size_t end, List& list);

  std::vector<Cell> cells_;
  std::int64_t row_ = 0, layer_ = 0;       ///< cells in a row and in a layer
  std::vector<double> x_, y_, z_, reach_;  ///< of sorted points, and of eight behind them
  std::vector<Place> place_;
  std::vector<List> lists_;
};

}  // namespace brio
