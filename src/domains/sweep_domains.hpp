#pragma once
/// The loop over all chunks of elements, with the sums of their domains.

#include <chrono>
#include <cstddef>

#include "src/base/index.hpp"
#include "src/domains/domain_exchange.hpp"
#include "src/domains/schedule.hpp"

namespace brio {

/// Run `of_task(t)` for every task, which adds to rows of its chunk's nodes; on several ranks for those of
/// the own domains, and rows of all nodes are exchanged. \param rows of force and moment, or of what is
/// summed like them
template <class OfTask>
void sweep_domains(SweepSchedule& schedule, const NodalRows& rows, ThreadTeam& team, OfTask&& of_task) {
  DomainExchange* exchange = schedule.exchange.get();
  if (exchange != nullptr) exchange->begin_rows(schedule, rows);
  for (std::size_t stage = 0; stage + 1 < schedule.stage_first.size(); ++stage) {
    for (std::size_t c = schedule.stage_first[stage]; c < schedule.stage_first[stage + 1]; ++c) {
      const std::size_t first = schedule.colour_first[c];
      team.for_each(schedule.colour_first[c + 1] - first, [&](std::size_t i) {
        if (exchange == nullptr) return of_task(first + i);
        if (!exchange->is_own(schedule.pieces[schedule.tasks[first + i].piece].domain)) return;
        const auto begin = std::chrono::steady_clock::now();
        of_task(first + i);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        exchange->note_seconds(first + i, taken.count());
      });
    }
    if (schedule.sums.empty()) continue;
    const std::size_t first = schedule.stage_domain_first[stage];
    team.for_each(schedule.stage_domain_first[stage + 1] - first, [&](std::size_t i) {
      const std::size_t domain = schedule.domain_of_stage[first + i];
      if (exchange == nullptr)
        add_sums(schedule.sums, domain, rows);
      else if (exchange->is_own(domain))
        keep_sums(schedule.sums, domain, rows);
    });
  }
  if (exchange == nullptr) return;
  exchange->exchange_rows(schedule, rows);
  if (!schedule.sums.empty()) finish_sums(schedule.sums, rows, team);
}

}  // namespace brio
