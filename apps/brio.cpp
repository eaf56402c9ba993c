/// The command line.

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "apps/commands.hpp"
#include "io/closest_word.hpp"
#include "io/deck_error.hpp"
#include "io/file_error.hpp"
#include "src/breakdown.hpp"

namespace {

int complain(const std::string& fault, int exit_code) {
  std::fprintf(stderr, "%s\n", fault.c_str());
  return exit_code;
}

/// Help and version go to standard output with exit code 0; everything else is a bad command.
int end_of_parsing(const CLI::App& program, const CLI::ParseError& end, int argument_count,
                   char** arguments) {
  if (end.get_exit_code() == 0) return program.exit(end) == 0 ? brio::exit_good : brio::exit_bad_input;
  std::string fault = "brio: " + std::string(end.what());
  const std::string first = argument_count > 1 ? arguments[1] : "";
  std::vector<std::string_view> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  if (program.get_subcommands().empty() && !first.empty() && first.front() != '-')
    fault = "brio: unknown command '" + first + "'; " + brio::accepted_words(first, names);
  return complain(fault + "\nbrio --help says more", brio::exit_bad_input);
}

}  // namespace

int main(int argument_count, char** arguments) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is a file error like any other, not the end
  CLI::App program("Brio: explicit transient dynamics of solids, shells and beams with contact", "brio");
  int exit_code = brio::exit_good;
  program.require_subcommand(1);
  brio::add_run_command(program, exit_code);
  brio::add_check_command(program, exit_code);
  brio::add_info_command(program, exit_code);
  brio::add_schema_command(program, exit_code);
  for (CLI::App* command : program.get_subcommands({}))
    command->set_version_flag("--version", "brio " BRIO_VERSION);
  program.set_version_flag("--version", "brio " BRIO_VERSION);
  try {
    program.parse(argument_count, arguments);
  } catch (const CLI::ParseError& end) {
    return end_of_parsing(program, end, argument_count, arguments);
  } catch (const brio::DeckError& fault) {
    return complain(fault.what(), brio::exit_bad_input);
  } catch (const brio::Breakdown& failure) {
    return complain(std::string("brio: ") + failure.what(), brio::exit_numerical_failure);
  } catch (const brio::FileError& fault) {
    return complain(std::string("brio: ") + fault.what(), brio::exit_file_failure);
  } catch (const std::bad_alloc&) {
    return complain("brio: not enough memory", brio::exit_bad_input);
  }
  return exit_code;
}
