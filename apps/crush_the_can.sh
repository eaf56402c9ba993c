#!/usr/bin/env bash
# Installs what is missing, builds Brio and crushes the can of inputs/can_buckling.yaml.
# Usage: apps/crush_the_can.sh [further options of `brio run`]
set -euo pipefail
cd "$(dirname "$0")/.."

.ci/install.sh build
cmake --preset release -G Ninja -DBRIO_TESTS=OFF -DBRIO_BENCH=OFF
cmake --build --preset release --target brio
build/release/brio run inputs/can_buckling.yaml "$@"
cat <<'END'

To look at it: open can_buckling.results/can_buckling.vtkhdf in ParaView 5.12 or later, or
can_buckling.results/can_buckling.xdmf2 in ParaView 5.11 (Debian: apt-get install paraview), press Apply, then Play.
END
