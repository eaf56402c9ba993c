#pragma once
/// Which lines may meet soon, and which of these pairs sleep. Searched with the same buffer and at the same
/// time as faces and nodes (candidates.hpp); a pair sleeps until both may have travelled its clearance
/// (travel.hpp).

#include <array>
#include <utility>
#include <vector>

#include "contact/candidates.hpp"
#include "contact/lines.hpp"
#include "contact/travel.hpp"

namespace brio {

struct LineCandidates {
  GlobalSearch search;
  SearchCounts counts;
  std::vector<Line> line;
  Lists partners;                   ///< of each line: those after it that it may meet, ascending
  std::vector<double> wake;         ///< of each pair: travel at which it may be near
  std::vector<double> path, ahead;  ///< of each line in this step, the longest of its nodes
  /// By their nodes, global, ascending: pairs of one body that overlap as drawn or lie in its tightest fold,
  /// which never meet, and pairs that overlapped when one of them came to be, at a tear, which meet once they
  /// have come apart.
  std::vector<NodesOfPair> drawn, torn;

  explicit LineCandidates(SearchStrategy strategy = SearchStrategy::automatic) : search(strategy) {}

  std::vector<CaptureBox> box;             ///< working space
  std::vector<CaptureBox> range;           ///< working space
  CandidatePairs pairs;                    ///< working space
  std::vector<LineEnd> ends;               ///< working space
  std::vector<std::pair<int, int>> found;  ///< working space
  std::vector<NodesOfPair> added;          ///< working space
  std::vector<Line> before;                ///< working space
};

/// Collect the lines and search anew. \pre `faces` have just been searched
void search_lines(LineCandidates& candidates, const Candidates& faces, const Surface& surface,
                  const ContactOptions& options, const Nodes& nodes, ThreadTeam& team);

/// Take over how far lines have travelled; once a step.
void follow_lines(LineCandidates& candidates, const Travel& travel);

}  // namespace brio
