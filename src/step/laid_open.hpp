#pragma once
/// Deletion of elements whose newly exposed faces cross others.

#include "src/model/model.hpp"

namespace brio {

/// Marks for deletion, as distorted, elements whose faces, exposed by the last deletion, cross others, if
/// elements of their part can be deleted; the next `erode` deletes them. \returns whether there are any
bool give_up_crossed(Model& model, ThreadTeam& team);

}  // namespace brio
