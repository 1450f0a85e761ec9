# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# What the commands that install what is missing have in common: Examples/demo.sh, Examples/tasks.sh,
# Testing/run.sh and those of Testing/Benchmark.

as_root()
{
  if [ "$(id -u)" = 0 ]; then
    "$@"
  elif command -v sudo > /dev/null; then
    sudo "$@"
  else
    echo "error: '$*' needs root rights, and there is no sudo" >&2
    return 1
  fi
}

# percent_done LOG: by what ninja ([n/m]) or apt-get (APT::Status-Fd) wrote there last, else 0.
percent_done()
{
  tail -n 200 "$1" | awk '
    /^\[[0-9]+\/[0-9]+\]/ { split(substr($1, 2), count, /[\/\]]/); done = 100 * count[1] / count[2] }
    /^dlstatus:/ { split($0, field, ":"); done = 0.3 * field[3] }
    /^pmstatus:/ { split($0, field, ":"); done = 30 + 0.7 * field[3] }
    END { print int(done) }'
}

# show_tens PERCENT: the line 0...10...20 up to there; SHOWN is how far it is.
show_tens()
{
  while [ $((SHOWN + 10)) -le "$1" ]; do
    SHOWN=$((SHOWN + 10))
    [ "$SHOWN" = 0 ] || printf '...'
    printf '%d' "$SHOWN"
  done
}

# run_quietly NAME LOG COMMAND...: one line with progress and duration; the log only if it fails.
run_quietly()
{
  local name=$1 log=$2 start=$SECONDS job percent
  shift 2
  printf '%-10s' "$name"
  SHOWN=-10
  "$@" > "$log" 2>&1 &
  job=$!
  while kill -0 "$job" 2> /dev/null; do
    sleep 0.5
    percent=$(percent_done "$log")
    [ "$percent" = 0 ] || show_tens "$percent"
  done
  if ! wait "$job"; then
    echo " failed"
    if [ -n "${WILL_RETRY:-}" ]; then
      return 1
    fi
    grep -av '^[dp][lm]status:' "$log" | tail -n 40 >&2
    echo "error: $name failed; all of it is in $log" >&2
    return 1
  fi
  # As wide as 0...10...20...30...40...50...60...70...80...90...100
  if [ "$SHOWN" -ge 0 ]; then
    show_tens 100
  else
    printf '%52s' ""
  fi
  printf '%5d s\n' $((SECONDS - start))
}

missing_packages()
{
  local package
  for package in "$@"; do
    if [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2> /dev/null)" != installed ]; then
      echo "$package"
    fi
  done
}

# update_index LOG PACKAGE...: a fresh machine has no index of packages.
update_index()
{
  local log=$1
  shift
  if ! apt-get install --simulate --no-install-recommends "$@" > /dev/null 2>&1; then
    run_quietly "index" "$log" as_root apt-get update
  fi
}

# install_packages LOG PACKAGE...: those that are missing.
install_packages()
{
  local log=$1 missing
  shift
  mapfile -t missing < <(missing_packages "$@")
  if [ ${#missing[@]} = 0 ]; then
    return 0
  fi
  if ! command -v apt-get > /dev/null; then
    echo "error: no apt-get here; install what corresponds to: ${missing[*]}" >&2
    return 1
  fi
  if [ "$(id -u)" != 0 ]; then
    as_root true # asks for the password now, not behind a progress line
  fi
  update_index "$log" "${missing[@]}"
  echo "missing   ${missing[*]}"
  local install=(env DEBIAN_FRONTEND=noninteractive
    apt-get install -y --no-install-recommends -o APT::Status-Fd=1 "${missing[@]}")
  if ! WILL_RETRY=yes run_quietly "install" "$log" as_root "${install[@]}"; then
    # An old index names files that the mirrors no longer have.
    run_quietly "index" "$log" as_root apt-get update
    run_quietly "install" "$log" as_root "${install[@]}"
  fi
}

# unpack_package PACKAGE FOLDER LOG: its files into a folder, without installing it.
unpack_package()
{
  local package=$1 folder=$2 log=$3
  update_index "$log" "$package"
  mkdir -p "$folder"
  run_quietly "download" "$log" download_and_unpack "$package" "$folder"
}

download_and_unpack()
(
  cd "$2" &&
    apt-get download "$1" &&
    dpkg-deb -x "$1"_*.deb . &&
    rm "$1"_*.deb
)

# build_release SOURCE FOLDER: the library and its Python package.
build_release()
{
  run_quietly "configure" "$2/configure.log" cmake -S "$1" -B "$2" -G Ninja \
    -DCMAKE_BUILD_TYPE=Release -DPython3_EXECUTABLE=/usr/bin/python3 \
    -DIPIA_BUILD_TESTING=OFF -DIPIA_BUILD_EXAMPLES=OFF
  run_quietly "build" "$2/build.log" cmake --build "$2"
}

# unpack_scans FOLDER: meshes/, points_3/ and images/ of the Debian package libcgal-demo, unless they are there.
unpack_scans()
{
  local folder=$1 archive=$1/package/usr/share/doc/libcgal-dev/data.tar.gz
  if [ -d "$folder/meshes" ] && [ -d "$folder/points_3" ]; then
    return 0
  fi
  mkdir -p "$folder"
  [ -f "$archive" ] || unpack_package libcgal-demo "$folder/package" "$folder/package.log"
  tar -xzf "$archive" -C "$folder" --strip-components 1
}

# unpack_bunny FOLDER: bunny.obj of the Debian package glmark2-data, unless it is there.
unpack_bunny()
{
  local folder=$1
  if [ ! -f "$folder/bunny.obj" ]; then
    unpack_package glmark2-data "$folder/glmark2" "$folder/glmark2.log"
    cp "$folder/glmark2/usr/share/glmark2/models/bunny.obj" "$folder"
  fi
}

# unpack_paraview FOLDER: ParaView with its programs, headers and Python modules, unless it is there.
# python3-paraview cannot be installed beside python3-vtk9, which libvtk9-dev needs.
unpack_paraview()
{
  local folder=$1 package
  [ ! -f "$folder/complete" ] || return 0
  for package in paraview paraview-dev python3-paraview; do
    unpack_package "$package" "$folder" "$folder.log"
  done
  touch "$folder/complete"
}
