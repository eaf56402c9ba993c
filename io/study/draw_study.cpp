// The pictures of a study.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/files/text_file.hpp"
#include "io/study/gnuplot.hpp"
#include "io/study/write_study.hpp"

namespace brio {

namespace {

bool can_be_drawn(const StudyRow& row) {
  return row.exit_code == 0 && row.processor_s > 0 && std::isfinite(row.error) && row.error > 0;
}

std::string line_of(const StudyRow& row, const std::string& label) {
  return fmt::format("{:.6g} {:.6g} {}\n", row.processor_s, 100 * row.error, data_field(label));
}

// A block of data that plots name.
std::string block(const std::string& name, const std::vector<const StudyRow*>& rows, bool short_labels) {
  std::vector<const StudyRow*> sorted = rows;
  std::sort(sorted.begin(), sorted.end(),
            [](const StudyRow* a, const StudyRow* b) { return a->processor_s < b->processor_s; });
  std::string text = fmt::format("${} << EOD\n", name);
  for (const StudyRow* row : sorted) text += line_of(*row, short_labels ? row->run.label : row->run.name);
  return text + "EOD\n";
}

struct Span {
  double least = HUGE_VAL, largest = 0;
  void widen(double value) {
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  std::string range() const { return fmt::format("[{:.6g}:{:.6g}]", least / 1.5, largest * 1.5); }
};

struct Drawing {
  std::string data, front, knobs;
  std::size_t panels = 0;
};

std::vector<const StudyRow*> rows_where(const StudyTable& table, auto&& wanted) {
  std::vector<const StudyRow*> result;
  for (const StudyRow& row : table.rows)
    if (can_be_drawn(row) && wanted(row)) result.push_back(&row);
  return result;
}

Drawing drawing(const StudyTable& table) {
  Drawing result;
  const bool has_default = can_be_drawn(table.rows[0]);
  result.data = block("front", rows_where(table, [](const StudyRow& row) { return row.on_front; }), false);
  result.data +=
      block("default", rows_where(table, [&](const StudyRow& row) { return &row == &table.rows[0]; }), false);
  result.front =
      "plot $front with steps lw 2 lc rgb 'gray60' title 'front', "
      "$front using 1:2:3 with labels left offset 0.7,0.7 font ',9' notitle";
  int colour = 0;
  // Each knob's settings are joined by way of the default, from which they differ in that alone.
  const auto add = [&](const std::string& name, const std::string& title, std::vector<const StudyRow*> rows) {
    if (rows.empty()) return false;
    ++colour;
    result.data += block(name, rows, true);
    if (has_default) rows.push_back(&table.rows[0]);
    result.data += block(name + "_line", rows, true);
    result.front += fmt::format(", ${} using 1:2 with points pt 7 ps 0.9 lc {} title {}", name, colour,
                                text_literal(title));
    return true;
  };
  std::size_t number = 0;
  for (const auto& [knob, settings] : table.study.knobs) {
    const std::string name = fmt::format("knob{}", number++);
    const auto rows = rows_where(table, [&, &k = knob](const StudyRow& row) { return row.run.knob == k; });
    if (!add(name, knob, rows)) continue;
    ++result.panels;
    result.knobs += fmt::format(
        "set title {}\nplot ${}_line using 1:2 with linespoints pt 7 ps 0.9 lc {} notitle, "
        "${} using 1:2:3 with labels left offset 0.7,0.4 font ',9' notitle",
        text_literal(knob), name, colour, name);
    if (has_default) result.knobs += ", $default using 1:2 with points pt 3 ps 1.5 lc rgb 'black' notitle";
    result.knobs += "\n";
  }
  add("combined", "combinations",
      rows_where(table, [&](const StudyRow& row) { return row.run.knob.empty() && &row != &table.rows[0]; }));
  if (has_default)
    result.front += ", $default using 1:2 with points pt 3 ps 2 lw 2 lc rgb 'black' title 'default'";
  return result;
}

std::string script(const StudyTable& table, const std::string& name) {
  const Drawing parts = drawing(table);
  Span cost, error;
  for (const StudyRow* row : rows_where(table, [](const StudyRow&) { return true; })) {
    cost.widen(row->processor_s);
    error.widen(100 * row->error);
  }
  const std::size_t across = std::min<std::size_t>(3, std::max<std::size_t>(1, parts.panels));
  const std::size_t down = (parts.panels + across - 1) / std::max<std::size_t>(1, across);
  std::string text = "# gnuplot " + without_control(name) + ".gp\nset encoding utf8\n" + parts.data;
  text += fmt::format(
      "set logscale xy\nset grid lc rgb 'gray85'\nset xrange {}\nset yrange {}\nset format y '%g'\nset "
      "format x "
      "'%g'\n",
      cost.range(), error.range());
  for (const auto& [kind, end] : {std::pair{"svg noenhanced font 'sans,12' background 'white'", "svg"},
                                  std::pair{"pngcairo noenhanced font 'sans,11'", "png"}}) {
    text += fmt::format(
        "set terminal {} size {},{}\nset output {}\nset title {}\nset xlabel 'cost: processor "
        "seconds'\nset ylabel 'error, %'\nset key outside right top\n{}\n",
        kind, 900, 560, literal("./" + name + ".front." + end),
        text_literal(table.study.title.empty() ? name : table.study.title), parts.front);
    if (parts.panels == 0) continue;
    text += fmt::format(
        "set terminal {} size {},{}\nset output {}\nunset key\nset multiplot layout "
        "{},{}\n{}unset "
        "multiplot\n",
        kind, 420 * across, 320 * down, literal("./" + name + ".knobs." + end), down, across, parts.knobs);
  }
  return text + "unset output\n";
}

}  // namespace

std::string draw_study(const StudyTable& table, const std::filesystem::path& folder,
                       const std::string& name) {
  if (rows_where(table, [](const StudyRow&) { return true; }).empty())
    return "no run has an error to be drawn";
  replace_text_file(folder / (name + ".gp"), {script(table, name)});
  for (const char* end : {".front.svg", ".front.png", ".knobs.svg", ".knobs.png"})
    remove_file(folder / (name + end));  // gnuplot would follow a symbolic link
  return run_gnuplot(folder, name + ".gp");
}

}  // namespace brio
