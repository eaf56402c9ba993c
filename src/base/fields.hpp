#pragma once
/// One table of fields per thing that a deck can name. The reader, its range checks, the refusal of unknown
/// keys, the printed reference and the JSON schema all come from the same table: nothing is listed twice.
///
///     struct Elastic {
///       static constexpr std::string_view name = "elastic";
///       double density = 0;
///       static constexpr auto fields() {
///         return field_table(required("density", &Elastic::density, positive, "mass per reference volume"));
///       }
///     };
///
/// A member may be double, int, bool, std::string, a vector, an enumeration with `named_values`, a std::array
/// or std::vector of these, a struct with `fields()`, or a std::optional of any of them. The initial value of
/// an optional member is its default.

#include <array>
#include <limits>
#include <string_view>

namespace brio {

/// What a number may be; the ends belong to the range unless they are open.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
  bool upper_open = false;

  constexpr bool contains(double value) const {
    return (lower_open ? value > lower : value >= lower) && (upper_open ? value < upper : value <= upper);
  }
};

inline constexpr Range any_number{};
inline constexpr Range positive{.lower = 0, .lower_open = true};
inline constexpr Range non_negative{.lower = 0};
inline constexpr Range at_least_one{.lower = 1};
inline constexpr Range fraction{.lower = 0, .upper = 1};

template <class Owner, class Member>
struct Field {
  std::string_view key;
  Member Owner::*member;
  Range range;
  bool is_required;
  std::string_view meaning;  ///< one line of the printed reference, with its unit where it has one
};

template <class Owner, class Member>
constexpr Field<Owner, Member> required(std::string_view key, Member Owner::*member, Range range,
                                        std::string_view meaning) {
  return {key, member, range, true, meaning};
}
template <class Owner, class Member>
constexpr Field<Owner, Member> optional(std::string_view key, Member Owner::*member, Range range,
                                        std::string_view meaning) {
  return {key, member, range, false, meaning};
}

/// What calls `take` with one row after the other. As std::tuple, tables would double the time that it takes
/// to compile a file that knows what a deck is.
template <class... Rows>
constexpr auto field_table(Rows... row) {
  return [=](const auto& take) { (take(row), ...); };
}

/// A word of the deck for a value of an enumeration. An enumeration `E` that a deck can name has, in its own
/// namespace, `constexpr std::array<NamedValue<E>, N> named_values(E)`.
template <class Enumeration>
struct NamedValue {
  std::string_view word;
  Enumeration value;
};

template <class T>
concept HasFields = requires {
  T::fields();
};
template <class T>
concept HasNamedValues = requires(T value) {
  named_values(value);
};

}  // namespace brio
