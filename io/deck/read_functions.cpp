// Tables: what stands in place of functions.

#include <fmt/format.h>

#include "io/deck/read_fields.hpp"

namespace brio {

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
