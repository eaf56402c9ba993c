#pragma once
/// The page without its data: files of io/report/page, taken into the program when it is built
/// (cmake/embed_page.cmake).

#include <string_view>

namespace brio {

extern const std::string_view page_head;   ///< up to the style
extern const std::string_view page_style;  ///< CSS
extern const std::string_view page_body;   ///< up to the data
extern const std::string_view page_script[];
extern const int page_scripts;  ///< files of the script, in the order in which they stand

}  // namespace brio
