// Does not compile: no trait of a kernel is called use_differences.
#include "elements/base/element_kind.hpp"

constexpr brio::KernelTraits traits{.use_differences = true};
