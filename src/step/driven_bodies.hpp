#pragma once
/// Rigid bodies that prescribed motions drive into each other.

#include "src/model/model.hpp"

namespace brio {

/// After contact was resolved. \throws Breakdown where two rigid bodies of prescribed motion are driven
/// into each other
void expect_driven_bodies_apart(const Model& model, const ContactScene& scene);

}  // namespace brio
