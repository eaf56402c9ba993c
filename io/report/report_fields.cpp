#include "io/report/report_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "src/fields/cell_variables.hpp"

namespace brio {

namespace {

using Take = ReportField::Take;

constexpr std::array<std::string_view, 5> not_shown{"part", "element_id", "node_id", "radius", "density"};
constexpr std::array<const char*, 3> axes{"x", "y", "z"};
constexpr std::array<const char*, 6> tensor_axes{"xx", "yy", "zz", "xy", "yz", "xz"};

bool has_field(const ResultInfo& info, std::string_view name) {
  return std::ranges::any_of(info.fields, [&](const FieldInfo& field) { return field.name == name; });
}

// All that can be shown of a field; what is shown of it by default comes first.
std::vector<ReportField> numbers_of(const FieldInfo& field, const ResultInfo& info) {
  const auto number = [&](std::string name, Take take, std::size_t component = 0) {
    return ReportField{std::move(name), field.name, field.where == "point", take, component};
  };
  std::vector<ReportField> result;
  if (field.components == 1) result.push_back(number(field.name, Take::component));
  if (field.components == 3) {
    result.push_back(number(field.name, Take::magnitude));
    for (std::size_t i = 0; i < 3; ++i)
      result.push_back(number(fmt::format("{}_{}", field.name, axes[i]), Take::component, i));
  }
  if (field.components == 6) {
    const std::string of = field.name == "stress" ? "" : "_of_" + field.name;
    if (!has_field(info, "von_mises" + of)) result.push_back(number("von_mises" + of, Take::von_mises));
    if (!has_field(info, "pressure" + of)) result.push_back(number("pressure" + of, Take::pressure));
    for (std::size_t i = 0; i < 6; ++i)
      result.push_back(number(fmt::format("{}_{}", field.name, tensor_axes[i]), Take::component, i));
  }
  return result;
}

std::vector<ReportField> shown_by_default(const ResultInfo& info) {
  std::vector<ReportField> fields;
  for (const FieldInfo& field : info.fields) {
    if (field.where == "global" || std::ranges::find(not_shown, field.name) != not_shown.end()) continue;
    const std::vector<ReportField> numbers = numbers_of(field, info);
    if (!numbers.empty()) fields.push_back(numbers.front());
  }
  // Those of cells first: they tell most.
  std::stable_partition(fields.begin(), fields.end(), [](const ReportField& f) { return !f.of_points; });
  return fields;
}

// By the formula with which runs write it. \param s components of the stress
double derived(std::string_view name, const double* s) {
  ElementSample sample;
  sample.stress = {s[0], s[1], s[2], s[3], s[4], s[5]};
  double value;
  cell_variable(name).values(sample, &value);
  return value;
}

double number_of(const ReportField& field, const double* row) {
  switch (field.take) {
    case Take::magnitude:
      return std::hypot(row[0], row[1], row[2]);
    case Take::von_mises:
      return derived("von_mises", row);
    case Take::pressure:
      return derived("pressure", row);
    default:
      return row[field.component];
  }
}

}  // namespace

std::vector<ReportField> report_fields(const ResultInfo& info, const std::vector<std::string>& wanted) {
  if (wanted.empty()) return shown_by_default(info);
  std::vector<ReportField> known, fields;
  for (const FieldInfo& field : info.fields)
    if (field.where != "global")
      for (ReportField& number : numbers_of(field, info)) known.push_back(std::move(number));
  for (const std::string& name : wanted) {
    const auto found = std::ranges::find(known, name, &ReportField::name);
    if (found == known.end()) {
      std::vector<std::string> names;
      for (const ReportField& field : known) names.push_back(field.name);
      throw FileError(info.file,
                      fmt::format("there is no field '{}'; there are {}", name, fmt::join(names, ", ")));
    }
    fields.push_back(*found);
  }
  return fields;
}

std::vector<double> values_of(const ReportField& field, const ReadField& read) {
  const std::size_t components = field.take == Take::component   ? field.component + 1
                                 : field.take == Take::magnitude ? 3
                                                                 : 6;
  std::vector<double> values(read.rows, std::nan(""));
  if (read.components < components) return values;
  for (std::size_t row = 0; row < read.rows; ++row)
    values[row] = number_of(field, &read.values[row * read.components]);
  return values;
}

}  // namespace brio
