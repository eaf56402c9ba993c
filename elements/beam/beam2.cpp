#include "elements/beam/beam2_kernel.hpp"
#include "elements/sweep.hpp"

namespace brio {

void choose_kernel(const Beam2& beam, Block& block) {
  block.element = beam.prepared();
  choose_kernel_of<Beam2Kernel>(block);
}

}  // namespace brio
