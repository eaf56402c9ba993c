#include "io/results/write_history.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "io/files/checksum.hpp"
#include "io/files/hdf5_file.hpp"
#include "io/files/text_file.hpp"
#include "io/results/dump_checksums.hpp"

namespace brio {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  return quoted + '"';
}

void create_history(Hdf5File& file, const std::vector<std::string>& columns) {
  constexpr hsize_t bytes_of_chunk = 65536;
  const hsize_t count = columns.size();
  file.create_group("/history");
  file.write_texts("/history/columns", columns);
  const hsize_t rows = std::max<hsize_t>(1, bytes_of_chunk / (count * sizeof(double)));
  file.create_table("/history/values", {H5T_IEEE_F64LE, count, rows});
}

void append_history(Hdf5File& file, const History& history) {
  const std::vector<double>& values = history.pending();
  const std::int64_t first = file.dimensions("/history/values").at(0);
  append_history_checksum(file, {"/history/values", first, static_cast<std::int64_t>(history.pending_rows()),
                                 checksum(values.data(), values.size() * sizeof(double))});
  file.commit();
  file.append_rows("/history/values", history.pending_rows(), H5T_NATIVE_DOUBLE, values.data());
}

void create_history_csv(const std::filesystem::path& path, const std::vector<std::string>& columns) {
  std::string line;
  for (const std::string& column : columns) line += (line.empty() ? "" : ",") + csv_field(column);
  replace_text_file(path, {line, "\n"});
}

void append_history_csv(const std::filesystem::path& path, const History& history, bool sync) {
  std::string text;
  std::array<char, 32> digits;  // the longest double takes 24
  const std::size_t columns = history.columns().size();
  for (std::size_t i = 0; i < history.pending().size(); ++i) {
    const auto end = std::to_chars(digits.begin(), digits.end(), history.pending()[i]).ptr;
    text.append(digits.begin(), end);
    text += (i + 1) % columns == 0 ? '\n' : ',';
  }
  append_text_file(path, text, sync);
}

}  // namespace brio
