#include <algorithm>
#include <array>
#include <set>

#include "src/base/index.hpp"
#include "src/output/observe.hpp"
#include "src/output/result_order.hpp"

namespace brio {

std::vector<std::string> active_features(const Model& model) {
  std::set<std::string> features;
  for (const Block& block : model.blocks) {
    features.insert(std::string(name_of(block.element)));
    if (std::holds_alternative<Rigid>(block.element)) continue;
    features.insert(std::string(name_of(block.material)));
    if (block.precision == Precision::single_precision) features.insert("float");
  }
  for (const ActiveLoad& load : model.loads)
    features.insert(load.is_moment() ? "nodal_moment"
                                     : std::array{"gravity", "nodal_force", "pressure"}[load.load.index()]);
  if (!model.merged.empty()) features.insert("merged_nodes");
  if (!model.ties.found.empty()) features.insert("ties");
  if (!model.springs.empty()) features.insert("springs");
  if (!model.prescribed.empty()) features.insert("prescribed_motion");
  if (!model.walls.empty()) features.insert("rigid_wall");
  if (!model.contacts.empty()) features.insert("contact");
  if (can_be_damaged(model)) features.insert("failure");
  if (model.erosion) features.insert("deletion");
  if (model.added_mass) features.insert("mass_scaling");
  return {features.begin(), features.end()};
}

namespace {

Summary::DeepestContact described(const AuditPlace& place, double time, const Model& model) {
  const std::vector<std::string>& name = model.contacts.front().surface.part_name;
  const auto part = [&](int number) { return number < 0 ? "" : name[index(number)]; };
  return {.depth = place.depth,
          .time = time,
          .node = points_of_nodes(model)[index(place.node)],
          .parts = {part(place.part[0]), part(place.part[1])}};
}

Summary::ContactAudits summary_of(const ContactAudits& audits, const Model& model) {
  const Audit& found = audits.found;
  Summary::ContactAudits summary{.audited_dumps = audits.dumps,
                                 .crossed_dumps = audits.crossed_dumps,
                                 .crossings = found.crossings,
                                 .deep_crossings = found.deep_crossings,
                                 .too_close = found.too_close,
                                 .swallowed = found.swallowed,
                                 .deepest_crossing = {},
                                 .deepest_too_close = {}};
  if (found.deepest_crossing.node >= 0)
    summary.deepest_crossing = described(found.deepest_crossing, audits.time_of_deepest_crossing, model);
  if (found.deepest_too_close.node >= 0)
    summary.deepest_too_close = described(found.deepest_too_close, audits.time_of_deepest_too_close, model);
  return summary;
}

}  // namespace

Summary observe_end(Model& model) {
  balance_momentum(model, momentum(model.nodes));
  Summary summary;
  summary.steps = model.step;
  summary.time = model.times.time;
  summary.dt = {model.control.least, model.control.largest, model.times.previous};
  summary.nodes = static_cast<std::int64_t>(model.nodes.size());
  double rigid_mass = 0;
  for (const PartInModel& part : model.parts) {
    summary.mass.start += part.mass;
    if (part.rigid >= 0) {
      rigid_mass += model.rigid.body[index(part.rigid)].mass;  // with joined nodes
      continue;
    }
    const std::string_view kind = traits_of(model.blocks[part.block].element).summary_key;
    summary.elements[kind] += static_cast<std::int64_t>(part.element_slot.size());
    if (model.erosion) summary.deleted[kind] += model.erosion->deleted_count[part.block];
  }
  summary.mass.intact = summary.mass.start;
  if (model.added_mass) summary.mass.intact += model.added_mass->total();
  if (model.erosion) {
    const MassBalance balance = mass_balance(*model.erosion, model.nodes);
    summary.mass.intact = rigid_mass + balance.intact;
    summary.mass.debris = balance.debris;
    summary.mass.deleted = model.erosion->dropped_mass;
    summary.mass.of_deleted_elements = model.erosion->mass_of_deleted;
    summary.deleted_by_cause = model.erosion->deleted_by_cause;
  }
  const EnergyBalance& energy = model.energy;
  summary.energy = {.kinetic = energy.kinetic,
                    .internal = energy.internal,
                    .hourglass = energy.hourglass,
                    .viscous = energy.all_viscous(),
                    .contact = -energy.contact.at_step(),
                    .friction = -energy.friction.at_step(),
                    .external = energy.external.at_step(),
                    .deleted = energy.deleted,
                    .total_start = energy.kinetic_start,
                    .error_relative = energy.relative_error()};
  const std::size_t part = part_of_largest_ratio(model.part_energy);
  if (const double ratio = model.part_energy[part].largest_ratio; ratio > 0)
    summary.hourglass_ratio_max = {ratio, model.parts[part].name, model.part_energy[part].time_of_largest};
  summary.momentum = {model.momentum.now.linear, model.momentum.now.angular};
  for (const ContactScene& scene : model.contacts) {
    const SearchCounts& counts = scene.pairs.counts;
    const ContactTotals& totals = scene.totals;
    const std::uint64_t settled = scene.guard.certified + scene.guard.renewed;
    const std::uint64_t looks = settled + scene.guard.checked;
    const auto share = [](std::uint64_t count, std::uint64_t whole) {
      return whole > 0 ? static_cast<double>(count) / static_cast<double>(whole) : 0;
    };
    summary.contact = {.searches = static_cast<std::int64_t>(scene.pairs.searches()),
                       .comparisons = static_cast<std::int64_t>(counts.comparisons),
                       .candidate_pairs = static_cast<std::int64_t>(counts.candidate_pairs),
                       .active_max = totals.most_contacts,
                       .penetration_max = totals.deepest_overlap,
                       .missed = 0,
                       .audits = {},
                       .bodies = scene.surface.body_count,
                       .constraints_total = static_cast<std::int64_t>(totals.contacts),
                       .passes_mean = share(totals.passes, totals.steps),
                       .certified_share = share(settled, looks),
                       .last_resort_uses = static_cast<std::int64_t>(scene.zones),
                       .unresolved = static_cast<std::int64_t>(scene.unresolved.steps)};
  }
  if (model.contact_audits) {
    summary.contact.missed = model.contact_audits->found.missed();
    summary.contact.audits = summary_of(*model.contact_audits, model);
  }
  if (model.added_mass) {
    const AddedMass& mass = *model.added_mass;
    Summary::MassScaling& scaling = summary.mass_scaling.emplace(Summary::MassScaling{});
    scaling = {.added = mass.total(), .share = mass.share(), .parts = {}};
    for (std::size_t p = 0; p < model.parts.size(); ++p)
      if (mass.added[p] > 0) scaling.parts[model.parts[p].name] = mass.added[p];
  }
  if (!model.ties.found.empty()) {
    Summary::TieCounts& ties = summary.ties.emplace(Summary::TieCounts{});
    for (const TiedParts& found : model.ties.found) ties.nodes += found.count;
    ties.released = model.ties.released;
    ties.failed = model.ties.failed;
  }
  for (std::size_t stage = 0; stage < stage_names.size(); ++stage)
    if (model.stages.seconds[stage] > 0)
      summary.wall_s.by_stage[std::string(stage_names[stage])] = model.stages.seconds[stage];
  summary.active_features = active_features(model);
  return summary;
}

}  // namespace brio
