#include "elements/element_state.hpp"

#include <cassert>
#include <cstring>
#include <variant>

#include "elements/solid/hex8_kernel.hpp"
#include "materials/elastic.hpp"
#include "materials/failing.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

std::size_t number_size(const Block& block) {
  return block.precision == Precision::double_precision ? sizeof(double) : sizeof(float);
}

std::byte* place_of(Block& block, std::size_t element, std::size_t component) {
  const auto width = index(block.lanes);
  return block.state.data() + element / width * block.pack_bytes +
         (component * width + element % width) * number_size(block);
}

template <class Real>
void put(double value, std::byte* place) {
  const auto narrow = static_cast<Real>(value);
  std::memcpy(place, &narrow, sizeof narrow);
}

void write_number(double value, std::size_t component, std::size_t element, Block& block) {
  std::byte* place = place_of(block, element, component);
  if (block.precision == Precision::double_precision) return put<double>(value, place);
  put<float>(value, place);
}

double read_number(const Block& block, std::size_t element, std::size_t component) {
  const std::byte* place = place_of(const_cast<Block&>(block), element, component);
  if (block.precision == Precision::double_precision) {
    double value;
    std::memcpy(&value, place, sizeof value);
    return value;
  }
  float value;
  std::memcpy(&value, place, sizeof value);
  return static_cast<double>(value);
}

// Of hexahedra with one point, whatever the law: stress, history and axes of the point follow the header.
constexpr std::size_t hex8_stress =
    sizeof(Hex8Kernel<ObjectiveRate::jaumann>::Header<double, Elastic>) / sizeof(double);
constexpr std::size_t hex8_history = hex8_stress + 6;
constexpr std::size_t hex8_energy = 1;  // after the mass

double density_of(const Material& material) {
  return std::visit([](const auto& law) { return law.density; }, material);
}

// Per volume.
double elastic_energy(const std::array<double, 6>& stress, const Material& material) {
  const SymmetricTensor<double> s{stress[0], stress[1], stress[2], stress[3], stress[4], stress[5]};
  const auto moduli = std::visit(
      []<class Law>(const Law& law) {
        return law.template moduli<double>(typename Law::template History<double>{});
      },
      material);
  const double bulk = moduli.first_lame + 2.0 / 3.0 * moduli.shear;
  const SymmetricTensor<double> shear = deviator(s);
  return contract(shear, shear) / (4 * moduli.shear) + trace(s) * trace(s) / (18 * bulk);
}

template <class Law>
constexpr std::size_t history_components() {
  using History = typename Law::template History<double>;
  return std::is_empty_v<History> ? 0 : sizeof(History) / sizeof(double);
}

// A law that fails has more history, a reduced one less.
template <class Law>
std::size_t history_components(const Law& law) {
  if constexpr (Law::traits.failure)
    if (law.failure) return history_components<Failing<Law>>();
  if constexpr (Law::traits.is_reduced)
    if (law.is_reduced()) return history_components<typename Law::Reduced>();
  return history_components<Law>();
}

}  // namespace

std::size_t state_components(const Block& block) {
  return block.lanes == 0 ? 0 : block.pack_bytes / (number_size(block) * index(block.lanes));
}

void read_state(const Block& block, std::size_t element, double* row) {
  const std::size_t components = state_components(block);
  for (std::size_t c = 0; c < components; ++c) row[c] = read_number(block, element, c);
}

void write_state(const double* row, std::size_t element, Block& block) {
  [[maybe_unused]] const double mass = block.kernel.mass(block, element);
  const std::size_t components = state_components(block);
  for (std::size_t c = 1; c < components; ++c) write_number(row[c], c, element, block);
  assert(read_number(block, element, 0) == mass && block.kernel.mass(block, element) == mass);
}

std::string_view why_not_by_stress(const Element& element, const Material& material,
                                   bool with_plastic_strain) {
  if (!std::holds_alternative<Hex8>(element)) return "has more than one integration point or other axes";
  return std::visit(
      [&]<class Law>(const Law& law) -> std::string_view {
        if constexpr (!Law::traits.update) {
          return "has a material whose stress follows from its stretch";
        } else {
          if (with_plastic_strain && !Law::traits.equivalent_plastic_strain)
            return "has a material without plastic strain";
          const std::size_t known = Law::traits.equivalent_plastic_strain ? 1 : 0;
          return history_components(law) > known ? "has a material that remembers more than plastic strain"
                                                 : "";
        }
      },
      material);
}

void write_stress(const std::array<double, 6>& stress, std::size_t element, Block& block) {
  const double volume = block.kernel.mass(block, element) / density_of(block.material);
  write_number(volume * elastic_energy(stress, block.material), hex8_energy, element, block);
  for (std::size_t c = 0; c < stress.size(); ++c) write_number(stress[c], hex8_stress + c, element, block);
}

void write_plastic_strain(double strain, std::size_t element, Block& block) {
  write_number(strain, hex8_history, element, block);
}

void hold_energy(double internal, std::size_t element, Block& block) {
  const auto width = index(block.lanes);
  block.held[element / width * 2 * width + element % width] = internal;
}

}  // namespace brio
