#include <fmt/format.h>

#include "apps/commands.hpp"
#include "io/read_info.hpp"

namespace brio {

void print_info(const std::filesystem::path& result) { fmt::print("{}", info_text(read_info(result))); }

}  // namespace brio
