#!/usr/bin/env bash
# Installs what is missing, builds Brio and runs its tests; the fast ones a second time under sanitizers.
# Usage: tests/run.sh [--fast]       --fast leaves out the slow tests and the sanitizers
set -euo pipefail
cd "$(dirname "$0")/.."

.ci/install.sh test
jobs=$(nproc)
generator=()
[ -f build/release/CMakeCache.txt ] || generator=(-G Ninja)
cmake --preset release "${generator[@]}" -DBRIO_TESTS=ON -DBRIO_BENCH=ON
cmake --build --preset release -j "$jobs"
if [ "${1:-}" = --fast ]; then
  exec ctest --test-dir build/release --output-on-failure -j "$jobs" -L fast
fi
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run -Werror

generator=()
[ -f build/debug-sanitized/CMakeCache.txt ] || generator=(-G Ninja)
cmake --preset debug-sanitized "${generator[@]}" -DBRIO_TESTS=ON -DBRIO_BENCH=OFF
cmake --build --preset debug-sanitized -j "$jobs"
ctest --test-dir build/debug-sanitized --output-on-failure -j "$jobs" -L fast

ctest --test-dir build/release --output-on-failure -j "$jobs"
