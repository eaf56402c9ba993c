#pragma once
/// The subcommands of `brio`. Each adds itself to the command line and, if it is chosen, runs while the
/// command line is parsed and leaves its exit code.

#include <CLI/CLI.hpp>
#include <span>

#include "contact/overlap.hpp"

namespace brio {

/// Exit codes that scripts rely on.
inline constexpr int exit_good = 0;
inline constexpr int exit_bad_input = 2;          ///< bad command, deck or mesh: nothing was computed
inline constexpr int exit_numerical_failure = 3;  ///< the last good state was written
inline constexpr int exit_file_failure = 4;       ///< what was written before stays readable

/// A line for each pair of parts whose nodes were moved apart before the first step.
void print_overlaps(std::span<const InitialOverlap> overlaps);

void add_run_command(CLI::App& program, int& exit_code);
void add_check_command(CLI::App& program, int& exit_code);
void add_info_command(CLI::App& program, int& exit_code);
void add_schema_command(CLI::App& program, int& exit_code);

}  // namespace brio
