#!/usr/bin/env bash
# clang-tidy over the sources of the program, with the checks of .clang-tidy. Run by hand: it takes about as long as a build.
# Usage: .ci/tidy.sh [FILE]...      (default: all but the tests)
set -euo pipefail
cd "$(dirname "$0")/.."
.ci/install.sh tidy
# A build folder of its own: headers precompiled by GCC are not read by clang.
cmake --preset release -B build/tidy -G Ninja -DBRIO_TESTS=OFF -DBRIO_UNITY=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON > /dev/null
files=("$@")
[ $# -gt 0 ] || mapfile -t files < <(git ls-files '*.cpp' | grep -v '^tests/')
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 1 clang-tidy -p build/tidy --quiet --extra-arg=-Wno-unused-command-line-argument
