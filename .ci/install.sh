#!/usr/bin/env bash
# Installs what Brio needs to be built and tested on Debian 12, if it is missing. Needs root or sudo for that.
# Usage: .ci/install.sh [build|ranks|test|study|gmsh|paraview|browser|tidy]...     (default: build)
set -euo pipefail

build="g++ cmake ninja-build libeigen3-dev libhdf5-dev libnetcdf-dev libyaml-cpp-dev nlohmann-json3-dev libfmt-dev libcli11-dev libmuparser-dev"
test="libgtest-dev libgmp-dev libboost-dev clang clang-format python3 python3-jsonschema python3-yaml python3-h5py locales-all"
ranks="libopenmpi-dev openmpi-bin"
study="gnuplot-nox"
gmsh="gmsh"
paraview="paraview python3-paraview python3-pil python3-yaml python3-h5py xvfb xauth"
browser="chromium"
tidy="clang-tidy"

packages=""
for group in "${@:-build}"; do
  case "$group" in
    build) packages+=" $build" ;;
    ranks) packages+=" $build $ranks" ;;
    test) packages+=" $build $ranks $test $study" ;;
    study) packages+=" $study" ;;
    gmsh) packages+=" $gmsh" ;;
    paraview) packages+=" $paraview" ;;
    browser) packages+=" $browser" ;;
    tidy) packages+=" $build $tidy" ;;
    *) echo "install.sh: unknown group '$group'; build, ranks, test, study, gmsh, paraview, browser and tidy are known" >&2; exit 2 ;;
  esac
done

missing=""
for package in $packages; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [ "$status" = installed ] || missing+=" $package"
done
[ -n "$missing" ] || exit 0

as_root=""
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || { echo "install.sh: root or sudo is needed to install$missing" >&2; exit 1; }
  as_root=sudo
fi
echo "Installing$missing"
$as_root apt-get update -q
# shellcheck disable=SC2086
DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -q --no-install-recommends $missing
