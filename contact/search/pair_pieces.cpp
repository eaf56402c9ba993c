#include "contact/search/pair_pieces.hpp"

#include <limits>
#include <stdexcept>

#include "src/base/index.hpp"

namespace brio {

void merge(std::span<const PairPiece> pieces, std::size_t boxes, ThreadTeam& team, CandidatePairs& pairs,
           SearchCounts& counts) {
  std::size_t found = 0;
  for (const PairPiece& piece : pieces) found += piece.found;
  if (found > index(std::numeric_limits<int>::max()))
    throw std::length_error("contact search: more candidate pairs than an int can number");

  pairs.first.assign(boxes + 1, 0);
  pairs.node.resize(found);
  for (const PairPiece& piece : pieces)
    for (std::size_t i = 0; i < piece.box.size(); ++i) pairs.first[index(piece.box[i]) + 1] = piece.count[i];
  for (std::size_t box = 0; box < boxes; ++box) pairs.first[box + 1] += pairs.first[box];

  team.for_each(pieces.size(), [&](std::size_t p) {
    const PairPiece& piece = pieces[p];
    const int* source = piece.node.data();
    for (std::size_t i = 0; i < piece.box.size(); ++i) {
      int* target = pairs.node.data() + pairs.first[index(piece.box[i])];
      for (int k = 0; k < piece.count[i]; ++k) target[k] = source[k];
      source += piece.count[i];
    }
  });

  counts.searches += 1;
  counts.candidate_pairs += found;
  for (const PairPiece& piece : pieces) counts.comparisons += piece.comparisons;
}

}  // namespace brio
