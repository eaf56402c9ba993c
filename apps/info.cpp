#include "apps/commands.hpp"
#include "apps/streams.hpp"
#include "io/files/read_apart.hpp"
#include "io/restart/restart_file.hpp"
#include "io/results/read_info.hpp"

namespace brio {

void print_info(const std::filesystem::path& result, bool verify) {
  const std::filesystem::path file = result_file(result);
  write_out_text(read_apart(file, [&] {
    if (is_restart_file(file)) return restart_text(file);
    std::string text = info_text(read_info(file));
    return verify ? text + verify_result(file) : text;
  }));
}

}  // namespace brio
