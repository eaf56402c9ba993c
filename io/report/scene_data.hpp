#pragma once
/// The scene of a report: what of a result can be seen, quantized, frame by frame.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>
#include <vector>

#include "io/report/report_fields.hpp"
#include "io/results/read_info.hpp"
#include "io/results/read_result.hpp"

namespace brio {

/// Tables of numbers under names, as base64.
using PageTables = std::vector<std::pair<std::string, std::string>>;

/// Reads a scene. The description gets
///   times       of the frames
///   dumps       number of dumps in the result
///   parts       of the deck (deck_labels.hpp)
///   nodes, cells, facets   counts of what can be seen
///   box         min and max of positions by axis, over all frames
///   fields      name, whether `points`, min, max, and `table` by name
/// and the tables
///   positions   16 bits: frame, node, axis, quantized in the box
///   facets      32 bits: four nodes and the cell of each facet
///   facet_life  16 bits: first frame of each facet, and the first without it
///   facet_kind  8 bits: 0 solid, 1 shell, 2 line, 3 vertex
///   cell_part   16 bits
///   cell_size   floats: thickness of a shell, radius of a beam or particle; 0 unknown
///   fieldN      16 bits: frame, node or cell; `no_value` where the cell is gone
/// \param frames dumps that are shown \param wanted names of fields; empty: report_fields' choice, without
/// what is zero in all of them \throws FileError also where indices in the file lead out of it
nlohmann::json scene_data(const ResultInfo& info, const std::vector<std::size_t>& frames,
                          const std::vector<std::string>& wanted, PageTables& tables);

/// Names of columns, number of rows, and the table `history`: floats, column after column. At most `limit`
/// rows, at equal distances of row, and the last.
nlohmann::json history_data(const ResultReader& reader, std::size_t limit, PageTables& tables);

}  // namespace brio
