#include "elements/block.hpp"

#include <stdexcept>
#include <type_traits>

#include "elements/sweep.hpp"

namespace brio {

bool accepts(const Element& element, const Material& material) {
  return std::visit(
      [](const auto& kind, const auto& law) {
        return std::decay_t<decltype(kind)>::template accepts<std::decay_t<decltype(law)>>;
      },
      element, material);
}

Block make_block(std::string part, const Element& element, const Material& material, Precision precision,
                 std::span<const int> connectivity) {
  if (!accepts(element, material))
    throw std::invalid_argument("material model '" + std::string(name_of(material)) +
                                "' cannot be used by element '" + std::string(name_of(element)) + "'");
  Block block;
  block.part = std::move(part);
  block.element = element;
  block.material = material;
  block.precision = precision;
  block.lanes = precision == Precision::double_precision ? lane_count<double> : lane_count<float>;
  const auto corners = static_cast<std::size_t>(nodes_per_element(element));
  const auto width = static_cast<std::size_t>(block.lanes);
  block.element_count = connectivity.size() / corners;
  block.pack_count = (block.element_count + width - 1) / width;
  block.connectivity = AlignedBuffer<int>(block.pack_count * corners * width);
  for (std::size_t slot = 0; slot < block.pack_count * width; ++slot) {
    const std::size_t e = slot < block.element_count ? slot : block.element_count - 1;
    for (std::size_t corner = 0; corner < corners; ++corner)
      block.connectivity[((slot / width) * corners + corner) * width + slot % width] =
          connectivity[e * corners + corner];
  }
  std::visit([&](const auto& kind) { choose_kernel(kind, block); }, element);
  block.state = AlignedBuffer<std::byte>(block.pack_count * block.pack_bytes);
  return block;
}

}  // namespace brio
