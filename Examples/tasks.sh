#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# The tasks of Documentation/Tasks.md in one command, on Debian 12:
#
#   bash Examples/tasks.sh               # figures, surfaces and pictures to ipia-output/tasks
#   bash Examples/tasks.sh --document    # and the figures and pictures of the page renewed
#
# Installs what is missing, takes the data from a Debian package and builds into build/release.
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$source_dir/build/release
data=$source_dir/build/data
output=$source_dir/ipia-output/tasks
images=$source_dir/Documentation/Images
source "$source_dir/Examples/install.sh"

page=()
case "$*" in
  "") ;;
  --document) page=(--page "$source_dir/Documentation/Tasks.md") ;;
  *)
    echo "usage: bash Examples/tasks.sh [--document]" >&2
    exit 1
    ;;
esac

mkdir -p "$build" "$output"
install_packages "$build/install.log" \
  cmake g++ ninja-build libvtk9-dev python3-vtk9 python3-numpy xvfb xauth imagemagick
unpack_scans "$data"
build_release "$source_dir" "$build"

# As in demo.sh: threads that wait shall not take the cores from others.
export OMP_WAIT_POLICY=${OMP_WAIT_POLICY:-passive}
PYTHONPATH=$build/lib/python3/dist-packages xvfb-run -a /usr/bin/python3 \
  "$source_dir/Examples/Python/tasks/run_all.py" --data "$data" --output "$output" "${page[@]}"
if [ ${#page[@]} -gt 0 ]; then
  for picture in "$output"/task-*.png; do
    # A palette takes a third of the room.
    convert "$picture" -strip -dither None -colors 256 -define png:compression-level=9 \
      "png8:$images/$(basename "$picture")"
  done
fi
echo "surfaces and pictures are in $output"
