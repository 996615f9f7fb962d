# shellcheck shell=bash
# Sourced by the entry points in scripts/: where the repository is, whose tools are meant, how ROS is reached.

set -euo pipefail

say() { printf '== %s\n' "$*"; }
usage() { sed -n '2,/^[^#]/s/^# \{0,1\}//p' "$0"; }  # the comment at the head of the script
fail() { printf '%s: %s\n' "$(basename "$0")" "$*" >&2; exit 1; }

# Before anything is installed or built.
for argument in "$@"; do
  case $argument in -h | --help) usage; exit 0 ;; esac
done

REPOSITORY=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
case $REPOSITORY in
  *[][[:space:]\;:\'\"\$\&\(\)\<\>\|\*\?\#\{\}\\\`\!]*)
    fail "the path of the checkout, '$REPOSITORY', has a blank or a special character in it, which catkin and make cannot bear; move it to a path without" ;;
esac
cd "$REPOSITORY"

# Debian's ROS belongs to Debian's Python; another python3 or cmake may stand first on the caller's PATH.
export PATH=/usr/bin:/bin:/usr/sbin:/sbin:$PATH
PYTHON=/usr/bin/python3
unset PYTHONHOME
LINTERS=$REPOSITORY/build/linters  # venv with ruff and mypy
XACRO=$REPOSITORY/build/xacro      # venv with xacro; src/machine/description/xacro.h looks for it

# shellcheck source-path=SCRIPTDIR
source "$REPOSITORY/scripts/shell/build_progress.sh"

# One compiler per processor, but no more than one per 2 GB: the optimiser needs about 1 GB on Eigen.
compilers() {
  local processors memory_gb
  processors=$(nproc)
  memory_gb=$(awk '/^MemAvailable/ {print int($2 / 2000000)}' /proc/meminfo)
  echo $(( memory_gb < 1 ? 1 : memory_gb < processors ? memory_gb : processors ))
}

# colcon reads its own environment scripts under `set -u` badly.
source_install_space() {
  set +u
  # shellcheck disable=SC1091
  source "$REPOSITORY/install/setup.bash"
  set -u
}

free_loopback_port() {
  $PYTHON -c 'import socket; s = socket.socket(); s.bind(("127.0.0.1", 0)); print(s.getsockname()[1])'
}

# A ROS of our own on this machine alone, so that no other master is met and none is disturbed.
use_private_ros_master() {
  ROS_MASTER_URI=http://127.0.0.1:$(free_loopback_port)
  export ROS_MASTER_URI ROS_IP=127.0.0.1
  unset ROS_HOSTNAME ROS_NAMESPACE
}

# With `without_tests` no test program is built; what an earlier call built of them stays for a later one.
build_workspace() {  # [without_tests]
  local started=$SECONDS log=build/colcon.log testing=ON
  [ "${1-}" != without_tests ] || testing=OFF
  mkdir -p build
  touch build/COLCON_IGNORE
  say "building with $(compilers) compilers (all output: $REPOSITORY/$log)"
  if ! MAKEFLAGS="-j$(compilers)" with_progress "$log" build/robot_control colcon build \
      --event-handlers console_direct+ --cmake-args -DCMAKE_BUILD_TYPE=Release -DPYTHON_EXECUTABLE=$PYTHON -DCATKIN_ENABLE_TESTING=$testing; then
    grep -n -A6 -E 'error:|Error |CMake Error|undefined reference' "$log" | head -60 >&2 || tail -40 "$log" >&2
    fail "the build failed; all of it is in $REPOSITORY/$log"
  fi
  say "built in $((SECONDS - started)) s"
}

# The programs of bench/programs, which a build of the workspace leaves out.
build_benchmarks() {
  local log=build/benchmarks.log
  if ! with_progress "$log" build/robot_control cmake --build build/robot_control --target benchmarks -j "$(compilers)"; then
    grep -n -A6 'error' "$log" | head -60 >&2
    fail "the benchmarks could not be built; all of it is in $REPOSITORY/$log"
  fi
}
