#include "io/results/write_summary.hpp"

#include <nlohmann/json.hpp>

#include "io/files/text_file.hpp"

namespace brio {
namespace {

using Json = nlohmann::ordered_json;

Json counts(const ElementCounts& elements) {
  Json counts;
  for (const auto& [key, count] : elements.by_key()) counts[std::string(key)] = count;
  return counts;
}

Json energies(const Summary::Energies& energy) {
  return {{"kinetic", energy.kinetic},         {"internal", energy.internal},
          {"hourglass", energy.hourglass},     {"viscous", energy.viscous},
          {"contact", energy.contact},         {"friction", energy.friction},
          {"external", energy.external},       {"deleted", energy.deleted},
          {"total_start", energy.total_start}, {"error_relative", energy.error_relative}};
}

Json by_cause(const CountByCause& count) {
  Json counts;
  for (std::size_t cause = 0; cause < count.size(); ++cause)
    counts[std::string(deletion_causes[cause])] = count[cause];
  return counts;
}

Json masses(const Summary::Masses& mass) {
  return {{"start", mass.start},
          {"intact", mass.intact},
          {"debris", mass.debris},
          {"deleted", mass.deleted},
          {"of_deleted_elements", mass.of_deleted_elements}};
}

Json deepest_contact(const Summary::DeepestContact& deepest) {
  return {{"depth", deepest.depth}, {"time", deepest.time}, {"node", deepest.node}, {"parts", deepest.parts}};
}

Json contact_counts(const Summary::ContactCounts& contact) {
  Json counts{{"searches", contact.searches},
              {"comparisons", contact.comparisons},
              {"candidate_pairs", contact.candidate_pairs},
              {"bodies", contact.bodies},
              {"constraints_total", contact.constraints_total},
              {"passes_mean", contact.passes_mean},
              {"certified_share", contact.certified_share},
              {"last_resort_uses", contact.last_resort_uses},
              {"unresolved", contact.unresolved},
              {"active_max", contact.active_max},
              {"penetration_max", contact.penetration_max},
              {"missed", contact.missed}};
  if (const auto& audits = contact.audits) {
    counts["audited_dumps"] = audits->audited_dumps;
    counts["crossed_dumps"] = audits->crossed_dumps;
    counts["deep_crossings"] = audits->deep_crossings;
    counts["too_close"] = audits->too_close;
    counts["swallowed"] = audits->swallowed;
    if (audits->deepest_crossing) counts["deepest_crossing"] = deepest_contact(*audits->deepest_crossing);
    if (audits->deepest_too_close) counts["deepest_too_close"] = deepest_contact(*audits->deepest_too_close);
  }
  return counts;
}

Json wall_times(const Summary::WallTimes& wall) {
  Json stages = Json::object();
  for (const auto& [stage, seconds] : wall.by_stage) stages[stage] = seconds;
  return {{"total", wall.total}, {"by_stage", stages}};
}

}  // namespace

std::string summary_json(const Summary& summary) {
  Json json{{"version", summary.version},
            {"deck", summary.deck},
            {"status", summary.status},
            {"exit_code", summary.exit_code},
            {"steps", summary.steps},
            {"time", summary.time},
            {"dt", {{"min", summary.dt.min}, {"max", summary.dt.max}, {"last", summary.dt.last}}},
            {"nodes", summary.nodes},
            {"elements", counts(summary.elements)},
            {"deleted", counts(summary.deleted)},
            {"deleted_by_cause", by_cause(summary.deleted_by_cause)},
            {"energy", energies(summary.energy)},
            {"hourglass_ratio_max",
             {{"value", summary.hourglass_ratio_max.value},
              {"part", summary.hourglass_ratio_max.part},
              {"time", summary.hourglass_ratio_max.time}}},
            {"mass", masses(summary.mass)},
            {"momentum", {{"linear", summary.momentum.linear}, {"angular", summary.momentum.angular}}},
            {"contact", contact_counts(summary.contact)},
            {"wall_s", wall_times(summary.wall_s)},
            {"element_updates_per_s", summary.element_updates_per_s},
            {"peak_memory_mb", summary.peak_memory_mb},
            {"threads", summary.threads},
            {"ranks", summary.ranks},
            {"active_features", summary.active_features},
            {"warnings", summary.warnings}};
  if (!summary.restarted_from.empty()) json["restarted_from"] = summary.restarted_from;
  if (summary.contact.audits) json["crossings"] = summary.contact.audits->crossings;
  if (summary.ties)
    json["ties"] = {{"nodes", summary.ties->nodes},
                    {"released", summary.ties->released},
                    {"failed", summary.ties->failed}};
  if (summary.mass_scaling)
    json["mass_scaling"] = {{"added", summary.mass_scaling->added},
                            {"share", summary.mass_scaling->share},
                            {"parts", summary.mass_scaling->parts}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void write_summary(const std::filesystem::path& path, const Summary& summary, bool sync) {
  replace_text_file(path, {summary_json(summary)}, sync);
}

}  // namespace brio
