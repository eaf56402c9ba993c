#include <nlohmann/json.hpp>

#include "io/run/check_deck.hpp"

namespace brio {
namespace {

using Json = nlohmann::ordered_json;

Json parts(const CheckReport& report) {
  Json list = Json::array();
  for (const PartReport& part : report.parts)
    list.push_back({{"name", part.name},
                    {"element", part.element},
                    {"material", part.material},
                    {"elements", part.elements},
                    {"nodes", part.nodes},
                    {"mass", part.mass},
                    {"quality",
                     {{"aspect_max", part.quality.aspect},
                      {"warp_max_degrees", part.quality.warp},
                      {"scaled_jacobian_min", part.quality.jacobian},
                      {"stable_step_min", part.quality.step},
                      {"degenerate_elements", part.quality.degenerate}}}});
  return list;
}

Json joints(const CheckReport& report) {
  Json merged = Json::array(), tied = Json::array();
  for (const MergedParts& entry : report.merged)
    merged.push_back({{"first", entry.first},
                      {"second", entry.second},
                      {"nodes", entry.nodes},
                      {"farthest", entry.farthest}});
  for (const TiedParts& entry : report.tied)
    tied.push_back({{"nodes", entry.nodes},
                    {"surface", entry.surface},
                    {"count", entry.count},
                    {"largest_gap", entry.largest_gap}});
  return {{"merged", merged}, {"tied", tied}};
}

Json springs(const CheckReport& report) {
  Json list = Json::array();
  for (const SpringSet& set : report.springs)
    list.push_back(
        {{"name", set.name}, {"pairs", set.count}, {"shortest", set.shortest}, {"longest", set.longest}});
  return list;
}

Json built(const CheckReport& report) {
  Json list = Json::array();
  for (const BuiltFeature& feature : report.built)
    list.push_back({{"name", feature.name},
                    {"because", feature.because},
                    {"detail", feature.detail},
                    {"memory_bytes", feature.bytes}});
  return list;
}

Json warnings(const CheckReport& report) {
  Json list = Json::array();
  for (const SceneWarning& warning : report.warnings)
    list.push_back({{"subject", warning.subject}, {"what", warning.what}, {"advice", warning.advice}});
  return list;
}

Json overlaps(const CheckReport& report) {
  Json list = Json::array();
  for (const InitialOverlap& overlap : report.initial_overlaps)
    list.push_back({{"node_part", overlap.node_part},
                    {"face_part", overlap.face_part},
                    {"nodes", overlap.nodes},
                    {"depth", overlap.depth},
                    {"gap", overlap.gap},
                    {"moved", overlap.moved}});
  return list;
}

Json forecast(const CheckReport& report) {
  const Forecast& forecast = report.forecast;
  const StepForecast& steps = forecast.steps;
  const OutputCost& output = forecast.output;
  return {{"threads", report.threads},
          {"timed_steps", forecast.timed_run.steps.size()},
          {"timed_time", forecast.timed_run.time},
          {"timed_seconds", forecast.timed_run.wall_seconds},
          {"breakdown", forecast.timed_run.breakdown},
          {"steps", steps.steps},
          {"steps_least", steps.least},
          {"steps_most", steps.most > 0 ? Json(steps.most) : Json()},
          {"steps_exact", steps.exact},
          {"coarse_runs", forecast.coarse_run_factors},
          {"coarse_run_fault", forecast.coarse_run_fault},
          {"wall_seconds", forecast.seconds()},
          {"wall_seconds_as_busy_as_now", forecast.seconds() * forecast.timed_run.waiting()},
          {"build_seconds", forecast.build_seconds},
          {"step_seconds", steps.seconds},
          {"output_seconds", output.seconds()},
          {"peak_memory_mb", forecast.peak_memory_mb},
          {"dumps", output.dumps},
          {"history_rows", output.rows},
          {"dump_bytes", output.dump_bytes},
          {"result_bytes", forecast.result_bytes},
          {"output_fault", forecast.output_fault},
          // Old names of five of them, for one version.
          {"marched_steps", forecast.timed_run.steps.size()},
          {"marched_time", forecast.timed_run.time},
          {"marched_seconds", forecast.timed_run.wall_seconds},
          {"pilots", forecast.coarse_run_factors},
          {"pilot_fault", forecast.coarse_run_fault}};
}

}  // namespace

std::string check_json(const CheckReport& report) {
  Json json{{"title", report.title},
            {"parts", parts(report)},
            {"nodes", report.nodes},
            {"mesh_notices", report.mesh_notices},
            {"connections", joints(report)},
            {"springs", springs(report)},
            {"initial_overlaps", overlaps(report)},
            {"step",
             {{"stable", report.stable_step},
              {"first", report.first_step},
              {"part", report.critical_part},
              {"element", report.critical_element}}},
            {"end_time", report.end},
            {"active_features", report.active_features},
            {"built", built(report)},
            {"not_built", report.not_built},
            {"warnings", warnings(report)},
            {"forecast", forecast(report)}};
  if (!report.critical_spring.empty()) json["step"]["spring"] = report.critical_spring;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace brio
