#include "elements/solid/hex8_full_kernel.hpp"
#include "elements/sweep.hpp"

namespace brio {

template void choose_kernel_of<Hex8FullKernel<ObjectiveRate::jaumann>>(Block& block);

}  // namespace brio
