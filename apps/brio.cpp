/// The command line.

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <exception>
#include <functional>
#include <memory>
#include <new>
#include <sstream>
#include <string>
#include <system_error>
#include <thread>

#include "apps/commands.hpp"
#include "apps/ranks.hpp"
#include "apps/streams.hpp"
#include "io/files/file_error.hpp"
#include "io/yaml/closest_word.hpp"
#include "io/yaml/deck_error.hpp"
#include "src/base/breakdown.hpp"

namespace {

int complain(const std::string& fault, int exit_code) {
  brio::write_error("{}\n", fault);
  return exit_code;
}

/// Help and version go to standard output with exit code 0; everything else is a bad command.
int end_of_parsing(const CLI::App& program, const CLI::ParseError& end, int argument_count,
                   char** arguments) {
  if (end.get_exit_code() == 0) {
    std::ostringstream asked_for;
    program.exit(end, asked_for, asked_for);
    brio::write_out_text(asked_for.str());
    return brio::exit_good;
  }
  std::string fault = "brio: " + std::string(end.what());
  const std::string first = argument_count > 1 ? arguments[1] : "";
  std::vector<std::string_view> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  if (program.get_subcommands().empty() && !first.empty() && first.front() != '-')
    fault = "brio: unknown command '" + first + "'; " + brio::accepted_words(first, names);
  return complain(fault + "\nbrio --help says more", brio::exit_bad_input);
}

// Each subcommand adds itself to the command line and, if it is chosen, runs while the command line is
// parsed.

/// The command line as a shell would take it.
std::string quoted(int argument_count, char** arguments) {
  std::string line;
  for (int i = 0; i < argument_count; ++i) {
    const std::string word = arguments[i];
    const bool is_plain =
        !word.empty() && word.find_first_of(" \t\n'\"\\$`*?[]{}()<>|&;#~!") == std::string::npos;
    if (i > 0) line += ' ';
    if (is_plain) {
      line += word;
      continue;
    }
    line += '\'';
    for (const char c : word) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

void add_overrides(CLI::App* command, std::vector<std::string>& overrides) {
  command->add_option("--set", overrides, "KEY.PATH=VALUE, overrides a value of the deck")
      ->allow_extra_args(false);
}

void add_threads(CLI::App* command, int& threads, bool& by_size) {
  command
      ->add_option_function<int>(
          "--threads",
          [&threads, &by_size](int number) {
            threads = number;
            by_size = false;
          },
          "number of threads; default all processors, but at most one for each thousand nodes")
      ->check(CLI::Range(1, 1024));
  threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  by_size = true;
}

void add_run_command(CLI::App& program, const std::string& command_line, int& exit_code) {
  auto arguments = std::make_shared<brio::RunArguments>();
  brio::RunOptions& options = arguments->options;
  CLI::App* command = program.add_subcommand("run", "Run a deck and write its results");
  command->add_option("deck", options.deck, "YAML deck")->required();
  command->add_option("--output", options.output, "result folder; default NAME.results here");
  add_threads(command, options.threads, options.threads_by_size);
  add_overrides(command, options.overrides);
  command
      ->add_option("--restart", options.restart,
                   "restart file of a run that goes on; its results go on in the same folder")
      ->type_name("FILE");
  command
      ->add_option("--stop-after", options.stop_after_s,
                   "wall time after which the run is saved in NAME.restart.h5 and stops")
      ->check(CLI::PositiveNumber)
      ->type_name("SECONDS");
  command->add_flag("--overwrite", options.overwrite,
                    "remove the results of an earlier run; default: they are moved to FOLDER.previous");
  command->add_flag("--quiet", arguments->quiet, "print errors only");
  command->add_flag("--json", arguments->json, "print the summary as JSON");
  arguments->command = command_line;
  command->callback([arguments, &exit_code] { exit_code = brio::run(*arguments); });
}

void set_coarse_run_budget(const std::string& budget, brio::ForecastOptions& options) {
  std::size_t read = 0;
  double number = -1;
  try {
    number = std::stod(budget, &read);
  } catch (const std::logic_error&) {
  }
  const bool is_percentage = read > 0 && budget.substr(read) == "%";
  if (!(number >= 0 && number < HUGE_VAL) || (read != budget.size() && !is_percentage))
    throw CLI::ValidationError(
        "--coarse-run", "'" + budget + "' is no budget; accepted: seconds >= 0, or a percentage as 40%");
  options.coarse_run_s = is_percentage ? HUGE_VAL : number;
  options.coarse_run_fraction = is_percentage ? 0.01 * number : HUGE_VAL;
}

void add_check_command(CLI::App& program) {
  struct Arguments {
    brio::ForecastOptions options;
    bool json = false;
  };
  auto arguments = std::make_shared<Arguments>();
  brio::ForecastOptions& options = arguments->options;
  options.coarse_run_s = 90;
  options.coarse_run_fraction = 0.4;
  CLI::App* command = program.add_subcommand(
      "check", "Read a deck, build its scene, summarize it and predict the cost of a run");
  command->add_option("deck", options.deck, "YAML deck")->required();
  add_threads(command, options.threads, options.threads_by_size);
  const auto add_budget = [command](const char* name, const std::function<void(const std::string&)>& set,
                                    const char* meaning) {
    return command->add_option_function<std::string>(name, set, meaning)
        ->type_name("SECONDS|P%")
        ->expected(0, 1)
        ->default_str("90");
  };
  add_budget(
      "--coarse-run", [&options](const std::string& budget) { set_coarse_run_budget(budget, options); },
      "budget to predict the decrease of the stable time step, by runs with coarser meshes and further timed "
      "steps: seconds, or P% of the predicted run; 0: none; default: 90 s, but at most 40 % of the run");
  add_budget(
      "--pilot",
      [&options](const std::string& budget) {
        brio::write_error(
            "brio: --pilot is called --coarse-run now; the old name is accepted for one version\n");
        set_coarse_run_budget(budget, options);
      },
      "old name of --coarse-run")
      ->group("");
  add_overrides(command, options.overrides);
  command->add_flag("--json", arguments->json, "print all of it as JSON");
  command->callback([arguments] { brio::check(arguments->options, arguments->json); });
}

void add_study_command(CLI::App& program, int& exit_code) {
  auto arguments = std::make_shared<brio::StudyArguments>();
  brio::StudyOptions& options = arguments->options;
  CLI::App* command =
      program.add_subcommand("study", "Run one deck over a table of settings; cost against error");
  command->add_option("study", options.study, "YAML study")->required();
  command->add_option("--output", options.output, "folder of the study; default NAME.study here");
  command->add_option("--jobs", options.jobs, "runs side by side; default one a processor")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--again", options.again, "repeat runs whose results exist");
  command->add_flag("--quiet", arguments->quiet, "print no progress");
  options.jobs = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  command->callback([arguments, &exit_code] { exit_code = brio::study(*arguments); });
}

void add_info_command(CLI::App& program) {
  auto path = std::make_shared<std::filesystem::path>();
  auto verify = std::make_shared<bool>(false);
  CLI::App* command = program.add_subcommand("info", "List the contents of a result");
  command->add_option("result", *path, "result folder, .vtkhdf file or restart file")->required();
  command->add_flag("--verify", *verify, "read the whole file and verify the checksums of every dump");
  command->callback([path, verify] { brio::print_info(*path, *verify); });
}

void add_plot_command(CLI::App& program) {
  struct Arguments {
    brio::PlotOptions options;
    std::vector<std::string> words;
  };
  auto arguments = std::make_shared<Arguments>();
  brio::PlotOptions& options = arguments->options;
  CLI::App* command = program.add_subcommand("plot", "Draw columns of the history of results (SVG)");
  command
      ->add_option("words", arguments->words,
                   "result folders or .vtkhdf files, and columns; without columns: the energies")
      ->required();
  command->add_option("--against", options.against,
                      "column of the other axis, as --against=-NAME of the other sign; default time");
  command->add_option("--scale", options.scale, "factor on the columns, such as -1");
  command
      ->add_option("--filter", options.filter,
                   "channel frequency class of SAE J211, such as 60, 180, 600, 1000; times are in seconds")
      ->check(CLI::PositiveNumber)
      ->type_name("CFC");
  command->add_option("--output", options.output, "picture, .svg; default NAME.plot.svg here");
  command->callback([arguments] { brio::plot(arguments->options, arguments->words); });
}

void add_new_command(CLI::App& program) {
  auto name = std::make_shared<std::filesystem::path>();
  CLI::App* command = program.add_subcommand("new", "Write a first deck with comments, NAME.yaml");
  command->add_option("name", *name, "name of the deck; a file that is there stays as it is")->required();
  command->callback([name] { brio::write_new_deck(*name); });
}

void add_report_command(CLI::App& program) {
  auto arguments = std::make_shared<brio::ReportOptions>();
  CLI::App* command = program.add_subcommand(
      "report", "Write one page (HTML) that shows a result in a browser, without a network");
  command->add_option("result", arguments->result, "result folder or .vtkhdf file")->required();
  command->add_option("--output", arguments->output,
                      "page; default: the name of the result with .html, beside it");
  command->add_option("--frames", arguments->frames, "dumps to show at most; default 100")
      ->check(CLI::Range(1, 65535));
  command
      ->add_option("--fields", arguments->fields,
                   "fields to colour by, such as von_mises,velocity; default: all that are not zero")
      ->delimiter(',')
      ->type_name("NAME,...");
  command->callback([arguments] { brio::report(*arguments); });
}

void add_schema_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "schema", "print the JSON schema of decks, for completion and checking in editors");
  auto markdown = std::make_shared<bool>(false);
  command->add_flag("--markdown", *markdown, "print the reference for people instead");
  auto of_study = std::make_shared<bool>(false);
  command->add_flag("--study", *of_study, "of studies instead of decks");
  auto of_results = std::make_shared<bool>(false);
  command->add_flag("--results", *of_results, "print what results hold, for people, instead");
  command->callback(
      [of_study, of_results, markdown] { brio::print_schema(*of_study, *of_results, *markdown); });
}

int run_command(int argument_count, char** arguments) {
  CLI::App program("Brio: explicit transient dynamics of solids, shells and beams with contact", "brio");
  int exit_code = brio::exit_good;
  program.require_subcommand(1);
  add_new_command(program);
  add_run_command(program, quoted(argument_count, arguments), exit_code);
  add_check_command(program);
  add_study_command(program, exit_code);
  add_info_command(program);
  add_plot_command(program);
  add_report_command(program);
  add_schema_command(program);
  for (CLI::App* command : program.get_subcommands({}))
    command->set_version_flag("--version", "brio " BRIO_VERSION);
  program.set_version_flag("--version", "brio " BRIO_VERSION);
  try {
    program.parse(argument_count, arguments);
  } catch (const CLI::ParseError& end) {
    if (const brio::Ranks* ranks = brio::join_ranks()) brio::mute(ranks->number() > 0);
    return end_of_parsing(program, end, argument_count, arguments);
  }
  return exit_code;
}

/// The one place where what went wrong becomes a message and an exit code.
/// \pre an exception is being handled
int end_of_exception() {
  try {
    throw;
  } catch (const brio::DeckError& fault) {
    return complain(fault.what(), brio::exit_bad_input);
  } catch (const brio::Breakdown& failure) {
    return complain(std::string("brio: ") + failure.what(), brio::exit_numerical_failure);
  } catch (const brio::FileError& fault) {
    return complain(std::string("brio: ") + fault.what(), brio::exit_file_failure);
  } catch (const std::system_error& fault) {  // files, threads, processes
    return complain(std::string("brio: ") + fault.what(), brio::exit_file_failure);
  } catch (const std::bad_alloc&) {
    return complain("brio: not enough memory", brio::exit_file_failure);
  } catch (const std::exception& defect) {
    return complain(std::string("brio: a defect of this program: ") + defect.what(), brio::exit_defect);
  } catch (...) {
    return complain("brio: a defect of this program", brio::exit_defect);
  }
}

// What is thrown where nothing can catch it ends the program all the same with a message and an exit code.
[[noreturn]] void end_at_once() { _exit(std::current_exception() ? end_of_exception() : brio::exit_defect); }

}  // namespace

int main(int argument_count, char** arguments) {
  brio::prepare_streams();
  std::set_terminate(end_at_once);
  int exit_code = brio::exit_good;
  try {
    exit_code = run_command(argument_count, arguments);
  } catch (...) {
    const bool together = brio::ranks_fail_together();
    if (!together) brio::mute(false);
    exit_code = end_of_exception();
    if (!together) brio::end_all_ranks(exit_code);
  }
  brio::leave_ranks();
  const std::string fault = brio::finish_output();
  if (fault.empty()) return exit_code;
  complain("brio: " + fault, exit_code);
  return exit_code == brio::exit_good ? brio::exit_file_failure : exit_code;
}
