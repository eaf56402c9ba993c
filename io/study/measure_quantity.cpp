#include "io/study/measure_quantity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "io/files/file_error.hpp"
#include "io/results/read_result.hpp"
#include "src/base/index.hpp"

namespace brio {

namespace {

using Values = std::vector<double>;

double taken(const Values& values, Taken what) {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  switch (what) {
    case Taken::end:
      return values.back();
    case Taken::least:
      return *least;
    case Taken::largest:
      return *largest;
    case Taken::mean:
      return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    case Taken::range:
      return *largest - *least;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double interpolated(const Values& time, const Values& value, double at) {
  const auto after = std::lower_bound(time.begin(), time.end(), at);
  if (after == time.begin()) return value.front();
  if (after == time.end()) return value.back();
  const auto i = index(after - time.begin());
  const double share = (at - time[i - 1]) / (time[i] - time[i - 1]);
  return value[i - 1] + share * (value[i] - value[i - 1]);
}

// In place of the values, growth over a span that ends at each row, over its length; rows before the first
// whole span are left out.
void take_rates(Values& time, Values& value, double span) {
  Values ends, rates;
  for (std::size_t i = 0; i < time.size(); ++i) {
    if (time[i] - span < time.front()) continue;
    ends.push_back(time[i]);
    rates.push_back((value[i] - interpolated(time, value, time[i] - span)) / span);
  }
  time = std::move(ends);
  value = std::move(rates);
}

double entry(const nlohmann::json& summary, const std::string& path, const std::filesystem::path& file) {
  std::string pointer = "/" + path;
  std::replace(pointer.begin(), pointer.end(), '.', '/');
  const nlohmann::json::json_pointer place(pointer);
  if (!summary.contains(place) || !(summary[place].is_number() || summary[place].is_null()))
    throw FileError(file, "the summary has no number '" + path + "'");
  return summary[place].is_null() ? std::numeric_limits<double>::quiet_NaN() : summary[place].get<double>();
}

class Measurement {
 public:
  Measurement(const std::filesystem::path& file, std::span<const std::string> parts)
      : file_(file), parts_(parts), reader_(file), summary_(read_summary(file)) {}

  double of(const Quantity& quantity) {
    double figure = 0;
    if (quantity.history) figure = of_history(quantity, *quantity.history);
    if (quantity.field) figure = of_field(quantity);
    if (quantity.summary) figure = entry(summary_, *quantity.summary, file_);
    if (quantity.per)
      figure /=
          quantity.history ? of_history(quantity, *quantity.per) : entry(summary_, *quantity.per, file_);
    return quantity.factor * figure;
  }

 private:
  double of_history(const Quantity& quantity, const std::string& column) {
    if (history_.columns.empty()) history_ = reader_.history();
    Values time = history_.column("time", file_);
    Values values = history_.column(column, file_);
    if (values.empty()) throw FileError(file_, "the history has no rows");
    if (quantity.rate_over) take_rates(time, values, *quantity.rate_over);
    if (values.empty()) throw FileError(file_, "'" + quantity.name + "': the run is shorter than rate_over");
    if (quantity.time) return interpolated(time, values, *quantity.time);
    return taken(values, quantity.take.value_or(Taken::end));
  }

  double of_field(const Quantity& quantity) const {
    if (!quantity.whole_run)
      return of_dump(quantity, reader_.dump_at(quantity.time.value_or(reader_.times().back())));
    Values over_time;
    for (std::size_t dump = 0; dump < reader_.times().size(); ++dump)
      over_time.push_back(of_dump(quantity, dump));
    return taken(over_time, *quantity.take);
  }

  double of_dump(const Quantity& quantity, std::size_t dump) const {
    const ReadField field = reader_.field(*quantity.field, dump);
    const Values values = component(quantity, field);
    if (quantity.point) return values[nearest(quantity, field)];
    Values of_part;
    for (const std::size_t row : rows(quantity, field, dump)) of_part.push_back(values[row]);
    if (of_part.empty()) throw FileError(file_, "'" + quantity.name + "': nothing is left of the part");
    return taken(of_part, *quantity.take);
  }

  Values component(const Quantity& quantity, const ReadField& field) const {
    const std::size_t n = field.components;
    if (!quantity.component) {
      if (n != 1)
        throw FileError(file_, "'" + quantity.name + "': the field has several components; say which");
      return field.values;
    }
    const auto place = [&]() -> std::size_t {
      const std::size_t component = index(*quantity.component);
      return component < 3 ? component : component - 3;
    }();
    const bool of_tensor = *quantity.component >= Component::xx && *quantity.component <= Component::xz;
    const bool whole = *quantity.component >= Component::magnitude;
    if (whole ? n != 3 : of_tensor != (n == 6))
      throw FileError(file_, "'" + quantity.name + "': the field has no such component");
    Values result;
    for (std::size_t row = 0; row < field.rows; ++row) {
      const double* v = &field.values[row * n];
      if (!whole) {
        result.push_back(v[place]);
      } else {
        const double z = *quantity.component == Component::radius ? 0 : v[2];
        result.push_back(std::sqrt(v[0] * v[0] + v[1] * v[1] + z * z));
      }
    }
    return result;
  }

  // Points and cells keep their places in the list as long as none is deleted.
  std::size_t nearest(const Quantity& quantity, const ReadField& field) const {
    const Values at_start = field.of_points ? reader_.field("position", 0).values : centres(0);
    if (at_start.size() != 3 * field.rows)
      throw FileError(file_, "'" + quantity.name + "': elements were deleted; 'point' needs all of them");
    std::vector<bool> allowed(field.rows, !quantity.part);
    if (quantity.part)
      for (const std::size_t row : rows(quantity, field, 0)) allowed[row] = true;
    std::size_t found = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t row = 0; row < field.rows; ++row) {
      double square = 0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double distance = at_start[3 * row + axis] - (*quantity.point)[axis];
        square += distance * distance;
      }
      if (!allowed[row] || square >= least) continue;
      least = square;
      found = row;
    }
    return found;
  }

  Values centres(std::size_t dump) const {
    const ReadCells cells = reader_.cells(dump);
    const Values position = reader_.field("position", dump).values;
    Values result;
    for (std::size_t c = 0; c + 1 < cells.offset.size(); ++c)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        double sum = 0;
        for (auto i = cells.offset[c]; i < cells.offset[c + 1]; ++i)
          sum += position[3 * index(cells.connectivity[index(i)]) + axis];
        result.push_back(sum / static_cast<double>(cells.offset[c + 1] - cells.offset[c]));
      }
    return result;
  }

  // Of the part, or all.
  std::vector<std::size_t> rows(const Quantity& quantity, const ReadField& field, std::size_t dump) const {
    std::vector<std::size_t> result;
    if (!quantity.part) {
      result.resize(field.rows);
      std::iota(result.begin(), result.end(), 0);
      return result;
    }
    const auto part = std::find(parts_.begin(), parts_.end(), *quantity.part) - parts_.begin();
    const ReadCells cells = reader_.cells(dump);
    for (std::size_t c = 0; c < cells.part.size(); ++c) {
      if (cells.part[c] != part) continue;
      if (!field.of_points) result.push_back(c);
      if (field.of_points)
        for (auto i = cells.offset[c]; i < cells.offset[c + 1]; ++i)
          result.push_back(index(cells.connectivity[index(i)]));
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  std::filesystem::path file_;
  std::span<const std::string> parts_;
  ResultReader reader_;
  nlohmann::json summary_;
  ReadHistory history_;
};

}  // namespace

std::vector<double> measure_quantities(std::span<const Quantity> quantities,
                                       const std::filesystem::path& file,
                                       std::span<const std::string> parts) {
  Measurement measurement(file, parts);
  std::vector<double> figures;
  for (const Quantity& quantity : quantities) figures.push_back(measurement.of(quantity));
  return figures;
}

}  // namespace brio
