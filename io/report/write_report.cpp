#include "io/report/write_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "io/files/file_error.hpp"
#include "io/files/utf8.hpp"
#include "io/report/deck_labels.hpp"
#include "io/report/page_texts.hpp"
#include "io/report/scene_data.hpp"
#include "io/report/surface.hpp"
#include "io/results/read_info.hpp"

namespace brio {

namespace {

using nlohmann::json;

json summary_of(const ResultInfo& info) {
  return info.status.empty() ? json(nullptr) : read_summary(info.file);
}

json head_of(const ResultInfo& info) {
  return {{"title", info.title},         {"deck_path", info.deck_path},
          {"deck_text", info.deck_text}, {"overrides", info.overrides},
          {"version", info.version},     {"units", units_of_deck(info.deck_text)},
          {"summary", summary_of(info)}};
}

// An end of the element of the page in which it stands would be that everywhere, so there is none.
std::string text_in_page(const json& data) {
  std::string text;
  for (const char c : data.dump(-1, ' ', false, json::error_handler_t::replace)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

std::string data_elements(const json& head, const PageTables& tables) {
  std::string text = "<script type=\"application/json\" id=\"head\">" + text_in_page(head) + "</script>\n";
  for (const auto& [name, table] : tables)
    text += fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", name, table);
  return text;
}

std::string escaped(const std::string& words) {
  std::string text;
  for (const char c : as_utf8(words)) text += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return text;
}

}  // namespace

std::filesystem::path page_of(const ReportOptions& options) {
  if (!options.output.empty()) return options.output;
  std::filesystem::path page = options.result;
  if (!page.has_filename()) page = page.parent_path();  // of a folder with a slash behind it
  const std::filesystem::path ending = page.extension();
  if (ending == ".results" || ending == ".vtkhdf") page.replace_extension();
  page += ".html";
  return page;
}

std::string report_page(const ReportOptions& options) {
  const ResultInfo info = read_info(options.result);
  if (info.times.empty()) throw FileError(info.file, "the result holds no dump");
  PageTables tables;
  json head = head_of(info);
  head["scene"] = scene_data(info, thinned(info.times.size(), options.frames), options.fields, tables);
  head["history"] = history_data(ResultReader(info.file), most_history_rows, tables);
  std::string page(page_head);
  page +=
      fmt::format("<title>{}</title>\n<style>\n{}</style>\n{}", escaped(info.title), page_style, page_body);
  page += data_elements(head, tables) + "<script>\n\"use strict\";\n";
  for (int i = 0; i < page_scripts; ++i) page += page_script[i];
  return page + "</script>\n</body>\n</html>\n";
}

}  // namespace brio
