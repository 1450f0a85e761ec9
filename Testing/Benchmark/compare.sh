#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# This project and other software on the same clouds in the same run, on Debian 12:
#
#   bash Testing/Benchmark/compare.sh [folder] [option...]
#
# Installs what is missing, builds into the folder (default build/benchmark) and writes tables and
# plots to its comparison/. Options are those of ipia_benchmarks/comparison.py: --clouds torus bunny,
# --repetitions 1, --limit 60.
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$source_dir/Testing/Benchmark/build.sh"
folder=$(make_folder "${1:-$source_dir/build/benchmark}")

build_project
# Software that cannot be installed or built is a row that says so.
for package in libcgal-dev libopen3d-dev libpcl-dev; do
  install_packages "$folder/install.log" "$package" || echo "$package is left out"
done
build peers "$source_dir/Testing/Benchmark/Peers" || echo "what failed to build is left out"
data=$source_dir/build/data
unpack_scans "$data"

run_module comparison "$folder/comparison" --programs "$folder/project/bin" "$folder/peers/bin" \
  --meshes "$data" "${@:2}"
echo "written to $folder/comparison"
