#pragma once
/// What is wrong with an element at the start.

#include <cstddef>
#include <stdexcept>
#include <string>

namespace brio {

struct BadElement : std::invalid_argument {
  BadElement(std::size_t in_block, const std::string& fault)
      : std::invalid_argument("element " + std::to_string(in_block) + " of the block " + fault),
        place(in_block),
        rule(fault) {}
  std::size_t place;  ///< in its block, whose order is not that of the mesh
  std::string rule;
};

}  // namespace brio
