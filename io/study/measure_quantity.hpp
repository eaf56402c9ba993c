#pragma once
/// Figures of a study, read out of results.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "src/forecast/study.hpp"

namespace brio {

/// \param file the `.vtkhdf` file of a result
/// \param parts names of the deck's parts, in its order
/// \return one figure a quantity
/// \throws FileError where the result does not hold what a quantity names.
std::vector<double> measure_quantities(std::span<const Quantity> quantities,
                                       const std::filesystem::path& file, std::span<const std::string> parts);

}  // namespace brio
