#!/usr/bin/env bash
# Installs what is missing, builds Brio and runs its tests; the fast ones a second time under the address and
# undefined-behaviour sanitizers. Builds the program with clang and runs a deck with it.
# Usage: tests/run.sh [--fast | --long]       --fast leaves out the slow tests, the sanitizers and clang; --long adds the
# tests that take minutes each
# BRIO_TEST_MINUTES=N: where the time to build shows that a stage would not end within N minutes, it is left out, and said.
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
# fits STAGE PERCENT: whether a stage that takes that share of the time of the release build ends within the limit.
left_out=()
fits() {
  [ -n "${BRIO_TEST_MINUTES:-}" ] || return 0
  [ $((SECONDS + build_seconds * $2 / 100)) -le $((60 * BRIO_TEST_MINUTES)) ] && return 0
  left_out+=("$1")
  return 1
}
run_tests() { ctest --test-dir "build/$1" --output-on-failure -j "$jobs" "${@:2}"; }

stage "install"
.ci/install.sh test
if [ "${1:-}" != --fast ]; then
  stage "format"
  git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run -Werror
fi
stage "build"
build_begin=$SECONDS
build release -DBRIO_TESTS=ON -DBRIO_MPI=ON
build_seconds=$((SECONDS - build_begin))
if [ "${1:-}" = --fast ]; then
  stage "fast tests"
  run_tests release -L fast
  exit
fi
if [ "${1:-}" = --long ]; then
  stage "all tests"
  run_tests release
elif fits "slow tests" 130; then
  stage "fast and slow tests"
  run_tests release -LE long
else
  stage "fast tests"
  run_tests release -L fast
fi
if fits "clang" 25; then
  stage "build with clang"
  build clang
  build/clang/brio run inputs/bar_impact.yaml --quiet --overwrite --output build/clang/bar_impact.results
fi
if fits "sanitizers" 265; then
  stage "build with sanitizers"
  build debug-sanitized -DBRIO_TESTS=ON
  stage "fast tests with sanitizers"
  run_tests debug-sanitized -L fast
fi
stage "done"
for stage in "${left_out[@]}"; do
  echo "LEFT OUT for want of time: $stage. The build took $((build_seconds / 60)) min; BRIO_TEST_MINUTES is $BRIO_TEST_MINUTES."
done
