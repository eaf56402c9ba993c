#!/usr/bin/env bash
# Installs what is missing, builds Brio with MPI and crushes the can of inputs/can_buckling.yaml by four processes.
# Usage: apps/crush_the_can_on_ranks.sh [further options of `brio run`]
set -euo pipefail
cd "$(dirname "$0")/.."

.ci/install.sh ranks
cmake --preset release -G Ninja -DBRIO_TESTS=OFF -DBRIO_BENCH=OFF -DBRIO_MPI=ON
cmake --build --preset release --target brio
[ "$(id -u)" != 0 ] || export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1  # in a container
mpirun --oversubscribe -n 4 build/release/brio run inputs/can_buckling.yaml "$@"
cat <<'END'

The result has the bits of one process. To look at it: open can_buckling.results/can_buckling.vtkhdf in ParaView 5.12 or
later, or can_buckling.results/can_buckling.xdmf2 in ParaView 5.11 (Debian: apt-get install paraview), press Apply, then Play.
END
