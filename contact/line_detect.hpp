#pragma once
/// From pairs of lines to contacts. As in detect.hpp, geometry is that of the beginning of the step and
/// velocities are the predicted ones; lines that are near are joined where they are closest, others where
/// they first meet within the step (edge_check.hpp).
///
/// An edge of a solid meets another line only inside of both, in a direction between the normals of its two
/// faces: elsewhere a node and a face are closer.

#include <span>
#include <vector>

#include "contact/line_candidates.hpp"
#include "contact/pair.hpp"
#include "src/base/parallel.hpp"

namespace brio {

/// Lines that may touch, kept by a scene that has them.
struct LineContacts {
  LineCandidates candidates;
  std::vector<std::vector<Contact>> piece;  ///< working space, one a task

  explicit LineContacts(SearchStrategy strategy = SearchStrategy::automatic) : candidates(strategy) {}
};

/// Give the contacts of lines among `contacts` the numbers that their lines have after a search, and take out
/// those whose lines are no more.
void renumber(const LineCandidates& candidates, std::vector<Contact>& contacts);

/// Append the contacts of lines of this step, by first line.
/// \param last  contacts of the last step, by Contact::slave
void detect_lines(LineContacts& lines, const Surface& surface, const ContactOptions& options,
                  const Candidates& faces, const Nodes& nodes, const Travel& travel,
                  std::span<const Contact> last, ThreadTeam& team, std::vector<Contact>& contacts);

}  // namespace brio
