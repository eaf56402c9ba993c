#!/usr/bin/env bash
# Writes docs/tradeoffs.md: runs every study of inputs/studies, or takes up what has been run before with this program.
# Usage: docs/tradeoffs.sh [further options of `brio study`, such as --jobs 1]
set -euo pipefail
cd "$(dirname "$0")/.."

.ci/install.sh study
brio=${BRIO:-build/release/brio}
folder=${STUDIES:-build/studies}
pictures=docs/pictures/studies
mkdir -p "$folder" "$pictures"
page="$folder/tradeoffs.md"
cat docs/tradeoffs_begin.md > "$page"
for study in inputs/studies/*.yaml; do
  name=$(basename "$study" .yaml)
  "$brio" study "$study" --output "$folder/$name.study" "$@"
  cp "$folder/$name.study/$name".{front,knobs}.svg "$pictures"
  { echo; sed "s|](\($name\.\)|](pictures/studies/\1|" "$folder/$name.study/$name.md"; } >> "$page"
done
mv "$page" docs/tradeoffs.md
