#include "apps/commands.hpp"
#include "apps/streams.hpp"
#include "io/schema/write_schema.hpp"

namespace brio {

void print_schema(bool of_study, bool of_results, bool markdown) {
  if (of_results) {
    write_out_text(results_reference());
  } else if (of_study) {
    write_out_text(markdown ? study_reference() : study_schema());
  } else {
    write_out_text(markdown ? deck_reference() : deck_schema());
  }
}

}  // namespace brio
