#!/bin/bash
# SPDX-License-Identifier: BSD-3-Clause
# Every test in one command, on Debian 12:
#
#   bash Testing/run.sh
#
# Installs what is missing, takes test data and ParaView from Debian packages, builds the project and the
# plugin with warnings as errors and the core with sanitizers, runs all tests, and exits with 1 if
# anything fails. Builds are in build/test, build/sanitize and build/plugin; ParaView is unpacked to
# build/paraview, beside the installed VTK, with which its packages conflict.
set -euo pipefail

source_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
main=$source_dir/build/test
sanitized=$source_dir/build/sanitize
plugin=$source_dir/build/plugin
paraview=$source_dir/build/paraview
data=$source_dir/build/data
source "$source_dir/Examples/install.sh"

mkdir -p "$main" "$sanitized" "$plugin"
begin=$SECONDS
install_packages "$main/install.log" cmake g++ ninja-build libvtk9-dev python3-vtk9 python3-numpy \
  libeigen3-dev libgtest-dev xvfb xauth \
  qtbase5-dev libqt5help5 libqt5opengl5 libqt5svg5 openmpi-bin imagemagick xdotool valgrind
unpack_scans "$data"
unpack_bunny "$data"
unpack_paraview "$paraview"

# Tests run side by side: their threads must not spin while they wait for each other.
export OMP_WAIT_POLICY=passive
# MPI refuses to run as root without these.
if [ "$(id -u)" = 0 ]; then
  export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi

failures=()
summary=()

# check NAME FOLDER CMAKE-OPTION...: configures, builds and tests; notes what fails and goes on.
check()
{
  local name=$1 folder=$2 line start=$SECONDS
  shift 2
  echo "--- $name"
  if ! run_quietly "configure" "$folder/configure.log" cmake -S "$source_dir" -B "$folder" -G Ninja \
    -DPython3_EXECUTABLE=/usr/bin/python3 -DIPIA_DATA_DIR="$data" -DIPIA_WARNINGS_AS_ERRORS=ON "$@"; then
    failures+=("$name: configure")
    return 0
  fi
  if ! run_quietly "build" "$folder/build.log" cmake --build "$folder"; then
    failures+=("$name: build")
    return 0
  fi
  # xvfb-run because VTK draws on a display, which without -noreset starts anew, and for a moment is
  # not there, whenever the last program that draws ends; no tests at all is a failure, too.
  if ! (cd "$folder" && xvfb-run -a -s "-noreset -screen 0 1280x1024x24" ctest -j "$(nproc)" --no-tests=error --output-on-failure) |
    tee "$folder/ctest.log"; then
    mapfile -t -O "${#failures[@]}" failures < <(
      sed -n "s/^\t *[0-9]* - \(.*\)/$name: \1/p" "$folder/ctest.log" | grep . || echo "$name: ctest")
  fi
  line=$(grep -E "^[0-9]+% tests passed" "$folder/ctest.log" || echo "no tests ran")
  summary+=("$name: $line, $((SECONDS - start)) s")
}

# Little optimization: it halves the time to compile and hardly lengthens the tests.
check "core with sanitizers" "$sanitized" \
  -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -g1 -DNDEBUG" \
  -DIPIA_CORE_ONLY=ON -DIPIA_SANITIZE=address,undefined -DIPIA_BUILD_TESTING=ON
# All but the core's tests, which have been run.
check "VTK and Python" "$main" -DCMAKE_BUILD_TYPE=Release \
  -DIPIA_BUILD_TESTING=ON -DIPIA_BUILD_CORE_TESTS=OFF -DIPIA_BUILD_EXAMPLES=ON -DIPIA_WRAP_PYTHON=ON
# Has a ParaView of its own: the two VTKs cannot share a build tree.
check "plugin" "$plugin" -DCMAKE_BUILD_TYPE=Release -DIPIA_BUILD_PARAVIEW_PLUGIN=ON \
  -DIPIA_BUILD_TESTING=ON -DIPIA_STANDALONE_DIR="$main" \
  -DParaView_DIR="$(echo "$paraview"/usr/lib/*/cmake/paraview-*)"

echo
for line in "${summary[@]}"; do
  echo "$line"
done
echo "all of it took $((SECONDS - begin)) s"
if [ ${#failures[@]} -gt 0 ]; then
  printf 'FAILED  %s\n' "${failures[@]}"
  exit 1
fi
echo "passed"
