// Who may include whom, and where printing, threads and file formats may appear.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace brio {
namespace {

namespace fs = std::filesystem;

const fs::path root = BRIO_SOURCE_DIR;

struct SourceFile {
  std::string path;  ///< from the root of the project
  std::string room;
  std::vector<std::string> lines;
};

std::string room_of(const std::string& path) {
  if (path.starts_with("src/base/")) return "src/base";
  return path.substr(0, path.find('/'));
}

std::vector<SourceFile> source_files() {
  std::vector<SourceFile> files;
  for (const char* folder : {"src", "materials", "elements", "contact", "io", "apps"}) {
    if (!fs::exists(root / folder)) continue;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      SourceFile file{fs::relative(entry.path(), root).generic_string(), "", {}};
      file.room = room_of(file.path);
      std::ifstream in(entry.path());
      for (std::string line; std::getline(in, line);) file.lines.push_back(line);
      files.push_back(std::move(file));
    }
  }
  return files;
}

TEST(Architecture, IncludesFollowTheArrows) {
  const std::map<std::string, std::set<std::string>> allowed{
      {"src/base", {"src/base"}},
      {"materials", {"materials", "src/base"}},
      {"elements", {"elements", "materials", "src/base"}},
      {"contact", {"contact", "src/base"}},
      {"src", {"src", "elements", "materials", "contact", "src/base"}},
      {"io", {"io", "src", "elements", "materials", "contact", "src/base"}},
      {"apps", {"apps", "io", "src", "elements", "materials", "contact", "src/base"}},
  };
  const std::regex include(R"re(^\s*#include "([^"]+)")re");
  std::size_t seen = 0;
  for (const SourceFile& file : source_files()) {
    for (const std::string& line : file.lines) {
      std::smatch match;
      if (!std::regex_search(line, match, include)) continue;
      ++seen;
      EXPECT_TRUE(fs::exists(root / match[1].str()))
          << file.path << " includes " << match[1] << ": not from the root";
      EXPECT_TRUE(allowed.at(file.room).contains(room_of(match[1])))
          << file.path << " must not include " << match[1];
    }
  }
  EXPECT_GT(seen, 20u);
}

// The rooms of a folder in order: each includes itself and those before it. The folder itself is a room "".
struct Rooms {
  std::string folder;
  std::vector<std::string> order;
  std::string elsewhere{};  ///< files that count as another room's
  std::string as_room{};
  std::string further{};  ///< room as which folders count that are not listed; empty: none may be
};

const std::vector<Rooms> rooms_of_folders{
    // What is asked of contact and what it finds are read everywhere.
    {"contact",
     {"geometry", "search", "surface", "ties", "features", "pairs", "detection", "enforcement", "", "start",
      "audit"},
     "contact/(options|pair)\\.hpp",
     "search"},
    // A block holds elements of any kind; the source of a kind compiles the sweep over its blocks. A further
    // kind is a further folder.
    {"elements",
     {"base", "solid", "shell", "beam", "particle", ""},
     "elements/[^/]+/.*\\.cpp",
     "",
     "particle"},
    {"src",
     {"deck", "domains", "motion", "sweep", "model", "fields", "initial", "build", "step", "output",
      "forecast"}},
    {"io",
     {"files", "yaml", "mesh_file", "mesh_format", "mesh", "deck", "schema", "results", "restart", "run",
      "study", "plot", "report"}},
};

std::ptrdiff_t place_of(const std::string& path, const Rooms& rooms) {
  const std::string parent = fs::path(path).parent_path().generic_string();
  std::string room = parent == rooms.folder ? "" : parent.substr(rooms.folder.size() + 1);
  if (std::regex_match(path, std::regex(rooms.elsewhere))) room = rooms.as_room;
  auto found = std::find(rooms.order.begin(), rooms.order.end(), room);
  if (found == rooms.order.end() && !rooms.further.empty())
    found = std::find(rooms.order.begin(), rooms.order.end(), rooms.further);
  EXPECT_NE(found, rooms.order.end()) << path << ": no room of that name";
  return found - rooms.order.begin();
}

TEST(Architecture, RoomsFollowTheirOrder) {
  const std::vector<SourceFile> files = source_files();
  for (const Rooms& rooms : rooms_of_folders) {
    const std::regex include("^#include \"(" + rooms.folder + "/[^\"]+)\"");
    std::size_t seen = 0;
    for (const SourceFile& file : files) {
      if (file.room != rooms.folder) continue;
      for (const std::string& line : file.lines) {
        std::smatch match;
        if (!std::regex_search(line, match, include) || room_of(match[1]) != rooms.folder) continue;
        ++seen;
        EXPECT_LE(place_of(match[1], rooms), place_of(file.path, rooms))
            << file.path << " must not include " << match[1];
      }
    }
    EXPECT_GT(seen, 20u) << rooms.folder;
  }
}

TEST(Architecture, NoFolderIsCrowded) {
  constexpr int most = 20;  // sources and headers beside each other
  std::map<std::string, int> count;
  for (const char* folder : {"src", "materials", "elements", "contact", "io", "apps", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".hpp")
        ++count[fs::relative(entry.path().parent_path(), root).generic_string()];
  for (const auto& [folder, files] : count) EXPECT_LE(files, most) << folder;
}

// A word may stand only in files whose path begins with one of the given places.
void expect_only_in(const std::string& what, const std::vector<std::string>& places) {
  const std::regex pattern(what);
  for (const SourceFile& file : source_files()) {
    bool is_allowed = false;
    for (const std::string& place : places) is_allowed = is_allowed || file.path.starts_with(place);
    if (is_allowed) continue;
    for (std::size_t i = 0; i < file.lines.size(); ++i)
      EXPECT_FALSE(std::regex_search(file.lines[i], pattern))
          << file.path << ":" << i + 1 << ": " << file.lines[i];
  }
}

TEST(Architecture, FileFormatsStayInIo) { expect_only_in(R"(#include <(yaml-cpp|hdf5|H5|netcdf))", {"io/"}); }

TEST(Architecture, FormulasStayInExpression) {
  expect_only_in(R"(#include <muParser)", {"src/deck/expression.cpp"});
}

TEST(Architecture, PrintingAndExitingStayInApps) {
  expect_only_in(R"(std::(cout|cerr|exit|abort|quick_exit)\b|[^sn]printf\(|fmt::print|std::puts)", {"apps/"});
}

TEST(Architecture, ThreadsStayInParallel) {
  // Asking how many processors there are is the command line's business.
  expect_only_in(R"(#include <thread>)", {"src/base/parallel", "apps/brio.cpp"});
  expect_only_in(
      R"(std::(thread|jthread|async)\b[^:]|#include <(mutex|condition_variable|omp\.h)>|#pragma omp)",
      {"src/base/parallel"});
}

TEST(Architecture, MessagesBetweenProcessesStayInRanks) {
  expect_only_in(R"(\bMPI_[A-Z]|#include <mpi\.h>)", {"apps/ranks"});
}

}  // namespace
}  // namespace brio
