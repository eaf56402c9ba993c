#pragma once
/// The list of kinds with one more, in place of elements/kinds.hpp: the directory of the toys is searched
/// first.

#include "elements/base/element_kind.hpp"
#include "elements/solid/hex8.hpp"
#include "tests/toys/spring/toy_spring.hpp"

namespace brio {

using Element = ElementList<Hex8, ToySpring>;

}  // namespace brio
