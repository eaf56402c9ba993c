#include "elements/sweep.hpp"
#include "tests/toys/spring/toy_spring_kernel.hpp"

namespace brio {

void choose_kernel(const ToySpring&, Block& block) { choose_kernel_of<ToySpringKernel>(block); }

}  // namespace brio
