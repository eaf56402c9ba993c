#pragma once
/// The kinds of element that a deck can name. A new one is its folder and a word here (docs/extending.md).

#include "elements/base/element_kind.hpp"
#include "elements/beam/beam2.hpp"
#include "elements/particle/particle.hpp"
#include "elements/rigid.hpp"
#include "elements/shell/shell4.hpp"
#include "elements/solid/hex8.hpp"
#include "elements/solid/hex8_full.hpp"

namespace brio {

using Element = ElementList<Hex8, Hex8Full, Shell4, Beam2, Particle, Rigid>;

}  // namespace brio
