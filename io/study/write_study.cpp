#include "io/study/write_study.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <vector>

#include "io/files/text_file.hpp"
#include "io/results/write_history.hpp"

namespace brio {

namespace {

std::string percent(double share) {
  return std::isfinite(share) ? fmt::format("{:.3g} %", 100 * share) : std::string("-");
}
std::string figure(double value) { return std::isfinite(value) ? fmt::format("{:.5g}", value) : "-"; }

std::string csv(const StudyTable& table) {
  std::string text = "run,knob,setting,exit_code,processor_s,wall_s,peak_memory_mb,steps,error";
  for (const Quantity& quantity : table.study.quantities)
    text += fmt::format(",{},{}", csv_field(quantity.name), csv_field(quantity.name + "_error"));
  text += ",on_front,beats_default\n";
  for (const StudyRow& row : table.rows) {
    text += fmt::format("{},{},{},{},{:.6g},{:.6g},{:.6g},{:.0f},{:.6g}", csv_field(row.run.name),
                        csv_field(row.run.knob), csv_field(row.run.label), row.exit_code, row.processor_s,
                        row.wall_s, row.peak_memory_mb, row.steps, row.error);
    for (std::size_t q = 0; q < row.figures.size(); ++q)
      text += fmt::format(",{:.9g},{:.6g}", row.figures[q], row.errors[q]);
    text += fmt::format(",{:d},{:d}\n", row.on_front, row.beats_default);
  }
  return text;
}

std::string remarks(const StudyTable& table, const StudyRow& row) {
  std::vector<std::string> remarks;
  if (!row.has_run) {
    remarks.emplace_back("not run");
  } else if (row.exit_code != 0) {
    remarks.push_back(fmt::format("ended with {}: {}", row.exit_code, row.message));
  } else if (!row.message.empty()) {
    remarks.push_back("not measured: " + row.message);
  }
  if (row.is_reference) remarks.emplace_back("reference");
  if (row.run.is_another_problem) remarks.emplace_back("another problem");
  if (row.on_front && !row.is_reference) remarks.emplace_back("front");
  if (row.beats_default) remarks.emplace_back("beats the default");
  for (std::size_t q = 0; q < row.errors.size(); ++q) {
    const Quantity& quantity = table.study.quantities[q];
    if (quantity.tolerance && row.errors[q] > *quantity.tolerance)
      remarks.push_back(fmt::format("{} beyond {}", quantity.name, percent(*quantity.tolerance)));
  }
  return fmt::format("{}", fmt::join(remarks, "; "));
}

// Of each quantity, from each mesh to the next one of half the size.
std::string orders(const StudyTable& table) {
  if (table.study.refined.empty()) return {};
  std::vector<const StudyRow*> meshes;
  for (const StudyRow& row : table.rows)
    if (row.run.knob == table.study.refined) meshes.push_back(&row);
  std::string text = "\nOrder of convergence, from each mesh to the next:";
  for (std::size_t q = 0; q < table.study.quantities.size(); ++q) {
    text += fmt::format("{} {}", q == 0 ? "" : ";", table.study.quantities[q].name);
    for (std::size_t i = 0; i + 1 < meshes.size(); ++i)
      text += fmt::format(" {:.2f}", std::log2(meshes[i]->errors[q] / meshes[i + 1]->errors[q]));
  }
  return text + ".\n";
}

std::string verdict(const StudyTable& table) {
  std::string better;
  for (const StudyRow& row : table.rows)
    if (row.beats_default) better += fmt::format("{}`{}`", better.empty() ? "" : ", ", row.run.name);
  if (!better.empty())
    return fmt::format("Cheaper and more accurate than the default, both by more than {:.0f} %: {}.\n",
                       100 * beating_share, better);
  return fmt::format(
      "No setting is cheaper and more accurate than the default, both by more than {:.0f} %.\n",
      100 * beating_share);
}

}  // namespace

std::string study_text(const StudyTable& table) {
  std::string text;
  text += "| run | processor s | MB | steps | error |";
  for (const Quantity& quantity : table.study.quantities) text += fmt::format(" {} |", quantity.name);
  text += " |\n| --- | --- | --- | --- | --- |";
  for (std::size_t q = 0; q <= table.study.quantities.size(); ++q) text += " --- |";
  text += "\n| reference | | | | |";
  for (const double reference : table.references) text += fmt::format(" {} |", figure(reference));
  text += " |\n";
  for (const StudyRow& row : table.rows) {
    text += fmt::format("| {} | {:.3g} | {:.0f} | {:.0f} | {} |", row.run.name, row.processor_s,
                        row.peak_memory_mb, row.steps, percent(row.error));
    for (std::size_t q = 0; q < row.figures.size(); ++q)
      text += fmt::format(" {} ({}) |", figure(row.figures[q]), percent(row.errors[q]));
    text += fmt::format(" {} |\n", remarks(table, row));
  }
  text += "\nError: root mean square of those of the quantities, which stand in brackets.\n" +
          verdict(table) + orders(table);
  return text;
}

void write_study_table(const StudyTable& table, const std::filesystem::path& folder,
                       const std::string& name) {
  replace_text_file(folder / (name + ".csv"), {csv(table)});
  const std::string title = table.study.title.empty() ? name : table.study.title;
  const std::string pictures =
      fmt::format("![cost against error]({0}.front.svg)\n\n![each knob alone]({0}.knobs.svg)\n\n", name);
  const std::string advice = table.study.advice.empty() ? "" : table.study.advice + "\n\n";
  replace_text_file(folder / (name + ".md"), {"## ", title, "\n\n", advice, pictures, study_text(table)});
}

}  // namespace brio
