#!/usr/bin/env bash
# Installs what is missing, builds Brio and runs its tests; the fast ones a second time under the address and
# undefined-behaviour sanitizers. Builds the program with clang and runs a deck with it.
# Usage: tests/run.sh [--fast | --long]       --fast leaves out the slow tests, the sanitizers and clang; --long adds the
# tests that take minutes each
set -euo pipefail
cd "$(dirname "$0")/.."

stage() { echo; printf '== %s (after %d min %02d s)\n' "$1" $((SECONDS / 60)) $((SECONDS % 60)); }
jobs=$(nproc)
# build PRESET [CMAKE-OPTION]...
build() {
  local generator=()
  [ -f "build/$1/CMakeCache.txt" ] || generator=(-G Ninja)
  cmake --preset "$1" "${generator[@]}" "${@:2}"
  cmake --build --preset "$1" -j "$jobs"
}

stage "install"
.ci/install.sh test
if [ "${1:-}" != --fast ]; then
  stage "format"
  git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run -Werror
fi
stage "build"
build release -DBRIO_TESTS=ON -DBRIO_BENCH=ON
if [ "${1:-}" = --fast ]; then
  stage "fast tests"
  exec ctest --test-dir build/release --output-on-failure -j "$jobs" -L fast
fi
stage "build with clang"
build clang
build/clang/brio run inputs/bar_impact.yaml --quiet --overwrite --output build/clang/bar_impact.results
stage "all tests"
without=(-LE long)
if [ "${1:-}" = --long ]; then without=(); fi
ctest --test-dir build/release --output-on-failure -j "$jobs" "${without[@]}"
stage "build with sanitizers"
build debug-sanitized -DBRIO_TESTS=ON -DBRIO_BENCH=OFF
stage "fast tests with sanitizers"
ctest --test-dir build/debug-sanitized --output-on-failure -j "$jobs" -L fast
stage "done"
