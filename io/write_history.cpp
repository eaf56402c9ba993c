#include "io/write_history.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "io/hdf5_file.hpp"
#include "io/text_file.hpp"

namespace brio {

void create_history(Hdf5File& file, const std::vector<std::string>& columns) {
  constexpr hsize_t bytes_of_chunk = 65536;
  const hsize_t count = columns.size();
  file.create_group("/history");
  file.write_texts("/history/columns", columns);
  const hsize_t rows = std::max<hsize_t>(1, bytes_of_chunk / (count * sizeof(double)));
  file.create_table("/history/values", {H5T_IEEE_F64LE, count, rows});
}

void append_history(Hdf5File& file, const History& history) {
  file.append_rows("/history/values", history.pending_rows(), H5T_NATIVE_DOUBLE, history.pending().data());
}

void create_history_csv(const std::filesystem::path& path, const std::vector<std::string>& columns) {
  std::string line;
  for (const std::string& column : columns) line += (line.empty() ? "" : ",") + column;
  replace_text_file(path, {line, "\n"});
}

void append_history_csv(const std::filesystem::path& path, const History& history) {
  std::string text;
  std::array<char, 32> digits;  // the longest double takes 24
  const std::size_t columns = history.columns().size();
  for (std::size_t i = 0; i < history.pending().size(); ++i) {
    const auto end = std::to_chars(digits.begin(), digits.end(), history.pending()[i]).ptr;
    text.append(digits.begin(), end);
    text += (i + 1) % columns == 0 ? '\n' : ',';
  }
  append_text_file(path, text);
}

}  // namespace brio
