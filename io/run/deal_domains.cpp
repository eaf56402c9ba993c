#include "io/run/deal_domains.hpp"

#include <algorithm>
#include <memory>
#include <variant>

#include "src/base/index.hpp"
#include "src/domains/node_ranges.hpp"

namespace brio {

namespace {

constexpr std::int64_t balanced_every = 200;  // steps
/// Largest load of a rank over the mean of all, from which on domains are dealt anew.
constexpr double largest_unbalance = 1.15;
/// By so much it must become less.
constexpr double worthwhile = 0.95;

bool is_gravity(const ActiveLoad& load) { return std::holds_alternative<GravityLoad>(load.load); }

// Whether a stage of the step goes through nodes wherever they are.
bool takes_all_nodes(const Model& model) {
  const auto follows_particles = [](const Block& block) { return block.cloud.has_value(); };
  return !model.contacts.empty() || model.erosion || model.added_mass || !model.ties.empty() ||
         !model.rigid.empty() || !model.springs.empty() || !model.walls.empty() || !model.damping.empty() ||
         model.forces || !model.rotations.empty() || model.control.settings.relaxation ||
         std::ranges::any_of(model.loads, is_gravity) || std::ranges::any_of(model.blocks, follows_particles);
}

// With sums over them: nodes of supports and loads. Ascending.
std::vector<int> summed_nodes(const Model& model) {
  std::vector<int> nodes;
  for (const PrescribedNodes& given : model.prescribed)
    nodes.insert(nodes.end(), given.nodes.begin(), given.nodes.end());
  for (const ActiveLoad& load : model.loads) {
    if (const auto* nodal = std::get_if<NodalLoad>(&load.load))
      nodes.insert(nodes.end(), nodal->nodes.begin(), nodal->nodes.end());
    if (const auto* pressure = std::get_if<PressureLoad>(&load.load))
      for (const std::array<int, 4>& side : pressure->sides)
        nodes.insert(nodes.end(), side.begin(), side.end());
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// Runs of nodes that this rank needs outside of the ranges of its domains.
std::vector<NodeRange> followed_nodes(const Model& model, const DomainExchange& exchange, const Ranks& ranks,
                                      const std::vector<int>& summed) {
  const std::vector<std::vector<int>> nodes = nodes_of_domains(model.schedule.pieces, model.blocks);
  std::vector<char> is_needed(model.nodes.size(), 0);
  for (const int node : summed) is_needed[index(node)] = 1;
  for (std::size_t d = 0; d < nodes.size(); ++d)
    if (exchange.is_own(d))
      for (const int node : nodes[d]) is_needed[index(node)] = 1;
  std::vector<NodeRange> runs;
  for (const NodeRange& range : model.nodes.ranges) {
    if (ranks.is_own(range.rank)) continue;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (is_needed[i] == 0) continue;
      if (!runs.empty() && runs.back().end == i && i > range.begin)
        ++runs.back().end;
      else
        runs.push_back({i, i + 1, range.domain, range.rank});
    }
  }
  return runs;
}

}  // namespace

void deal_domains(Model& model, Ranks& ranks, const std::vector<double>& cost) {
  const bool takes_all = takes_all_nodes(model);
  const std::vector<int> summed = takes_all ? std::vector<int>() : summed_nodes(model);
  auto exchange = std::make_shared<DomainExchange>(ranks, model.schedule, model.blocks,
                                                   takes_all ? nullptr : &summed, cost);
  if (!takes_all) {
    Nodes& nodes = model.nodes;
    for (NodeRange& range : nodes.ranges)
      range.rank = range.domain < 0 ? Ranks::everyone : exchange->rank_of_domain()[index(range.domain)];
    nodes.followed = followed_nodes(model, *exchange, ranks, summed);
    nodes.ranks = &ranks;
  }
  model.schedule.exchange = std::move(exchange);
}

void balance_load(Model& model) {
  const std::shared_ptr<DomainExchange> old = model.schedule.exchange;
  if (!old || model.step == 0 || model.step % balanced_every != 0) return;
  const std::vector<double> cost = old->measured_costs();
  const int ranks = old->ranks().count();
  const double now = unbalance(old->rank_of_domain(), cost, ranks);
  if (now < largest_unbalance) return;
  const std::vector<int> anew = deal(model.schedule, model.blocks, ranks, cost);
  if (!(unbalance(anew, cost, ranks) < worthwhile * now)) return;
  exchange_state(model, true);
  deal_domains(model, old->ranks(), cost);
  old->ranks().count_move();
}

bool is_on_any_rank(bool here, const Model& model) {
  DomainExchange* exchange = model.schedule.exchange.get();
  return exchange == nullptr ? here : exchange->ranks().largest(here ? 1 : 0) != 0;
}

void exchange_state(Model& model, bool to_all) {
  DomainExchange* exchange = model.schedule.exchange.get();
  if (exchange == nullptr) return;
  exchange->exchange_elements(model.schedule, model.blocks, to_all);
  exchange_nodes(model.nodes);
  if (model.nodes.ranks == nullptr || model.assembled_step.reference.empty()) return;
  for (const NodeRange& range : model.nodes.ranges)
    model.nodes.ranks->note(range.rank, &model.assembled_step.reference[range.begin],
                            range.end - range.begin);
  model.nodes.ranks->share(Ranks::Kind::state);
}

}  // namespace brio
