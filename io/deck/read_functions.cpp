// Tables and expressions: what stands in place of numbers and of functions of time.

#include <fmt/format.h>

#include <cmath>

#include "io/deck/read_fields.hpp"

namespace brio {

namespace {

/// Intervals in which a curve of time is sampled.
constexpr int sample_count = 1000;

/// A character inside of a text in quotes. Escapes and line breaks, which no formula needs, are not counted.
Place inside(const YamlNode& node, std::size_t position) {
  Place place = node.place;
  if (place.line > 0) place.column += static_cast<int>(position) + 1;
  return place;
}

std::shared_ptr<const Expression> parse(const YamlNode& node, const Slot& slot,
                                        Expression::Variables variables) {
  const Parameters& parameters = slot.known.parameters();
  try {
    return std::make_shared<const Expression>(node.text, parameters.values, variables);
  } catch (const ExpressionError& error) {
    std::string message = fmt::format("in the expression \"{}\" of '{}', at character {}: {}", node.text,
                                      slot.key, error.position() + 1, error.what());
    if (!error.unknown().empty()) {
      slot.known.expect_read(error.unknown());
      std::vector<std::string_view> names;
      for (const auto& [name, value] : parameters.values) names.push_back(name);
      for (const std::string_view name : Expression::names(variables)) names.push_back(name);
      for (const std::string_view name : Expression::constants_and_functions()) names.push_back(name);
      message += "; " + accepted_words(error.unknown(), names);
    }
    throw DeckError(inside(node, error.position()), message);
  }
}

void check_finite(double value, const YamlNode& node, const Slot& slot, const std::string& when) {
  if (std::isfinite(value)) return;
  throw DeckError(node.place,
                  fmt::format("the expression \"{}\" of '{}' is {}{}; finite numbers are accepted", node.text,
                              slot.key, std::isnan(value) ? "not a number" : "infinite", when));
}

}  // namespace

double constant_of(const YamlNode& node, const Slot& slot) {
  const double value = parse(node, slot, Expression::Variables::none)->at(0);
  check_finite(value, node, slot, "");
  return value;
}

Curve curve_of(const YamlNode& node, const Slot& slot, Expression::Variables variables) {
  const std::shared_ptr<const Expression> expression = parse(node, slot, variables);
  Curve curve;
  if (!expression->uses_time() && !expression->uses_position()) {
    curve.points = {{0, expression->at(0)}};
    check_finite(curve.points[0][1], node, slot, "");
    return curve;
  }
  curve.expression = expression;
  const double end = slot.known.end_time();
  for (int i = 0; i <= sample_count; ++i) {
    const double time = end * i / sample_count;
    const double value = expression->at(time);
    if (!expression->uses_position()) check_finite(value, node, slot, fmt::format(" at time {}", time));
    curve.points.push_back({time, value});
  }
  return curve;
}

void read_value(const YamlNode& node, const Slot& slot, Parameters& parameters) {
  require_map(node, slot);
  const auto check_name_of = [](const YamlEntry& entry) {
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
    const bool is_name =
        !entry.key.empty() && letters.find(entry.key.front()) != std::string_view::npos &&
        entry.key.find_first_not_of(std::string(letters) + "0123456789") == std::string::npos;
    if (!is_name)
      throw DeckError(entry.place, "'" + entry.key +
                                       "' cannot be a parameter; accepted are letters, digits and _, "
                                       "a letter first");
    for (const auto& names :
         {Expression::constants_and_functions(), Expression::names(Expression::Variables::time_and_position)})
      if (std::find(names.begin(), names.end(), entry.key) != names.end())
        throw DeckError(entry.place,
                        "'" + entry.key + "' has a meaning in expressions; another name is accepted");
  };
  bool complete = true;
  for (const YamlEntry& entry : node.entries)
    complete &= slot.known.attempt(entry.key, [&] {
      check_name_of(entry);
      double value = 0;
      read_value(*entry.value, Slot{entry.key, any_number, slot.known}, value);
      parameters.values.emplace_back(entry.key, value);
    });
  if (!complete) throw FaultsTold{};
}

namespace {

using Rows = std::vector<std::array<double, 2>>;

/// Plastic strains from 0 on, and yield stresses.
Rows read_yield_curve(const YamlNode& node, const Slot& slot) {
  if (!node.is_sequence() || node.items.empty())
    refuse(node, slot, "a list of [equivalent plastic strain, yield stress], or {file: NAME.csv}");
  Rows rows;
  for (const auto& item : node.items) {
    std::array<double, 2> row{};
    read_value(*item, Slot{slot.key, any_number, slot.known}, row);
    const auto [strain, stress] = row;
    if (rows.empty() && strain != 0)
      throw DeckError(item->place,
                      fmt::format("the plastic strains of '{}' begin with {}; 0 is accepted, where "
                                  "the material yields first",
                                  slot.key, strain));
    if (!rows.empty() && strain <= rows.back()[0])
      throw DeckError(item->place,
                      fmt::format("the plastic strains of '{}' do not grow: {} after {}; each must be larger "
                                  "than the one before",
                                  slot.key, strain, rows.back()[0]));
    if (!(stress > 0))
      throw DeckError(item->place, fmt::format("a yield stress of '{}' is {}; stresses > 0 are accepted",
                                               slot.key, stress));
    rows.push_back(row);
  }
  return rows;
}

/// One entry of `rates`.
struct CurveOfRate {
  double rate;
  Rows rows;
};

CurveOfRate read_curve_of_rate(const YamlNode& node, const Slot& slot) {
  require_map(node, slot);
  check_keys(node, {"rate", "table"});
  const YamlEntry* rate = node.find("rate");
  const YamlEntry* table = node.find("table");
  if (rate == nullptr || table == nullptr)
    throw DeckError(node.place,
                    "an entry of 'rates' is {rate: 1/TIME, table: [[0, STRESS], ...]}; both are required");
  CurveOfRate curve{};
  read_value(*rate->value, Slot{"rate", positive, slot.known}, curve.rate);
  curve.rows = read_yield_curve(*table->value, Slot{"table", any_number, slot.known});
  return curve;
}

std::vector<CurveOfRate> read_curves_of_rates(const YamlNode& node, const Slot& slot) {
  if (!node.is_sequence() || node.items.size() < 2)
    refuse(node, slot, "a list of two or more {rate: ..., table: ...}");
  std::vector<CurveOfRate> curves;
  for (const auto& item : node.items) {
    curves.push_back(read_curve_of_rate(*item, slot));
    if (curves.size() > 1 && curves.back().rate <= curves[curves.size() - 2].rate)
      throw DeckError(item->find("rate")->value->place,
                      "the rates do not grow; each must be larger than the one before");
  }
  return curves;
}

}  // namespace

void read_value(const YamlNode& node, const Slot& slot, SharedYieldTable& value) {
  std::vector<CurveOfRate> curves;
  BeyondTable beyond = BeyondTable::constant;
  if (node.is_map()) {
    check_keys(node, {"table", "rates", "beyond"});
    const YamlEntry* table = node.find("table");
    const YamlEntry* rates = node.find("rates");
    if ((table == nullptr) == (rates == nullptr))
      throw DeckError(node.place, "'" + std::string(slot.key) + "' has either 'table' or 'rates'");
    if (const YamlEntry* entry = node.find("beyond"))
      read_value(*entry->value, Slot{"beyond", any_number, slot.known}, beyond);
    if (rates != nullptr) {
      curves = read_curves_of_rates(*rates->value, Slot{"rates", any_number, slot.known});
    } else {
      curves.push_back({0, read_yield_curve(*table->value, Slot{"table", any_number, slot.known})});
    }
  } else {
    curves.push_back({0, read_yield_curve(node, slot)});
  }
  std::vector<YieldCurve> views;
  for (const CurveOfRate& curve : curves) views.push_back({curve.rows, curve.rate});
  value.table = std::make_shared<const YieldTable>(views, beyond);
  if (beyond == BeyondTable::last_slope && value->falls_in_the_end())
    throw DeckError(node.place,
                    "the yield stress falls at the end of a table, and would come down to 0 with "
                    "'beyond: last_slope'; 'beyond: constant' is accepted");
}

}  // namespace brio
