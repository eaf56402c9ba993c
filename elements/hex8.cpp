#include "elements/hex8_kernel.hpp"
#include "elements/sweep.hpp"

namespace brio {

void choose_kernel(const Hex8& element, Block& block) {
  if (element.objective_rate == ObjectiveRate::green_naghdi) {
    choose_kernel_of<Hex8Kernel<ObjectiveRate::green_naghdi>>(block);
  } else {
    choose_kernel_of<Hex8Kernel<ObjectiveRate::jaumann>>(block);
  }
}

}  // namespace brio
