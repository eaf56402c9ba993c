// `brio study` among faults: members that are broken, studies that are killed or meet, text that would be a
// command.

#include <signal.h>

#include <chrono>
#include <functional>
#include <thread>

#include "src/base/index.hpp"
#include "tests/system/bar_deck.hpp"
#include "tests/system/program.hpp"

namespace brio {
namespace {

namespace fs = std::filesystem;

const std::string length_study = R"(
deck: bar.yaml
reference: mesh.fine
quantities:
  length: {field: position, component: x, part: bar, take: range, time: 1e-3}
knobs:
  mesh:
    coarse: {"parts.bar.mesh.box.elements": [10, 1, 1]}
    fine: {"parts.bar.mesh.box.elements": [40, 1, 1]}
)";

class ProgramStudyFaults : public test::Program {
 protected:
  // Starts `brio ARGUMENTS`, by words.
  pid_t start(const std::vector<std::string>& arguments) const {
    const pid_t child = fork();
    if (child != 0) return child;
    fs::current_path(folder_);
    if (freopen("started.txt", "w", stderr) == nullptr || freopen("/dev/null", "w", stdout) == nullptr)
      _exit(98);
    std::vector<std::string> words = arguments;
    std::vector<char*> pointers;
    std::string program = BRIO_PROGRAM;
    pointers.push_back(program.data());
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    execv(BRIO_PROGRAM, pointers.data());
    _exit(99);
  }
  // Long enough to be met.
  void write_long_study() const {
    write("bar.yaml", test::bar_deck);
    write("long.yaml", length_study +
                           "    finest: {\"parts.bar.mesh.box.elements\": [41, 1, 1]}\n"
                           "set: {time.end: 1e6, output.fields.every: 1e3, output.history.every: 1e3}\n");
  }
  static bool waited_for(const std::function<bool()>& event) {
    for (int i = 0; i < 1000 && !event(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return event();
  }
  bool long_run_has_begun() const { return fs::exists(folder_ / "long.study/runs/mesh.fine/bar.vtkhdf"); }
  // Processes other than this one that name the folder in their command line.
  int processes() const {
    int count = 0;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      std::ostringstream line;
      line << std::ifstream(entry.path() / "cmdline").rdbuf();
      if (line.str().find("long.study/runs") != std::string::npos &&
          fs::read_symlink(entry.path() / "cwd") == folder_)
        ++count;
    }
    return count;
  }
};

// What a later call builds upon must be as it was written: each way to break one member has it run again,
// alone.
TEST_F(ProgramStudyFaults, MemberThatIsBrokenIsRunAgain) {
  write("bar.yaml", test::bar_deck);
  write("bars.yaml", length_study);
  ASSERT_EQ(brio("study bars.yaml").exit_code, 0);
  const std::string member = "bars.study/runs/mesh.coarse/";
  const std::string record = read(member + "run.json");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = record;
    return text.replace(text.find(from), from.size(), to);
  };
  const auto swap_byte = [&](double share) {
    std::string bytes = read(member + "bar.vtkhdf");
    bytes[static_cast<std::size_t>(share * static_cast<double>(bytes.size()))] ^= 0x55;
    write(member + "bar.vtkhdf", bytes);
  };
  const std::vector<std::pair<const char*, std::function<void()>>> faults{
      {"record of no JSON", [&] { write(member + "run.json", "{\"key\""); }},
      {"record of another type", [&] { write(member + "run.json", "[1, 2]"); }},
      {"text for a number",
       [&] { write(member + "run.json", with("\"exit_code\": 0", "\"exit_code\": \"0\"")); }},
      {"null for a number",
       [&] { write(member + "run.json", with("\"wall_s\": ", "\"wall_s\": null, \"x\": ")); }},
      {"number for text", [&] { write(member + "run.json", with("\"key\": \"", "\"key\": 1, \"x\": \"")); }},
      {"exit code that is not remembered",
       [&] { write(member + "run.json", with("\"exit_code\": 0", "\"exit_code\": 139")); }},
      {"no record", [&] { fs::remove(folder_ / member / "run.json"); }},
      {"record that is a folder",
       [&] {
         fs::remove(folder_ / member / "run.json");
         fs::create_directories(folder_ / member / "was.json");
       }},
      {"no result", [&] { fs::remove(folder_ / member / "bar.vtkhdf"); }},
      {"empty result", [&] { write(member + "bar.vtkhdf", ""); }},
      {"result cut short", [&] { fs::resize_file(folder_ / member / "bar.vtkhdf", 30000); }},
      {"signature changed", [&] { swap_byte(0); }},
      {"no summary", [&] { fs::remove(folder_ / member / "bar.summary.json"); }},
      {"summary of no JSON", [&] { write(member + "bar.summary.json", "{"); }},
      {"summary of another type", [&] { write(member + "bar.summary.json", "{\"status\": 1}"); }},
      {"run that did not finish",
       [&] {
         std::string text = read(member + "bar.summary.json");
         write(member + "bar.summary.json", text.replace(text.find("finished"), 8, "failed"));
       }},
      {"no history", [&] { fs::remove(folder_ / member / "bar.history.csv"); }},
      {"result of another run",
       [&] {
         for (const char* file : {"bar.vtkhdf", "bar.summary.json"})
           fs::copy_file(folder_ / "bars.study/runs/mesh.fine" / file, folder_ / member / file,
                         fs::copy_options::overwrite_existing);
       }},
  };
  for (const auto& [name, damage] : faults) {
    SCOPED_TRACE(name);
    damage();
    const Ending ending = brio("study bars.yaml --quiet");
    EXPECT_EQ(ending.exit_code, 0) << ending.faults;
    EXPECT_EQ(brio("info " + member + " --verify").exit_code, 0);
    EXPECT_NE(read(member + "run.json").find("\"exit_code\": 0"), std::string::npos);
    const Ending again = brio("study bars.yaml");
    EXPECT_EQ(again.faults, "") << "all is good, nothing is run";
  }
}

TEST_F(ProgramStudyFaults, SecondStudyInAFolderIsRefusedAndNamesTheFirst) {
  write_long_study();
  const pid_t first = start({"study", "long.yaml", "--jobs", "1"});
  ASSERT_TRUE(waited_for([&] { return long_run_has_begun(); }));
  const Ending second = brio("study long.yaml");
  EXPECT_EQ(second.exit_code, 4);
  EXPECT_NE(second.faults.find("process " + std::to_string(first) + " on "), std::string::npos)
      << second.faults;
  const Ending member = brio("run bar.yaml --output long.study/runs/mesh.fine");
  EXPECT_EQ(member.exit_code, 4);
  EXPECT_NE(member.faults.find("another process of brio writes in this folder: process "), std::string::npos)
      << member.faults;
  kill(first, SIGTERM);
  waitpid(first, nullptr, 0);
}

TEST_F(ProgramStudyFaults, RunsEndWithAStudyThatIsKilledAndTheNextGoesOn) {
  write_long_study();
  for (const int jobs : {1, 2}) {
    const pid_t first = start({"study", "long.yaml", "--jobs", std::to_string(jobs)});
    // The file may exist before its first dump is in it.
    ASSERT_TRUE(waited_for([&] {
      return long_run_has_begun() && processes() == jobs &&
             brio("info long.study/runs/mesh.fine --verify").exit_code == 0;
    })) << jobs;
    kill(first, SIGKILL);
    waitpid(first, nullptr, 0);
    EXPECT_TRUE(waited_for([&] { return processes() == 0; }));
    EXPECT_EQ(brio("info long.study/runs/mesh.fine --verify").exit_code, 0);
  }
  // The folder is free at once, also while runs of the killed study are still ending.
  write("long.yaml", length_study);
  EXPECT_EQ(brio("study long.yaml").exit_code, 0);
}

TEST_F(ProgramStudyFaults, RunsCloseTheirResultsWhenTheStudyIsStopped) {
  write_long_study();
  for (const int signal : {SIGTERM, SIGINT}) {
    const pid_t first = start({"study", "long.yaml", "--jobs", "2"});
    ASSERT_TRUE(waited_for([&] { return long_run_has_begun() && processes() == 2; }));
    kill(first, signal);
    int status = 0;
    waitpid(first, &status, 0);
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 128 + signal);
    EXPECT_EQ(processes(), 0);
    EXPECT_NE(read("long.study/runs/mesh.fine/bar.summary.json").find("terminated"), std::string::npos);
    fs::remove_all(folder_ / "long.study");
  }
}

// Backquotes, quotes, lines and pipes: wherever gnuplot would run a command.
TEST_F(ProgramStudyFaults, NoTextOfAStudyIsRun) {
  write("bar.yaml", test::bar_deck);
  const std::vector<std::string> titles{
      "'a `touch run_by_title` b'",
      "\"a\\nsystem('touch run_by_title')\\nb\"",
      "\"'; system 'touch run_by_title'; '\"",
      "'\" . system(\"touch run_by_title\") . \"'",
      "'$(touch run_by_title) @x `touch run_by_title`'",
  };
  for (const std::string& title : titles) {
    write("bars.yaml", length_study + "title: " + title + "\n");
    const Ending ending = brio("study bars.yaml --quiet");
    EXPECT_EQ(ending.exit_code, 0) << ending.faults;
    EXPECT_GT(read("bars.study/bars.front.svg").size(), 500u) << read("bars.study/gnuplot.txt");
  }
  for (const char* name : {"|touch run_by_name;", "`touch run_by_name`", "-e", "$(touch run_by_name)",
                           "';system(\"touch run_by_name\");'"}) {
    write(std::string(name) + ".yaml", length_study);
    const std::string quoted = "./" + std::string(name) + ".yaml";
    std::string words = "'";
    for (const char c : quoted) words += c == '\'' ? std::string("'\\''") : std::string(1, c);
    const Ending ending = brio("study " + words + "' --output named.study --quiet");
    EXPECT_EQ(ending.exit_code, 0) << name << ending.faults;
    EXPECT_GT(read("named.study/" + std::string(name) + ".front.svg").size(), 500u)
        << name << read("named.study/gnuplot.txt");
  }
  for (const auto& entry : fs::recursive_directory_iterator(folder_))
    EXPECT_FALSE(entry.path().filename().string().starts_with("run_by")) << entry.path();
}

TEST_F(ProgramStudyFaults, NamesThatAreNoTextAreRefusedWithTheirPlace) {
  write("caf\xe9.yaml", test::bar_deck);
  const pid_t child = fork();
  if (child == 0) {
    fs::current_path(folder_);
    if (freopen("faults.txt", "w", stderr) == nullptr) _exit(98);
    execl(BRIO_PROGRAM, BRIO_PROGRAM, "run", "caf\xe9.yaml", nullptr);
    _exit(99);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 2);
  EXPECT_NE(read("faults.txt").find("the name of the file is not UTF-8"), std::string::npos)
      << read("faults.txt");
  for (const char* title : {"\"\\x1b]0;x\\a\"", "\"\\0\"", "\"\\u009b2J\"", "\"\\uFFFE\""}) {
    write("bar.yaml", test::bar_deck + "title: " + title + "\n");
    const Ending ending = brio("run bar.yaml");
    EXPECT_EQ(ending.exit_code, 2) << title;
    EXPECT_NE(ending.faults.find("bar.yaml:10:8: the text holds a control character"), std::string::npos)
        << ending.faults;
  }
  write("bar.yaml", test::bar_deck + "title: \xed\xa0\x80\n");  // a surrogate, which is no character
  EXPECT_EQ(brio("run bar.yaml").exit_code, 2);
  write("bar.yaml", test::bar_deck + "title: \xc0\xaf\n");  // longer than need be
  EXPECT_EQ(brio("run bar.yaml").exit_code, 2);
}

}  // namespace
}  // namespace brio
