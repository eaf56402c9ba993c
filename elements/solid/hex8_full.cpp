#include "elements/solid/hex8_full_kernel.hpp"
#include "elements/sweep.hpp"

namespace brio {

// In a source of its own, so that both rates compile at the same time.
extern template void choose_kernel_of<Hex8FullKernel<ObjectiveRate::jaumann>>(Block& block);

void choose_kernel(const Hex8Full& element, Block& block) {
  if (element.objective_rate == ObjectiveRate::green_naghdi) {
    choose_kernel_of<Hex8FullKernel<ObjectiveRate::green_naghdi>>(block);
  } else {
    choose_kernel_of<Hex8FullKernel<ObjectiveRate::jaumann>>(block);
  }
}

}  // namespace brio
