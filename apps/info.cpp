#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "apps/commands.hpp"
#include "io/read_info.hpp"

namespace brio {

void add_info_command(CLI::App& program, int&) {
  auto path = std::make_shared<std::filesystem::path>();
  CLI::App* command = program.add_subcommand("info", "Say what is in a result");
  command->add_option("result", *path, "result folder or .vtkhdf file")->required();
  command->callback([path] { fmt::print("{}", info_text(read_info(*path))); });
}

}  // namespace brio
