// A bar of two bricks, held at one end and pushed at the other: what energy it begins with, and how much is
// left.

#include <cmath>
#include <cstdio>

#include "io/run/run_deck.hpp"

int main(int, char** arguments) {
  brio::RunOptions options;
  options.deck = arguments[1];
  const brio::Summary summary = brio::run_deck(options).summary;
  const double given = 0.5 * (1000 * 0.1 * 0.1 * 0.5 / 2);  // half the mass of the second brick at velocity 1
  const brio::Summary::Energies& energy = summary.energy;
  const double left = energy.kinetic + energy.internal + energy.viscous + energy.hourglass;
  std::printf("%s, step %ld: energy %.9g of %.9g\n", summary.status.c_str(), static_cast<long>(summary.steps),
              left, given);
  return summary.exit_code == 0 && energy.internal > 0.01 * given && std::abs(left - given) < 1e-3 * given
             ? 0
             : 1;
}
