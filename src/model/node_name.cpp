#include "src/model/node_name.hpp"

#include <algorithm>
#include <sstream>

#include "src/base/index.hpp"

namespace brio {

std::string name_of_node(const Model& model, std::size_t node) {
  std::ostringstream text;
  for (const PartInModel& part : model.parts) {
    const auto found = std::find(part.node.begin(), part.node.end(), static_cast<int>(node));
    if (found == part.node.end()) continue;
    text << "node " << part.number_of_node(index(found - part.node.begin())) << " of part '" << part.name
         << "'";
    break;
  }
  const double* x = model.nodes.record[node].position;
  text << " at (" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  return text.str();
}

}  // namespace brio
