#pragma once
/// Fields by which a report colours: numbers, made of what a result holds.

#include <string>
#include <vector>

#include "io/results/read_info.hpp"
#include "io/results/read_result.hpp"

namespace brio {

/// How a number is formed of the components of a field.
struct ReportField {
  enum class Take { component, magnitude, von_mises, pressure };
  std::string name;    ///< in the report
  std::string source;  ///< in the result
  bool of_points = true;
  Take take = Take::component;
  std::size_t component = 0;
};

/// Fields that are asked for by name: a field of one component, a vector (its magnitude) or one of its
/// components (`velocity_x`), the stress (`von_mises`, `pressure`, `stress_xx` ...). None asked for: von
/// Mises stress, all numbers but those that number elements, and the magnitudes of vectors. \throws FileError
/// naming the fields that there are
std::vector<ReportField> report_fields(const ResultInfo& info, const std::vector<std::string>& wanted);

/// One number a row.
std::vector<double> values_of(const ReportField& field, const ReadField& read);

}  // namespace brio
