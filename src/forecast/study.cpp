#include "src/forecast/study.hpp"

#include <algorithm>
#include <stdexcept>

namespace brio {

namespace {

const Settings* find_setting(const Study& study, std::string_view name) {
  for (const auto& [knob, settings] : study.knobs)
    for (const auto& [label, setting] : settings)
      if (name == knob + "." + label) return &setting;
  return nullptr;
}

bool is_of_physics(const Study& study, std::string_view setting) {
  return std::any_of(study.physics.begin(), study.physics.end(),
                     [&](const std::string& knob) { return setting.substr(0, setting.find('.')) == knob; });
}

StudyRun combination(const Study& study, const std::vector<std::string>& names) {
  StudyRun run{.name = "", .knob = "", .label = "", .overrides = study.set.overrides};
  for (const std::string& name : names) {
    const Settings* setting = find_setting(study, name);
    if (setting == nullptr)
      throw std::invalid_argument("'" + name + "' is not among the knobs; KNOB.SETTING is expected");
    run.name += (run.name.empty() ? "" : "+") + name;
    run.overrides.insert(run.overrides.end(), setting->overrides.begin(), setting->overrides.end());
    run.is_another_problem = run.is_another_problem || is_of_physics(study, name);
  }
  run.label = run.name;
  return run;
}

}  // namespace

std::vector<StudyRun> runs_of(const Study& study) {
  std::vector<StudyRun> runs{
      {std::string(default_run), "", std::string(default_run), study.set.overrides, false}};
  for (const auto& [knob, settings] : study.knobs)
    for (const auto& [label, setting] : settings) {
      StudyRun& run = runs.emplace_back(combination(study, {knob + "." + label}));
      run.knob = knob;
      run.label = label;
    }
  for (const std::vector<std::string>& names : study.combinations) runs.push_back(combination(study, names));
  return runs;
}

std::optional<std::size_t> reference_run(const Study& study, const std::vector<StudyRun>& runs) {
  if (study.reference.empty()) return {};
  for (std::size_t i = 0; i < runs.size(); ++i)
    if (runs[i].name == study.reference) return i;
  throw std::invalid_argument(
      "no run is called '" + study.reference +
      "'; accepted: default, KNOB.SETTING, or a combination as its settings joined by +");
}

}  // namespace brio
