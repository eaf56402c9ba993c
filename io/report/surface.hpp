#pragma once
/// What of a scene can be seen: the surface of its solids, shells, beams and particles, over the frames of a
/// report. Cells are deleted as time goes on and none is added, so a face that the deletion of a cell lays
/// open is there from that frame until the frame in which its own cell is gone.

#include <array>
#include <cstdint>
#include <vector>

namespace brio {

/// Cells of the first frame, and when each is deleted.
struct SceneCells {
  std::vector<std::int64_t> connectivity{}, offset{};  ///< as in a snapshot
  std::vector<std::int64_t> part{};                    ///< number of the part, one a cell
  std::vector<std::int64_t> id{};                      ///< number in the part, one a cell
  std::vector<int> until{};                            ///< first frame without the cell, one a cell

  std::size_t size() const { return part.size(); }
  int corners(std::size_t cell) const { return static_cast<int>(offset[cell + 1] - offset[cell]); }
  /// Cells of a frame, in the order in which that dump stores them.
  std::vector<std::size_t> alive(int frame) const;
  /// Notes what is left in a frame, `until` of the rest becomes this frame at the latest.
  /// \param parts, ids of the cells of the frame, in order \return false where they are no part of those
  /// that were left in the frames before
  bool keep(int frame, const std::vector<std::int64_t>& parts, const std::vector<std::int64_t>& ids);
};

/// One face, shell, beam or particle.
struct Facet {
  enum class Kind : std::uint8_t { solid, shell, line, vertex };
  Kind kind = Kind::solid;
  std::array<std::int64_t, 4> node{};  ///< seen from outside counterclockwise; the last repeated where less
  std::size_t cell = 0;
  int from = 0, until = 0;  ///< frames in which it is seen, without the last
};

/// Faces between two cells of one part are seen only after one of them is deleted; those between parts are
/// kept, since a part may be hidden. Sides that degenerate hexahedra have collapsed are none. \pre cells have
/// 1, 2, 4 or 8 nodes; others are left out
std::vector<Facet> facets_of(const SceneCells& cells);

/// Dumps that become frames: the first, the last, and those nearest to equal distances between them.
/// \param limit at least 1; with 1 it is the last \pre dumps > 0
std::vector<std::size_t> thinned(std::size_t dumps, std::size_t limit);

}  // namespace brio
