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
  "$brio" study "$study" --output "$folder/$name.study" "$@" || [ $? -eq 3 ]  # a run that fails stands in its row
  cp "$folder/$name.study/$name".{front,knobs}.svg "$pictures"
  { echo; sed "s|](\($name\.\)|](pictures/studies/\1|" "$folder/$name.study/$name.md"; } >> "$page"
done
{
  echo; echo "## All scenes"; echo
  echo "What is cheaper and more accurate than the default by more than 5 % in both, and where:"; echo
  echo "| setting | scenes | |"; echo "| --- | --- | --- |"
  for study in inputs/studies/*.yaml; do
    name=$(basename "$study" .yaml)
    awk -F, -v name="$name" 'NR > 1 && $NF == 1 { print $1, name }' "$folder/$name.study/$name.csv"
  done | sort | awk '{ count[$1]++; where[$1] = where[$1] (where[$1] ? ", " : "") $2 }
    END { for (run in count) printf "| `%s` | %d | %s |\n", run, count[run], where[run] }' | sort -t'|' -k3,3nr -k2,2
  echo; echo "Settings have the same name in several studies where they are the same. The presets were chosen by these tables."
} >> "$page"
mv "$page" docs/tradeoffs.md
