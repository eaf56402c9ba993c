#include "apps/commands.hpp"
#include "apps/streams.hpp"
#include "io/files/read_apart.hpp"
#include "io/restart/restart_file.hpp"
#include "io/results/read_info.hpp"

namespace brio {

void print_info(const std::filesystem::path& result, bool verify) {
  write_out_text(read_apart(result, [&] {
    if (is_restart_file(result)) return restart_text(result);
    std::string text = info_text(read_info(result));
    return verify ? text + verify_result(result) : text;
  }));
}

}  // namespace brio
