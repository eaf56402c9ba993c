#include <filesystem>

#include "apps/commands.hpp"
#include "apps/streams.hpp"
#include "io/files/read_apart.hpp"
#include "io/results/read_info.hpp"

namespace brio {

void plot(PlotOptions options, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    if (std::filesystem::exists(word))
      options.results.emplace_back(word);
    else
      options.columns.push_back(word);
  }
  if (options.results.empty()) options.results.emplace_back(words.front());  // whose fault is told
  const std::string commands =
      read_apart(result_file(options.results.front()), [&] { return plot_commands(options); });
  const std::filesystem::path picture = picture_of(options);
  draw_plot(picture, commands);
  write_out("{}\n", picture.string());
}

}  // namespace brio
