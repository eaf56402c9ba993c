#include "io/plot/plot_history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string_view>

#include "io/files/file_error.hpp"
#include "io/files/text_file.hpp"
#include "io/plot/cfc_filter.hpp"
#include "io/results/read_info.hpp"
#include "io/results/read_result.hpp"
#include "io/study/gnuplot.hpp"

namespace brio {

namespace {

constexpr std::array<std::string_view, 9> energies{"kinetic", "internal", "hourglass", "viscous", "deleted",
                                                   "contact", "friction", "external",  "total"};

struct HistoryCurve {
  std::string title;
  std::vector<double> x, y;
};

bool is_zero(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return value == 0; });
}

std::vector<std::string> columns_of(const PlotOptions& options, const ReadHistory& history,
                                    const std::filesystem::path& file) {
  if (!options.columns.empty()) return options.columns;
  std::vector<std::string> columns;
  for (const std::string_view name : energies)
    if (!is_zero(history.column(std::string(name), file))) columns.emplace_back(name);
  return columns;
}

// Filtered signals stand at equally spaced times.
void filter(const std::vector<double>& times, double channel_class, const std::filesystem::path& file,
            HistoryCurve& curve) {
  if (times.size() < 3) throw FileError(file, "the history has too few rows for a filter");
  const std::size_t count = times.size();
  const double interval = (times.back() - times.front()) / static_cast<double>(count - 1);
  try {
    curve.y = filter_cfc(resampled(times, curve.y, count), interval, channel_class);
  } catch (const std::invalid_argument& fault) {
    throw FileError(file, fault.what());
  }
  curve.x = resampled(times, curve.x, count);
}

// With a minus before its name of the other sign: shortening in place of a displacement.
std::vector<double> other_axis(const std::string& name, const ReadHistory& history,
                               const std::filesystem::path& file) {
  if (!name.starts_with('-')) return history.column(name, file);
  std::vector<double> values = history.column(name.substr(1), file);
  for (double& value : values) value = -value;
  return values;
}

void add_curves(const PlotOptions& options, const std::filesystem::path& result,
                std::vector<HistoryCurve>& curves) {
  const std::filesystem::path file = result_file(result);
  const ReadHistory history = ResultReader(file).history();
  const std::vector<double> times = history.column("time", file);
  for (const std::string& name : columns_of(options, history, file)) {
    HistoryCurve& curve = curves.emplace_back();
    curve.title = options.results.size() > 1 ? file.stem().string() + ": " + name : name;
    curve.x = other_axis(options.against, history, file);
    curve.y = history.column(name, file);
    for (double& value : curve.y) value *= options.scale;
    if (options.filter) filter(times, *options.filter, file, curve);
  }
}

std::string script(const std::vector<HistoryCurve>& curves, const PlotOptions& options,
                   const std::string& picture) {
  std::string text = "set encoding utf8\n";
  for (std::size_t c = 0; c < curves.size(); ++c) {
    text += fmt::format("$curve{} << EOD\n", c);
    for (std::size_t i = 0; i < curves[c].x.size(); ++i)
      text += fmt::format("{:.9g} {:.9g}\n", curves[c].x[i], curves[c].y[i]);
    text += "EOD\n";
  }
  const bool single = curves.size() == 1;
  text += fmt::format(
      "set terminal svg noenhanced size 900,560 font 'sans,12' background 'white'\nset output {}\n"
      "set grid lc rgb 'gray85'\nset format '%g'\nset xlabel {}\n",
      literal("./" + picture), text_literal(options.against));
  text += single ? fmt::format("set ylabel {}\nunset key\n", text_literal(curves.front().title))
                 : std::string("set key outside right top\n");
  for (std::size_t c = 0; c < curves.size(); ++c)
    text += fmt::format("{}$curve{} using 1:2 with lines lw 1.5 title {}", c == 0 ? "plot " : ", ", c,
                        text_literal(curves[c].title));
  return text + "\nunset output\n";
}

}  // namespace

std::filesystem::path picture_of(const PlotOptions& options) {
  if (!options.output.empty()) return options.output;
  return result_file(options.results.front()).stem().string() + ".plot.svg";
}

std::string plot_commands(const PlotOptions& options) {
  std::vector<HistoryCurve> curves;
  for (const std::filesystem::path& result : options.results) add_curves(options, result, curves);
  return script(curves, options, picture_of(options).filename().string());
}

void draw_plot(const std::filesystem::path& picture, const std::string& commands) {
  const std::filesystem::path folder = picture.has_parent_path() ? picture.parent_path() : ".";
  const std::string name = picture.stem().string() + ".gp";
  replace_text_file(folder / name, {commands});
  remove_file(picture);  // gnuplot would follow a symbolic link
  if (const std::string fault = run_gnuplot(folder, name); !fault.empty()) throw FileError(picture, fault);
}

}  // namespace brio
