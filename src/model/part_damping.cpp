#include "src/model/part_damping.hpp"

#include <algorithm>

#include "src/base/index.hpp"

namespace brio {

NodalDamping damping_of_parts(const Deck& deck, const Model& model) {
  const auto is_damped = [](const Part& part) { return part.damping > 0; };
  if (std::none_of(deck.parts.begin(), deck.parts.end(), is_damped)) return {};
  std::vector<double> mass(model.nodes.size(), 0), damped(model.nodes.size(), 0);
  for (std::size_t p = 0; p < deck.parts.size(); ++p) {
    const Block& block = model.blocks[p];
    const int corners = nodes_per_element(block.element);
    for (std::size_t e = 0; model.parts[p].rigid < 0 && e < block.element_count; ++e)
      for (int corner = 0; corner < corners; ++corner) {
        const auto node = index(block.node(e, corner));
        const double share = block.kernel.mass(block, e) / corners;
        mass[node] += share;
        damped[node] += deck.parts[p].damping * share;
      }
  }
  for (std::size_t i = 0; i < mass.size(); ++i) damped[i] = mass[i] > 0 ? damped[i] / mass[i] : 0;
  return make_damping(std::move(damped), model.nodes);
}

}  // namespace brio
