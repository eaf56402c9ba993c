#include "elements/hex8_full_kernel.hpp"
#include "elements/sweep.hpp"

namespace brio {

void choose_kernel(const Hex8Full& element, Block& block) {
  if (element.objective_rate == ObjectiveRate::green_naghdi) {
    choose_kernel_of<Hex8FullKernel<ObjectiveRate::green_naghdi>>(block);
  } else {
    choose_kernel_of<Hex8FullKernel<ObjectiveRate::jaumann>>(block);
  }
}

}  // namespace brio
