#include <cstdio>
#include <memory>
#include <string>

#include "apps/commands.hpp"
#include "io/file_error.hpp"
#include "io/write_schema.hpp"

namespace brio {

void add_schema_command(CLI::App& program, int& exit_code) {
  CLI::App* command = program.add_subcommand(
      "schema", "print the JSON schema of the deck, for completion and checking in editors");
  auto markdown = std::make_shared<bool>(false);
  command->add_flag("--markdown", *markdown, "print the reference of the deck for people instead");
  command->callback([markdown, &exit_code] {
    const std::string text = *markdown ? deck_reference() : deck_schema();
    if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0)
      throw FileError("standard output", "cannot be written");
    exit_code = exit_good;
  });
}

}  // namespace brio
