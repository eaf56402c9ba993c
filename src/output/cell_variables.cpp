#include "src/output/cell_variables.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace brio {

namespace {

double pressure(const ElementSample& sample) { return -trace(sample.stress) / 3; }

double von_mises(const ElementSample& sample) {
  const SymmetricTensor<double> s = deviator(sample.stress);
  return std::sqrt(1.5 * contract(s, s));
}

// Mean over von Mises stress; 0 of an element without stress.
double triaxiality(const ElementSample& sample) {
  const double equivalent = von_mises(sample);
  return equivalent > 0 ? -pressure(sample) / equivalent : 0;
}

double internal_energy(const ElementSample& sample) { return sample.internal_energy; }

constexpr std::array<DerivedVariable, 4> derived{{{"von_mises", von_mises},
                                                  {"pressure", pressure},
                                                  {"triaxiality", triaxiality},
                                                  {"internal_energy", internal_energy}}};

}  // namespace

std::span<const DerivedVariable> derived_variables() { return derived; }

std::vector<std::string> named_variables(std::span<const std::string> wanted,
                                         std::span<const std::string_view> histories) {
  std::vector<std::string> names;
  const auto add = [&](std::string_view name) {
    if (std::ranges::find(names, name) == names.end()) names.emplace_back(name);
  };
  for (const std::string& name : wanted) {
    if (name != all_group) {
      add(name);
      continue;
    }
    add(default_group);
    for (const DerivedVariable& variable : derived) add(variable.name);
    for (const std::string_view history : histories) add(history);
  }
  return names;
}

}  // namespace brio
