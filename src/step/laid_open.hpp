#pragma once
/// Deletion of what a deletion lays open and cannot be kept apart.

#include "src/model/model.hpp"

namespace brio {

/// Give up, as distorted, elements that cross others now that the last deletion has laid them open, where
/// their part can lose elements: they are what the next `erode` deletes. \returns whether there are any
bool give_up_crossed(Model& model, ThreadTeam& team);

}  // namespace brio
