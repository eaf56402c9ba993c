// What a scene is expected to take is near what its run takes: neither a scene that fits is refused nor one
// that does not fit is begun.

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/deck/read_deck.hpp"
#include "io/run/scene_size.hpp"
#include "tests/system/program.hpp"

namespace brio {
namespace {

#if !defined(__SANITIZE_ADDRESS__)  // which keeps what was freed

class MemoryOfScenes : public test::Program {
 protected:
  static std::string deck_of(const std::string& part, const std::string& more) {
    return "materials: {m: {model: elastic, density: 1000, youngs_modulus: 1e9, poissons_ratio: "
           "0.3}}\nparts: {p: " +
           part + "}\ntime: {end: 2e-9, step: 1e-9}\n" + more;
  }
  double peak_mb_of_run(const std::string& text) const {
    write("deck.yaml", text);
    const pid_t child = fork();
    if (child == 0) {
      std::filesystem::current_path(folder_);
      execl(BRIO_PROGRAM, BRIO_PROGRAM, "run", "deck.yaml", "--quiet", "--threads", "1", nullptr);
      _exit(99);
    }
    int status = 0;
    rusage usage{};
    wait4(child, &status, 0, &usage);
    EXPECT_EQ(status, 0);
    return static_cast<double>(usage.ru_maxrss) / 1024;
  }
};

TEST_F(MemoryOfScenes, ArePredictedWithinAThird) {
  const std::string brick = "{mesh: {box: {size: [1, 1, 1], elements: [50, 50, 50]}}, material: m, element: ";
  const std::string plate = "{mesh: {plate: {size: [1, 1], elements: [250, 250]}}, material: m, element: ";
  const std::string particles =
      "{mesh: {particles: {box: {size: [1, 1, 1], spacing: 0.03}}}, material: m, element: ";
  const std::string contact = "contact: {surfaces: all}\n";
  const std::vector<std::pair<std::string, std::string>> scenes{
      {brick + "hex8}", ""},
      {brick + "hex8}", contact},
      {brick + "hex8_full}", ""},
      {brick + "rigid}", contact},
      {"{mesh: {box: {size: [10, 10, 0.1], elements: [150, 150, 2]}}, material: m, element: hex8}", contact},
      {plate + "{type: shell4, thickness: 0.001}}", ""},
      {plate + "{type: shell4, thickness: 0.001}}", contact},
      {"{mesh: {line: {start: [0, 0, 0], end: [100, 0, 0], elements: 50000}}, material: m, element: {type: "
       "beam2, "
       "section: {circle: {radius: 1e-4}}}}",
       ""},
      {particles + "particle}", ""},
      {particles + "{type: particle, kernel: eulerian}}", ""}};
  const double empty = peak_mb_of_run(
      deck_of("{mesh: {box: {size: [1, 1, 1], elements: [1, 1, 1]}}, material: m, element: hex8}", ""));
  for (const auto& [part, more] : scenes) {
    const std::string text = deck_of(part, more);
    const double predicted = memory_of_scene_mb(parse_deck(text, "a.yaml"));
    const double taken = peak_mb_of_run(text) - empty;
    std::printf("predicted %.0f MB, taken %.0f MB: %s%s\n", predicted, taken, part.c_str(), more.c_str());
    EXPECT_GT(predicted, taken / 1.5) << text;
    EXPECT_LT(predicted, taken * 1.5) << text;
  }
}

#endif

}  // namespace
}  // namespace brio
