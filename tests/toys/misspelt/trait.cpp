// Does not compile: no trait is called update_fiber.
#include "materials/material_law.hpp"

constexpr brio::MaterialTraits traits{.update = true, .update_fiber = true};
