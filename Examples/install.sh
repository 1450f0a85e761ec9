# SPDX-License-Identifier: BSD-3-Clause
# shellcheck shell=bash
# What the two commands for newcomers, Examples/demo.sh and Testing/run.sh, have in common.

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

# stage_end SECONDS: ends the line of a stage with its duration.
stage_end()
{
  printf '%*s%5d s\n' "$((STAGE_WIDTH > 0 ? STAGE_WIDTH : 0))" "" "$1"
}

# run_quietly NAME LOG COMMAND...: one line with a dot every second; the log only if it fails.
run_quietly()
{
  local name=$1 log=$2 start=$SECONDS job
  shift 2
  printf '%-10s' "$name"
  "$@" > "$log" 2>&1 &
  job=$!
  STAGE_WIDTH=53
  while kill -0 "$job" 2> /dev/null; do
    sleep 0.5
    if [ $((SECONDS - start)) -gt $((53 - STAGE_WIDTH)) ] && [ "$STAGE_WIDTH" -gt 0 ]; then
      printf '.'
      STAGE_WIDTH=$((STAGE_WIDTH - 1))
    fi
  done
  if ! wait "$job"; then
    echo " failed"
    if [ -n "${WILL_RETRY:-}" ]; then
      return 1
    fi
    tail -n 40 "$log" >&2
    echo "error: $name failed; all of it is in $log" >&2
    return 1
  fi
  stage_end $((SECONDS - start))
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
    apt-get install -y --no-install-recommends "${missing[@]}")
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
