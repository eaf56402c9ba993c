#pragma once
/// Subscripts of containers whose entries are numbered by int, as nodes, elements and faces are.

#include <concepts>
#include <cstddef>
#include <type_traits>

namespace brio {

/// \pre not negative
template <class Number>
requires std::integral<Number> || std::is_enum_v<Number>
constexpr std::size_t index(Number number) { return static_cast<std::size_t>(number); }

/// Entry `number` of a container.
template <class Container>
requires requires(Container& of) { of[std::size_t{}]; }
constexpr decltype(auto) at(Container& of, auto number) { return of[index(number)]; }

}  // namespace brio
