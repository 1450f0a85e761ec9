#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# From points to a surface in one command, on Debian 12:
#
#   bash Examples/demo.sh            # a scan from a Debian package (the Stanford bunny)
#   bash Examples/demo.sh FILE       # your own: .ply .vtp .obj .xyz .pts .pwn
#
# Installs what is missing, builds into build/release, reconstructs the surface with nothing set, and
# writes it (surface.vtp, surface.ply), the function (f.vti) and a picture to ipia-output/.
set -euo pipefail

here=$PWD
source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$source_dir/build/release
output=$source_dir/ipia-output
source "$source_dir/Examples/install.sh"

if [ $# -gt 1 ]; then
  echo "usage: bash Examples/demo.sh [points file]" >&2
  exit 1
fi
# A mistake in the user's file is told before anything is installed.
points=${1:-}
if [ -n "$points" ]; then
  case ${points,,} in
    *.ply | *.vtp | *.obj | *.xyz | *.pts | *.pwn) ;;
    *)
      echo "error: $points: the suffix is not one of .ply .vtp .obj .xyz .pts .pwn" >&2
      exit 1
      ;;
  esac
  if ! [ -f "$points" ] || ! [ -r "$points" ]; then
    echo "error: $points: there is no such file, or it cannot be read" >&2
    exit 1
  fi
  case $points in /*) ;; *) points=$here/$points ;; esac
fi

mkdir -p "$build" "$output"
begin=$SECONDS
install_packages "$build/install.log" \
  cmake g++ ninja-build libvtk9-dev python3-vtk9 python3-numpy xvfb xauth

if [ -z "$points" ]; then
  points=$build/scan/usr/share/glmark2/models/bunny.obj
  [ -f "$points" ] || unpack_package glmark2-data "$build/scan" "$build/scan.log"
  echo "scan      the Stanford bunny, from the Debian package glmark2-data"
fi

build_release "$source_dir" "$build"

# Where other programs share the cores, OpenMP's threads would spin while they wait for one that has
# none: the bunny then takes up to twice as long. Threads that sleep cost nothing on an idle machine.
export OMP_WAIT_POLICY=${OMP_WAIT_POLICY:-passive}
PYTHONPATH=$build/lib/python3/dist-packages xvfb-run -a /usr/bin/python3 \
  "$source_dir/Examples/Python/reconstruct.py" "$points" --output "$output"
echo "
all of it took $((SECONDS - begin)) s"
