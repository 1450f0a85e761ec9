#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# What a fit costs against points and cells, and its core against the machine, on Debian 12:
#
#   bash Testing/Benchmark/scaling.sh [folder] [option...]
#
# Installs what is missing, builds into the folder (default build/benchmark) and writes tables and a
# plot to its scaling/. Options are those of ipia_benchmarks/scaling.py: --points 10000 100000, --cells
# 64 128.
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
source "$source_dir/Testing/Benchmark/build.sh"
folder=$(make_folder "${1:-$source_dir/build/benchmark}")

build_project
run_module scaling "$folder/scaling" --programs "$folder/project/bin" "${@:2}"
echo "written to $folder/scaling"
