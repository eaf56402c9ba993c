#include <cstdio>
#include <string>

#include "apps/commands.hpp"
#include "io/file_error.hpp"
#include "io/write_schema.hpp"

namespace brio {

void print_schema(bool of_study, bool markdown) {
  std::string text;
  if (of_study) {
    text = markdown ? study_reference() : study_schema();
  } else {
    text = markdown ? deck_reference() : deck_schema();
  }
  if (std::fputs(text.c_str(), stdout) < 0 || std::fflush(stdout) != 0)
    throw FileError("standard output", "cannot be written");
}

}  // namespace brio
