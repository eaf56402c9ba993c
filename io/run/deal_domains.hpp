#pragma once
/// A scene that several processes compute together.

#include "src/domains/domain_exchange.hpp"
#include "src/model/model.hpp"

namespace brio {

/// Deals the domains of a model to ranks, before its first step. Where nothing but elements, supports and
/// loads acts on nodes, a rank goes on with the nodes of its domains alone; else with all. \param ranks
/// outlive the model
void deal_domains(Model& model, Ranks& ranks);

/// State of nodes and elements on all ranks, for what is written. Nothing to do alone.
void exchange_state(Model& model);

}  // namespace brio
