#!/usr/bin/env bash
# Writes the pictures of docs/gallery.md and the moving can of README.md: runs the decks, or takes up results that are
# there, and draws them.
# Usage: docs/gallery.sh [NAME]...     (default: all)
set -euo pipefail
cd "$(dirname "$0")/.."

.ci/install.sh paraview
brio=${BRIO:-build/release/brio}
folder=${GALLERY:-build/gallery}
pictures=docs/pictures/gallery
mkdir -p "$folder" "$pictures"

run() {  # DECK: once
  [ -f "$folder/$1/$1.summary.json" ] || "$brio" run "inputs/$1.yaml" --output "$folder/$1" --overwrite
}
draw() {  # DECK OPTIONS...
  local deck=$1
  shift
  xvfb-run -a -s -noreset pvbatch docs/render.py "$folder/$deck/$deck.xdmf2" --size 1200 900 "$@"
}
picture() {  # NAME DECK TIME OPTIONS...
  local name=$1 deck=$2 time=$3
  shift 3
  run "$deck"
  draw "$deck" --output "$pictures/$name" --times "$time" --largest 400000 "$@"
  mv "$pictures/${name}_0.png" "$pictures/$name.png"
}

plot() {  # NAME DECK COLUMNS AND OPTIONS...
  local name=$1 deck=$2
  shift 2
  "$brio" plot "$folder/$deck" "$@" --output "$pictures/$name.svg"
  rm -f "$pictures/$name.gp"
}

strain="--color equivalent_plastic_strain"
can() {
  picture can can_buckling 2.4e-3 $strain --range 0 1 --fade plate --camera 0.5 -2 0.6
  draw can_buckling --animation docs/pictures/can.gif $strain --range 0 1 --fade plate --camera 0.5 -2 0.6 --size 560 440
  plot can_force can_buckling contact.plate.can_z --filter 1000
}
pipe() {
  picture pipe pipe_cutting 1.25e-3 $strain --range 0 0.6 --fade blade left right --clip 0 1 0 --camera 0.6 -2 0.5
  plot pipe_force pipe_cutting contact.blade.pipe_z --filter 1000
}
bricks() {
  picture bricks brick_stack 6e-3 --color part --fade wall --camera -1 -2 0.8
}
bird() { picture bird bird_strike 2.4e-3 --color velocity --thicken --hide-edges; }
net() { picture net net 12e-3 --color part --thicken --hide-edges; }
crash_box() { picture crash_box crash_box 100% $strain --range 0 0.8; }
perforation() { picture perforation plate_perforation 30% $strain --range 0 0.8 --clip 0 1 0 --camera 0.6 -2 0.6 --zoom 1.3; }
rings() { picture rings rubber_rings 40% --color stress --thicken --hide-edges --camera 0.2 -2 0.9; }
taylor() { picture taylor taylor_bar 100% $strain --range 0 2 --camera 1 -2 0.4; }

[ $# -gt 0 ] || set -- can pipe bricks bird net crash_box perforation rings taylor
for name in "$@"; do "$name"; done
