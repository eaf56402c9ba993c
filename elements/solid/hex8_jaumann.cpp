#include "elements/solid/hex8_kernel.hpp"
#include "elements/sweep.hpp"

namespace brio {

template void choose_kernel_of<Hex8Kernel<ObjectiveRate::jaumann>>(Block& block);

}  // namespace brio
