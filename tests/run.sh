#!/usr/bin/env bash
# Installs what is missing, builds Brio and runs its tests; the fast ones a second time under the address and
# undefined-behaviour sanitizers.
# Usage: tests/run.sh [--fast]       --fast leaves out the slow tests and the sanitizers
set -euo pipefail
cd "$(dirname "$0")/.."

stage() { echo; printf '== %s (after %d min %02d s)\n' "$1" $((SECONDS / 60)) $((SECONDS % 60)); }
jobs=$(nproc)
# build PRESET BENCH
build() {
  local generator=()
  [ -f "build/$1/CMakeCache.txt" ] || generator=(-G Ninja)
  cmake --preset "$1" "${generator[@]}" -DBRIO_TESTS=ON -DBRIO_BENCH="$2"
  cmake --build --preset "$1" -j "$jobs"
}

stage "install"
.ci/install.sh test
stage "build"
build release ON
if [ "${1:-}" = --fast ]; then
  stage "fast tests"
  exec ctest --test-dir build/release --output-on-failure -j "$jobs" -L fast
fi
stage "format"
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run -Werror
stage "all tests"
ctest --test-dir build/release --output-on-failure -j "$jobs"
stage "build with sanitizers"
build debug-sanitized OFF
stage "fast tests with sanitizers"
ctest --test-dir build/debug-sanitized --output-on-failure -j "$jobs" -L fast
stage "done"
