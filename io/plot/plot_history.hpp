#pragma once
/// Curves of the histories of one or several results.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace brio {

struct PlotOptions {
  std::vector<std::filesystem::path> results;  ///< folders or .vtkhdf files
  std::vector<std::string> columns;            ///< empty: the energies of the balance that are not zero
  std::string against = "time";  ///< column of the other axis; with a minus before it of the other sign
  double scale = 1;              ///< of the columns
  std::optional<double> filter;  ///< channel frequency class of SAE J211, Hz; times are seconds
  std::filesystem::path output;  ///< .svg; empty: NAME.plot.svg here
};

/// What gnuplot is told. \throws FileError naming the columns that there are
std::string plot_commands(const PlotOptions& options);
std::filesystem::path picture_of(const PlotOptions& options);

/// Draws the picture; the commands stay beside it. \throws FileError where gnuplot is not there or fails
void draw_plot(const std::filesystem::path& picture, const std::string& commands);

}  // namespace brio
