# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# What compare.sh and scaling.sh have in common. They set source_dir, the top of this project, and
# folder, where everything is built and written.
source "${source_dir:?}/Examples/install.sh"

# make_folder FOLDER: its absolute path.
make_folder()
{
  mkdir -p "$1"
  (cd "$1" && pwd)
}

# build NAME SOURCE CMAKE-OPTION...: configures and builds into the folder of that name.
build()
{
  local name=$1 source=$2
  shift 2
  mkdir -p "$folder/$name"
  echo "--- $name"
  run_quietly "configure" "$folder/$name/configure.log" cmake -S "$source" -B "$folder/$name" \
    -G Ninja -DCMAKE_BUILD_TYPE=Release "$@" &&
    run_quietly "build" "$folder/$name/build.log" cmake --build "$folder/$name" -- -k 0
}

# build_project: the programs of this project, in $folder/project/bin.
build_project()
{
  install_packages "$folder/install.log" cmake g++ ninja-build libvtk9-dev libeigen3-dev \
    libbenchmark-dev python3-matplotlib
  build project "$source_dir" -DPython3_EXECUTABLE=/usr/bin/python3 -DIPIA_WRAP_PYTHON=OFF \
    -DIPIA_BUILD_TESTING=OFF -DIPIA_BUILD_EXAMPLES=OFF -DIPIA_BUILD_BENCHMARKS=ON
}

# run_module NAME ARGUMENT...: a module of ipia_benchmarks.
run_module()
{
  local name=$1
  shift
  PYTHONDONTWRITEBYTECODE=1 PYTHONPATH=$source_dir/Testing/Benchmark \
    /usr/bin/python3 -m "ipia_benchmarks.$name" "$@"
}
