#include "elements/hex8.hpp"

#include "elements/sweep.hpp"

namespace brio {

void choose_kernel(const Hex8&, Block& block) { choose_kernel_of<Hex8>(block); }

}  // namespace brio
