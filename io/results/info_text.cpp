#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "io/results/read_info.hpp"

namespace brio {
namespace {

std::string run_lines(const ResultInfo& info) {
  std::string text =
      fmt::format("{}\n  title      {}\n  deck       {}\n", info.file.string(), info.title, info.deck_path);
  for (const std::string& change : info.overrides) text += fmt::format("             with {}\n", change);
  text += fmt::format("  program    brio {}, {} thread{}\n", info.version, info.threads,
                      info.threads == 1 ? "" : "s");
  if (info.status.empty()) return text + "  status     no summary: the run goes on, or was killed\n";
  return text + fmt::format("  status     {} (exit code {}) after {} steps\n", info.status, info.exit_code,
                            info.steps);
}

std::string dump_lines(const ResultInfo& info) {
  if (info.times.empty()) return "  dumps      none\n";
  std::string text = fmt::format("  dumps      {}, from time {:.6g} to {:.6g}\n", info.times.size(),
                                 info.times.front(), info.times.back());
  text += fmt::format("  last dump  {} points", info.points);
  for (const auto& [name, count] : info.cells) text += fmt::format(", {} {}", count, name);
  text += "\n";
  for (const FieldInfo& field : info.fields) {
    text += fmt::format("    {:<7} {:<28} {:>2} component{} {:>13.6g} to {:.6g}\n", field.where, field.name,
                        field.components, field.components == 1 ? " " : "s", field.min, field.max);
  }
  return text;
}

std::string all_lines(const ResultInfo& info) {
  std::string text = run_lines(info) + dump_lines(info);
  text += fmt::format("  history    {} rows of {} columns{}\n", info.history_rows,
                      info.history_columns.size(), info.history_last.empty() ? "" : "; the last:");
  for (std::size_t i = 0; i < info.history_last.size(); ++i) {
    text += fmt::format("    {:<36} {:>13.6g}\n", info.history_columns[i], info.history_last[i]);
  }
  if (!info.energies.empty()) text += "  energies at the end\n";
  for (const auto& [name, value] : info.energies) text += fmt::format("    {:<36} {:>13.6g}\n", name, value);
  return text;
}

}  // namespace

std::string info_text(const ResultInfo& info) {
  std::string text = all_lines(info);
  // What a file holds may be anything: it gives no orders to a terminal.
  std::replace_if(
      text.begin(), text.end(),
      [](char c) { return std::iscntrl(static_cast<unsigned char>(c)) != 0 && c != '\n'; }, '?');
  return text;
}

}  // namespace brio
