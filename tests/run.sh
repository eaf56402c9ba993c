#!/usr/bin/env bash
# Installs what is missing, builds Brio and runs its tests; those of base and contact a second time under sanitizers.
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

# Under sanitizers the kernels take minutes to compile: only what is free of them is instrumented here.
generator=()
[ -f build/debug-sanitized/CMakeCache.txt ] || generator=(-G Ninja)
cmake --preset debug-sanitized "${generator[@]}" -DBRIO_TESTS=ON -DBRIO_BENCH=OFF
cmake --build --preset debug-sanitized -j "$jobs" --target test_base test_contact
build/debug-sanitized/tests/test_base
build/debug-sanitized/tests/test_contact --gtest_filter=-*Slow*

ctest --test-dir build/release --output-on-failure -j "$jobs"
