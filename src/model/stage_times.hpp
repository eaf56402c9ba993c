#pragma once
/// Wall time by stage of the step.

#include <array>
#include <chrono>
#include <string_view>

#include "src/base/index.hpp"

namespace brio {

enum class Stage {
  loads,
  elements,
  erosion,
  nodes,
  rigid,
  constraints,
  ties,
  contact_search,
  contact,
  audit,
  output
};
inline constexpr std::array<std::string_view, 11> stage_names{
    "loads", "elements",       "erosion", "nodes", "rigid", "constraints",
    "ties",  "contact_search", "contact", "audit", "output"};

struct StageTimes {
  std::array<double, stage_names.size()> seconds{};

  double& operator[](Stage stage) { return seconds[index(stage)]; }
  /// Saved and restored (src/base/state_archive.hpp).
  template <class Archive>
  void serialize(Archive& archive) {
    archive(seconds);
  }
  double operator[](Stage stage) const { return seconds[index(stage)]; }
};

/// Adds the time of its own life to a stage.
class StageTimer {
 public:
  StageTimer(StageTimes& times, Stage stage) : sum_(times[stage]) {}
  ~StageTimer() { sum_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  double& sum_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace brio
