#include "elements/shell/shell4_kernel.hpp"

#include "elements/sweep.hpp"

namespace brio {

void choose_kernel(const Shell4&, Block& block) { choose_kernel_of<Shell4Kernel>(block); }

}  // namespace brio
