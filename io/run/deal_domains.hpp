#pragma once
/// A scene that several processes compute together.

#include "src/domains/domain_exchange.hpp"
#include "src/model/model.hpp"

namespace brio {

/// Deals the domains of a model to ranks, before its first step. Where nothing but elements, supports and
/// loads acts on nodes, a rank goes on with the nodes of its domains alone; else with all. \param ranks
/// outlive the model
/// \param cost of each domain; empty: by its elements
void deal_domains(Model& model, Ranks& ranks, const std::vector<double>& cost = {});

/// Between two steps, now and then: deals the domains anew where the measured load of the ranks is off.
/// Results do not depend on it.
void balance_load(Model& model);

/// State of nodes, and of elements to all ranks or to the first, which writes. Nothing to do alone.
void exchange_state(Model& model, bool to_all = false);

/// Whether something is so on any rank.
bool is_on_any_rank(bool here, const Model& model);

}  // namespace brio
