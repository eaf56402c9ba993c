#include "elements/block.hpp"

#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "src/base/index.hpp"

namespace brio {

bool accepts(const Element& element, const Material& material) {
  return std::visit(
      [](const auto& kind, const auto& law) {
        return std::decay_t<decltype(kind)>::template accepts<std::decay_t<decltype(law)>>;
      },
      element, material);
}

namespace {

Precision precision_of(const Element& element, Precision wanted) {
  const ElementPrecision precision = traits_of(element).precision;
  if (precision == ElementPrecision::double_only && wanted != Precision::double_precision)
    throw std::invalid_argument("elements '" + std::string(name_of(element)) +
                                "' are computed in double precision only; accepted is "
                                "numerics: {precision: double}");
  return precision == ElementPrecision::any ? wanted : Precision::double_precision;
}

}  // namespace

Block make_block(std::string part, const Element& element, const Material& material, Precision precision,
                 std::span<const int> connectivity, const std::optional<Deletion>& deletion) {
  if (!accepts(element, material))
    throw std::invalid_argument("material model '" + std::string(name_of(material)) +
                                "' cannot be used by element '" + std::string(name_of(element)) + "'");
  Block block;
  block.part = std::move(part);
  block.element = element;
  block.material = material;
  block.precision = precision_of(element, precision);
  block.deletion = deletion.value_or(Deletion{});
  block.lanes = block.precision == Precision::double_precision ? lane_count<double> : lane_count<float>;
  const auto corners = index(nodes_per_element(element));
  const auto width = index(block.lanes);
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
  if (block.loses_elements) {
    block.held = AlignedBuffer<double>(block.pack_count * 2 * width);
    block.lost = AlignedBuffer<int>(block.pack_count * width);
  }
  return block;
}

void scale_to(double stable_step, Block& block) {
  block.scaled_step = stable_step;
  const std::size_t places = block.pack_count * index(block.lanes);
  block.scaled = AlignedBuffer<int>(places);
  block.mass_gain = AlignedBuffer<double>(places);
}

HeldEnergy held_energy(const Block& block, std::size_t element) {
  const auto width = index(block.lanes);
  const double* pack = block.held.data() + element / width * 2 * width;
  return {pack[element % width], pack[width + element % width]};
}

namespace {

/// One lane of arrays [pack][component][lane].
template <class Item>
void copy_place(Item* array, std::size_t components, std::size_t width, std::size_t from, std::size_t to) {
  const Item* source = array + from / width * components * width + from % width;
  Item* target = array + to / width * components * width + to % width;
  for (std::size_t c = 0; c < components; ++c)
    std::memcpy(target + c * width, source + c * width, sizeof(Item));
}

}  // namespace

void copy_element(Block& block, std::size_t from, std::size_t to) {
  const auto width = index(block.lanes);
  copy_place(block.connectivity.data(), index(nodes_per_element(block.element)), width, from, to);
  copy_place(block.held.data(), 2, width, from, to);
  if (block.precision == Precision::double_precision) {
    copy_place(reinterpret_cast<double*>(block.state.data()), block.pack_bytes / (sizeof(double) * width),
               width, from, to);
  } else {
    copy_place(reinterpret_cast<float*>(block.state.data()), block.pack_bytes / (sizeof(float) * width),
               width, from, to);
  }
}

}  // namespace brio
