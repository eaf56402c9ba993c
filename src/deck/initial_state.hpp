#pragma once
/// State at the start from an earlier result: what a deck asks for, and what was read of it.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/base/fields.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// What is taken from a result.
enum class StateField { positions, velocity, state, stress, plastic_strain };
constexpr std::array<NamedValue<StateField>, 5> named_values(StateField) {
  return {{{"positions", StateField::positions},
           {"velocity", StateField::velocity},
           {"state", StateField::state},
           {"stress", StateField::stress},
           {"plastic_strain", StateField::plastic_strain}}};
}

/// `from: {result: forming.vtkhdf, fields: [positions, state]}`
struct StateSource {
  std::string result{};
  std::optional<std::string> part{};
  std::optional<double> time{};
  std::vector<StateField> wanted{};
  std::string place{};  ///< in the deck
  static constexpr auto fields() {
    return field_table(
        required("result", &StateSource::result, any_number,
                 "a .vtkhdf file of brio, relative to the folder of the deck"),
        optional("part", &StateSource::part, any_number, "its name in the result; default: as here"),
        optional("time", &StateSource::time, non_negative, "of a dump of the result; default: the last"),
        required("fields", &StateSource::wanted, any_number,
                 "what is taken, a list: positions, at which the part then starts; velocity; state, all that "
                 "elements remember, of a result with state among output.fields.variables; or of hex8 "
                 "without it stress and plastic_strain"));
  }
  bool takes(StateField field) const {
    for (const StateField one : wanted)
      if (one == field) return true;
    return false;
  }
  std::string_view fault() const {
    const bool whole = takes(StateField::state);
    if (wanted.empty())
      return "'fields' is empty; accepted: positions, velocity, state, stress, plastic_strain";
    if (whole && (takes(StateField::stress) || takes(StateField::plastic_strain)))
      return "'state' holds stress and plastic strain; leave out one of them";
    if (whole && !takes(StateField::positions))
      return "the state of elements is that at their deformed positions; 'positions' is wanted beside it";
    return "";
  }
};

/// What a part starts with, by nodes and elements of its mesh; lists that are not asked for are empty.
/// Positions are those of the mesh.
struct PartState {
  std::size_t part = 0;
  std::size_t condition = 0;  ///< of the deck
  std::string place{};        ///< in it
  std::vector<Vector3d> velocity, angular_velocity;
  std::vector<double> element;  ///< rows as of elements/element_state.hpp
  std::vector<std::array<double, 6>> stress;
  std::vector<double> plastic_strain;
};

}  // namespace brio
