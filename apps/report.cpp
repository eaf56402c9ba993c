#include "apps/commands.hpp"
#include "apps/streams.hpp"
#include "io/files/read_apart.hpp"
#include "io/files/text_file.hpp"
#include "io/results/read_info.hpp"

namespace brio {

void report(const ReportOptions& options) {
  const std::filesystem::path page = page_of(options);
  replace_text_file(page, {read_apart(result_file(options.result), [&] { return report_page(options); })});
  write_out("{}\n", page.string());
}

}  // namespace brio
