#pragma once
/// Contents of a study: one deck, settings to compare, quantities of each result.

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "src/base/fields.hpp"
#include "src/base/tensor.hpp"

namespace brio {

/// What is taken of many values: those of a field, or those of a history over time.
enum class Taken { end, least, largest, mean, range };
constexpr std::array<NamedValue<Taken>, 5> named_values(Taken) {
  return {{{"end", Taken::end},
           {"min", Taken::least},
           {"max", Taken::largest},
           {"mean", Taken::mean},
           {"range", Taken::range}}};
}

/// Part of a vector or a tensor. `radius` is the distance from the z axis.
enum class Component { x, y, z, xx, yy, zz, xy, yz, xz, magnitude, radius };
constexpr std::array<NamedValue<Component>, 11> named_values(Component) {
  return {{{"x", Component::x},
           {"y", Component::y},
           {"z", Component::z},
           {"xx", Component::xx},
           {"yy", Component::yy},
           {"zz", Component::zz},
           {"xy", Component::xy},
           {"yz", Component::yz},
           {"xz", Component::xz},
           {"magnitude", Component::magnitude},
           {"radius", Component::radius}}};
}

/// A figure that is read out of a result: of its history, of its fields, or of its summary.
struct Quantity {
  std::string name;
  std::optional<std::string> history, field, summary;
  std::optional<std::string> per;
  std::optional<std::string> part;
  std::optional<Vector3d> point;
  std::optional<Component> component;
  std::optional<Taken> take;
  std::optional<double> time;
  std::optional<double> rate_over;
  bool whole_run = false;
  double factor = 1;
  std::optional<double> reference, scale, tolerance;
  std::string source;

  static constexpr auto fields() {
    return field_table(
        optional("history", &Quantity::history, any_number, "column of the history"),
        optional("field", &Quantity::field, any_number,
                 "field of the results, or `position`: where points are now"),
        optional("summary", &Quantity::summary, any_number, "entry of the summary, such as energy.hourglass"),
        optional("per", &Quantity::per, any_number,
                 "entry of the summary, or column of the history, by which it is divided"),
        optional("part", &Quantity::part, any_number, "of a field: this part only"),
        optional("point", &Quantity::point, any_number,
                 "of a field: at the point or cell that is nearest to this place at the start"),
        optional("component", &Quantity::component, any_number, "of a field with several"),
        optional(
            "take", &Quantity::take, any_number,
            "min, max, mean or range of a field over its points, or of a history over time; of a history "
            "also end, its default"),
        optional("time", &Quantity::time, non_negative,
                 "of a field: at the dump nearest to it; of a history: at this time; default: the end"),
        optional("rate_over", &Quantity::rate_over, positive,
                 "of a history: growth over spans of this length, per time, in place of the values"),
        optional("whole_run", &Quantity::whole_run, any_number,
                 "of a field: min or max over all dumps as well"),
        optional("factor", &Quantity::factor, any_number, "multiplies the figure, such as 0.5 or -1"),
        optional("reference", &Quantity::reference, any_number,
                 "what it should be: exact or published; default: that of the reference run"),
        optional("scale", &Quantity::scale, positive, "errors are over this; default: over the reference"),
        optional("tolerance", &Quantity::tolerance, positive, "error up to which a run passes, -"),
        optional("source", &Quantity::source, any_number, "where the reference is from, for people"));
  }
  constexpr std::string_view fault() const {
    if (int{history.has_value()} + int{field.has_value()} + int{summary.has_value()} != 1)
      return "a quantity is of one of 'history', 'field' and 'summary'";
    if (!field && (part || point || component || whole_run))
      return "'part', 'point', 'component' and 'whole_run' go with 'field'";
    if (!history && rate_over) return "'rate_over' goes with 'history'";
    if (field && per) return "'per' goes with 'history' and 'summary'";
    if (summary && (take || time)) return "'take' and 'time' go with 'history' and 'field'";
    if (field && !point && !take) return "a field has many values: say 'take' or 'point'";
    if (field && take == Taken::end) return "of a field, 'take' is min, max, mean or range";
    if (whole_run && (time || (take != Taken::least && take != Taken::largest)))
      return "'whole_run' goes with min or max, and without 'time'";
    return {};
  }
};

/// Overrides of a deck, `KEY.PATH=VALUE` each.
struct Settings {
  std::vector<std::string> overrides;
};

using NamedSettings = std::vector<std::pair<std::string, Settings>>;

struct Study {
  std::string title;
  std::string advice;
  std::string deck;
  Settings set;
  std::vector<Quantity> quantities;
  std::string reference;
  std::vector<std::pair<std::string, NamedSettings>> knobs;
  std::vector<std::vector<std::string>> combinations;
  std::vector<std::string> physics;
  std::string refined;
  int threads = 1;
  int repeats = 1;

  static constexpr auto fields() {
    return field_table(
        optional("title", &Study::title, any_number, "one line, for people"),
        optional("advice", &Study::advice, any_number, "what follows from the table, for people"),
        required("deck", &Study::deck, any_number, "the deck, from the folder of the study"),
        optional("set", &Study::set, any_number, "overrides of the deck, for all runs: KEY.PATH: VALUE"),
        required("quantities", &Study::quantities, any_number, "what is looked at in each result"),
        optional("reference", &Study::reference, any_number,
                 "reference run: `default`, KNOB.SETTING, or several joined by +"),
        required("knobs", &Study::knobs, any_number,
                 "a map of knobs, each a map of settings, each a map of overrides of the deck"),
        optional("combinations", &Study::combinations, any_number,
                 "lists of KNOB.SETTING that are run together"),
        optional("physics", &Study::physics, any_number,
                 "knobs that change the problem, not how it is solved: excluded from the comparison of "
                 "cost and error"),
        optional(
            "refined", &Study::refined, any_number,
            "a knob whose settings halve the mesh size one after the other: orders of convergence are told"),
        optional("threads", &Study::threads, Range{.lower = 1, .upper = 1024}, "of each run"),
        optional("repeats", &Study::repeats, Range{.lower = 1, .upper = 1000},
                 "of each run; the cheapest counts"));
  }
};

/// One line of the table: a name that can be a folder, and all overrides of the deck.
struct StudyRun {
  std::string name;
  std::string knob;   ///< empty: the deck as it is, or a combination
  std::string label;  ///< of the setting
  std::vector<std::string> overrides;
  bool is_another_problem = false;  ///< a parameter of its physics is changed
};

inline constexpr std::string_view default_run = "default";

/// The deck as it is, each setting alone, then the combinations.
/// \throws std::invalid_argument naming a setting of a combination, or a reference, that there is not.
std::vector<StudyRun> runs_of(const Study& study);

/// Place of the reference among the runs; none if the study names none.
std::optional<std::size_t> reference_run(const Study& study, const std::vector<StudyRun>& runs);

}  // namespace brio
