#!/usr/bin/env bash
# Installs what roomba_robot needs: ROS 1 from the distribution's own packages, and the Python environment .venv/.
#
#   ./install_dependencies.sh         what running the robot needs
#   ./install_dependencies.sh --dev   also what the tests need
#   ./install_dependencies.sh --library   what the library needs: no ROS, no system package
#
# It may be run again at any time: it keeps what is there, and completes what is missing or half made.
# ./roomba sources this file for its functions.
set -euo pipefail

REPOSITORY=$(cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")" && pwd -P)
VENV=$REPOSITORY/.venv
BENCH_VENV=$REPOSITORY/.venv-bench
AUDIT_VENV=$REPOSITORY/.venv-audit
HA_VENV=$REPOSITORY/.venv-ha
DOCS_VENV=$REPOSITORY/.venv-docs
CACHE=$REPOSITORY/.cache
OS_RELEASE=/etc/os-release
PYTHON=/usr/bin/python3 # the Python that ROS is packaged for; a pyenv or conda python has no rospy

# ---------------------------------------------------------------- telling what goes on

# All messages go to standard error: the output of `./roomba exec` belongs to the command.
say() { printf '%s\n' "$*" >&2; }

fail() {
  say "error: $*"
  exit 1
}

# Runs a command as a named step: its output goes to a log, and one line on the screen shows the progress.
# It must not be called in a condition (`if`, `||`): bash would ignore errors inside the step.
run_step() { # TITLE COMMAND...
  local title=$1 started=$SECONDS interrupted=no status log
  shift
  log=$CACHE/logs/$1.log
  mkdir -p "$CACHE/logs"
  say "==> $title"
  trap 'interrupted=yes' INT
  set +e
  # The lock's descriptor is closed, so that a process that the step leaves running does not hold the lock.
  (set -e; "$@") 2>&1 </dev/null 9>&- | show_progress "$log" "$started"
  status=${PIPESTATUS[0]}
  set -e
  trap - INT
  if [[ $interrupted == yes ]]; then
    say "Interrupted. The same command goes on where this one stopped."
    exit 130
  fi
  if ((status != 0)); then
    tail -n 25 "$log" | sed 's/^/    | /' >&2
    say "error: '$title' ended with status $status; expected 0. The whole output is in $log."
    say "       Mend what it says and run the same command again: it goes on where it stopped."
    exit "$status"
  fi
  say "    done in $((SECONDS - started)) s"
}

# Copies lines to LOG and shows the newest: in place on a terminal, now and then in a pipe.
show_progress() { # LOG STARTED
  trap '' INT # Ctrl-C ends the step; show_progress goes on until the step's last line
  local log=$1 started=$2 next=$((SECONDS + 15)) line="" newest="at work" packages=0 handled=0 width
  width=$(tput cols 2>/dev/null || echo 80)
  : >"$log"
  while true; do
    if IFS= read -r -t 1 line; then
      printf '%s\n' "$line" >>"$log"
      case $line in
        "" | "Selecting previously"* | "Preparing to unpack"*) ;;
        *" newly installed, "*) # what apt is about to do
          newest=$line
          line=${line%% newly installed,*}
          packages=${line##* }
          ;;
        "Unpacking "* | "Setting up "*)
          handled=$((handled + 1))
          newest="$((50 * handled / (packages > 0 ? packages : handled))) % $line"
          ;;
        *) newest=$line ;;
      esac
    elif (($? <= 128)); then # above 128: one second without a line
      break
    fi
    if [[ -t 2 ]]; then
      line="    $((SECONDS - started)) s  $newest"
      printf '\r\033[K%s' "${line:0:width-1}" >&2
    elif ((SECONDS >= next)); then
      say "    $((SECONDS - started)) s  $newest"
      next=$((SECONDS + 15))
    fi
  done
  [[ ! -t 2 ]] || printf '\r\033[K' >&2
}

# Holds the lock of the set-up while a command runs: of two commands that start at once only one sets up.
with_setup_lock() { # COMMAND...
  mkdir -p "$CACHE"
  (
    if ! flock --nonblock 9; then
      say "Another set-up of $REPOSITORY is running; waiting for its end, at most 30 minutes."
      flock --wait 1800 9 || fail "the other set-up still holds $CACHE/setup.lock after 30 minutes; end it and try again."
    fi
    "$@"
  ) 9>"$CACHE/setup.lock"
}

# ---------------------------------------------------------------- stamps

# A stamp is the hash of everything that a step was made from; it is written when the step is complete.
stamp_is() { # FILE HASH
  [[ -r $1 && $(<"$1") == "$2" ]]
}

hash_of() { # FILE...  (standard input counts as well)
  { cat; sha256sum "$@"; } | sha256sum | cut -d ' ' -f 1
}

# ---------------------------------------------------------------- step: system packages

# Prints bookworm, trixie or jammy; on any other system it prints why there is no ROS 1, and returns 1.
distribution() {
  local VERSION_CODENAME="" UBUNTU_CODENAME="" PRETTY_NAME="an unknown system"
  # shellcheck source=/dev/null
  [[ ! -r $OS_RELEASE ]] || . "$OS_RELEASE"
  case ${UBUNTU_CODENAME:-$VERSION_CODENAME} in
    bookworm | trixie | jammy)
      if command -v dpkg-query >/dev/null; then
        printf '%s\n' "${UBUNTU_CODENAME:-$VERSION_CODENAME}"
        return
      fi
      printf 'expected dpkg-query, which tells what packages there are, on %s; there is none\n' "$PRETTY_NAME"
      ;;
    *)
      printf 'expected Debian 12 (bookworm), Debian 13 (trixie) or Ubuntu 22.04 (jammy), whose own packages hold ROS 1; this is %s\n' \
        "$PRETTY_NAME"
      ;;
  esac
  return 1
}

require_ros() {
  local reason
  reason=$(distribution) || fail "this needs ROS 1: $reason." \
    $'\n'"       In a container of Debian: podman build --tag roomba . (docs/install.md; docker does as well)." \
    $'\n'"       Without ROS: ./roomba play, sim, map, campaign, top --demo, control --demo and others (./roomba help)."
}

# Names of packages are the same in bookworm, trixie and jammy; only chromium is not installed on Ubuntu.
system_packages() { # runtime|dev|bench, or on asking: rviz|screen|robot_state_publisher
  case $1 in
    bench) # in addition to runtime: OpenGL without a screen, for the peers that draw
      printf '%s\n' libegl1 libgl1 libgl1-mesa-dri
      return
      ;;
    rviz) printf '%s\n' rviz libgl1-mesa-dri && return ;;
    screen) printf '%s\n' rviz libgl1-mesa-dri xvfb && return ;;
    robot_state_publisher) printf '%s\n' ros-robot-state-publisher && return ;;
  esac
  local -a packages=(
    python3 python3-venv cmake g++ make
    # building: catkin with its hooks, and the definitions and CMake files of messages that this package's messages contain
    catkin ros-environment ros-message-generation libactionlib-msgs-dev libsensor-msgs-dev libstd-msgs-dev
    # running: master, launcher, client library, terminal commands
    python3-rospy python3-roslaunch python3-actionlib rosout rosbash
    python3-rosnode python3-rostopic python3-rosservice python3-rosparam python3-rosmsg python3-rosgraph
    python3-rosbag python3-topic-tools
    # pictures
    python3-cv-bridge python3-opencv
    # time zones
    tzdata
    # messages: for Python, and the definitions that `rosmsg show` reads
    python3-actionlib-msgs ros-actionlib-msgs
    python3-diagnostic-msgs ros-diagnostic-msgs
    python3-geometry-msgs ros-geometry-msgs
    python3-move-base-msgs ros-move-base-msgs
    python3-nav-msgs ros-nav-msgs
    python3-rosgraph-msgs ros-rosgraph-msgs
    python3-sensor-msgs ros-sensor-msgs
    python3-std-msgs ros-std-msgs
    python3-std-srvs ros-std-srvs
    python3-tf2-msgs ros-tf2-msgs
    python3-visualization-msgs ros-visualization-msgs
  )
  if [[ $1 == dev ]]; then
    packages+=(catkin-lint curl git mosquitto nodejs openssl shellcheck systemd)
    command -v npm >/dev/null || packages+=(npm) # some packages of nodejs contain npm
    # Ubuntu's package only fetches a snap.
    ! grep -qx 'ID=debian' /etc/os-release || packages+=(chromium)
  fi
  printf '%s\n' "${packages[@]}"
}

missing_system_packages() { # as above
  local -a packages
  mapfile -t packages < <(system_packages "$1")
  comm -23 <(printf '%s\n' "${packages[@]}" | sort) \
    <(dpkg-query --show --showformat '${db:Status-Status} ${Package}\n' "${packages[@]}" 2>/dev/null |
      sed -n 's/^installed //p' | sort -u)
}

system_is_current() { # as above
  command -v dpkg-query >/dev/null && [[ -z $(missing_system_packages "$1") ]]
}

# Prints the missing packages, or why this system has no ROS 1; prints nothing if all is there.
system_words() { # as above
  if distribution >/dev/null; then missing_system_packages "$1" | xargs; else distribution || true; fi
}

as_root() {
  if ((EUID == 0)); then
    "$@"
  else
    sudo -- "$@"
  fi
}

# Fails with the command to type, before any step, if this user may not install packages.
require_root() { # PACKAGE...
  ((EUID != 0)) || return 0
  local command="apt-get update && apt-get install --no-install-recommends $*"
  command -v sudo >/dev/null ||
    fail "installing packages needs root, and there is no sudo. Have this run as root, then try again:"$'\n'"    $command"
  sudo -n true 2>/dev/null && return 0
  [[ -t 0 ]] && sudo -v && return 0
  fail "installing packages needs root, and sudo did not let you. Have this run as root, then try again:"$'\n'"    $command"
}

apt_get() {
  as_root env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -o Dpkg::Use-Pty=0 \
    -o Acquire::Retries=3 -o Acquire::http::Timeout=30 -o Acquire::https::Timeout=30 "$@"
}

# A package source that apt cannot read, such as a third party's, is no reason to stop: the others may be enough.
refresh_package_lists() {
  local output deadline=$((SECONDS + 300))
  while true; do
    output=$(apt_get update 2>&1) || true
    printf '%s\n' "$output"
    grep -q 'Could not get lock' <<<"$output" || break
    ((SECONDS < deadline)) || fail "another apt has held its lock for 5 minutes; wait for its end and try again."
    sleep 5
  done
  if grep -q '^[EW]:' <<<"$output"; then
    printf 'warning: apt could not read all its sources; going on with those it could.\n'
  fi
}

install_system_packages() { # as above
  local -a missing
  mapfile -t missing < <(missing_system_packages "$1")
  as_root env DEBIAN_FRONTEND=noninteractive dpkg --configure -a || true # completes what an interrupted apt left
  refresh_package_lists
  apt_get --yes --no-install-recommends install "${missing[@]}" || {
    printf 'If a package cannot be located: on Ubuntu the component "universe" must be enabled.\n'
    return 1
  }
  system_is_current "$1" || fail "apt-get succeeded, but these are still missing: $(missing_system_packages "$1" | xargs)"
}

# Installs a package group that only one option of `./roomba` needs.
install_on_asking() { # rviz|screen|robot_state_publisher
  system_is_current "$1" && return
  require_ros
  local -a missing
  mapfile -t missing < <(missing_system_packages "$1")
  require_root "${missing[@]}"
  run_step "Installing ${missing[*]}, and what they need" install_system_packages "$1"
}

# ---------------------------------------------------------------- step: Python environment

# Prints the Python and the place that the environment is made for: another one of either needs a new environment.
environment_identity() {
  printf '%s in %s\n' "$(readlink -f "$PYTHON")" "$(readlink -f "$VENV")"
}

requirement_files() { # library|runtime|dev
  printf '%s\n' requirements.txt
  [[ $1 != library ]] || printf '%s\n' requirements-library.txt
  [[ $1 != dev ]] || printf '%s\n' requirements-smart-home.txt requirements-campaign.txt requirements-dev.txt
}

python_hash() { # library|runtime|dev
  local -a files
  mapfile -t files < <(requirement_files "$1")
  (cd "$REPOSITORY" && environment_identity | hash_of constraints.txt "${files[@]}")
}

python_is_current() { # library|runtime|dev
  [[ -x $VENV/bin/python3 ]] && stamp_is "$VENV/.stamp-$1" "$(python_hash "$1")"
}

# The library runs in its own environment, and in the robot's, which has all packages that the library needs.
library_is_current() {
  python_is_current library || python_is_current runtime
}

ros_is_installed() {
  system_is_current runtime
}

# For the library, packages are installed only into .venv: if the system's Python lacks a part, an error says so.
require_python() {
  [[ -x $PYTHON ]] || fail "expected $PYTHON, there is none. Have this run as root, then try again:"$'\n'"    apt-get install python3 python3-venv"
  "$PYTHON" -c 'import ensurepip' 2>/dev/null ||
    fail "expected $PYTHON with ensurepip, which makes .venv. Have this run as root, then try again:"$'\n'"    apt-get install python3-venv"
}

# OpenCV, numpy and YAML come as wheels here. The robot's environment must not contain these wheels, as cv_bridge is compiled
# against the distribution's packages. The mark .without-ros makes make_python_environment start anew.
make_library_environment() {
  printf 'Making %s, without ROS\n' "$VENV"
  "$PYTHON" -m venv --clear "$VENV"
  environment_identity >"$VENV/.made-for"
  touch "$VENV/.unfinished" "$VENV/.without-ros"
  install_requirements library
  printf 'Trying that what the library needs can be imported\n'
  PYTHONNOUSERSITE=1 "$VENV/bin/python3" -c 'import cv2, matplotlib, numba, numpy, pydantic, shapely, yaml'
  rm "$VENV/.unfinished"
  python_hash library >"$VENV/.stamp-library"
}

# Packages in ~/.local are ignored: they may be built against another numpy than the distribution's.
pip_install() { # VENV ARGUMENT...
  local venv=$1
  shift
  env -u PYTHONPATH PYTHONNOUSERSITE=1 PIP_USER=no PIP_DISABLE_PIP_VERSION_CHECK=1 "$venv/bin/python3" -m pip install \
    --no-input --progress-bar off --retries 5 --prefer-binary "$@"
}

# Without bytecode: Python makes it when a module is first imported, and set_up.sh makes the rest in the background.
install_requirements() { # library|runtime|dev
  local -a arguments=()
  local file
  while read -r file; do
    arguments+=(--requirement "$REPOSITORY/$file")
  done < <(requirement_files "$1")
  pip_install "$VENV" --no-compile --constraint "$REPOSITORY/constraints.txt" "${arguments[@]}"
}

# An environment is made anew if its Python is gone, it was moved, or an installation into it was interrupted.
make_python_environment() { # runtime|dev
  if ! stamp_is "$VENV/.made-for" "$(environment_identity)" || [[ -e $VENV/.unfinished || -e $VENV/.without-ros ]] ||
    ! "$VENV/bin/python3" -m pip --version; then
    printf 'Making %s\n' "$VENV"
    "$PYTHON" -m venv --clear --system-site-packages "$VENV"
    environment_identity >"$VENV/.made-for"
  fi
  rm -f "$VENV"/.stamp-*
  touch "$VENV/.unfinished"
  install_requirements "$1"
  printf 'Trying that OpenCV, cv_bridge and numba agree about numpy\n'
  PYTHONNOUSERSITE=1 "$VENV/bin/python3" -c 'import cv2, cv_bridge.boost.cv_bridge_boost, numba, numpy, pydantic, rospy, shapely'
  rm "$VENV/.unfinished"
  python_hash runtime >"$VENV/.stamp-runtime"
  [[ $1 != dev ]] || python_hash dev >"$VENV/.stamp-dev"
}

# Packages that only `--smart-home` and `smart_home:=` need.
smart_home_is_current() {
  PYTHONNOUSERSITE=1 "$VENV/bin/python3" -c 'import paho.mqtt.client, prometheus_client' 2>/dev/null
}

install_smart_home() {
  smart_home_is_current || run_step "Installing what speaks MQTT into .venv" add_smart_home
}

add_smart_home() {
  pip_install "$VENV" --requirement "$REPOSITORY/requirements-smart-home.txt"
}

# Packages that only `./roomba campaign` needs: dask for clusters, pyarrow for Parquet.
campaign_is_current() {
  PYTHONNOUSERSITE=1 "$VENV/bin/python3" -c 'import distributed, pyarrow' 2>/dev/null
}

install_campaign() {
  campaign_is_current || run_step "Installing dask and pyarrow into .venv" add_campaign
}

add_campaign() {
  pip_install "$VENV" --constraint "$REPOSITORY/constraints.txt" --requirement "$REPOSITORY/requirements-campaign.txt"
}

# ---------------------------------------------------------------- step: npm packages of the tests

npm_hash() {
  (cd "$REPOSITORY" && hash_of test/npm/package.json test/npm/package-lock.json </dev/null)
}

npm_is_current() {
  [[ -d $CACHE/npm/node_modules ]] && stamp_is "$CACHE/npm/.stamp" "$(npm_hash)"
}

# Other people's programs, which tests run unchanged; the install scripts of their packages are not run.
install_npm_packages() {
  mkdir -p "$CACHE/npm"
  rm -f "$CACHE/npm/.stamp"
  cp "$REPOSITORY/test/npm/package.json" "$REPOSITORY/test/npm/package-lock.json" "$CACHE/npm"
  (cd "$CACHE/npm" && npm ci --ignore-scripts --no-audit --no-fund)
  npm_hash >"$CACHE/npm/.stamp"
}

# ---------------------------------------------------------------- step: the peers of the benchmarks

bench_hash() {
  (cd "$REPOSITORY" && printf '%s in %s\n' "$(readlink -f "$PYTHON")" "$BENCH_VENV" | hash_of src/roomba_bench/peers.txt)
}

bench_is_current() {
  [[ -x $BENCH_VENV/bin/python3 ]] && stamp_is "$BENCH_VENV/.stamp" "$(bench_hash)"
}

# The peers have an environment of their own, so that they can have the versions of packages that they need.
make_bench_environment() {
  local name arguments installed=0
  "$PYTHON" -m venv --clear "$BENCH_VENV"
  mkdir "$BENCH_VENV/not-installed"
  while read -r name arguments; do
    if [[ -z $name || $name == \#* ]]; then
      continue
    fi
    # shellcheck disable=SC2086  # the arguments are several
    if install_peer "$name" ${arguments:-$name}; then
      installed=$((installed + 1))
    fi
  done <"$REPOSITORY/src/roomba_bench/peers.txt"
  ((installed > 0)) || fail "none of the peers could be installed; is the network there?"
  bench_hash >"$BENCH_VENV/.stamp"
}

# Installs each peer by itself, so that a failing one does not prevent the others; the benchmarks report its reason.
install_peer() { # NAME PIP_ARGUMENT...
  local name=$1 output
  shift
  if output=$(pip_install "$BENCH_VENV" "$@" 2>&1); then
    printf '%s: installed\n' "$name"
  else
    printf '%s\n' "$output"
    { sed -n 's/^ERROR: //p' <<<"$output" | grep . || echo "pip failed"; } | tail -n 1 >"$BENCH_VENV/not-installed/$name"
    printf '%s: not installed\n' "$name"
    return 1
  fi
}

# If these packages cannot be installed, go on: a peer that cannot draw without them says so in the table.
install_bench_packages() {
  local -a missing
  mapfile -t missing < <(missing_system_packages bench)
  refresh_package_lists
  apt_get --yes --no-install-recommends install "${missing[@]}" ||
    printf 'warning: going on without %s\n' "${missing[*]}"
}

may_install_packages() {
  ((EUID == 0)) || { command -v sudo >/dev/null && sudo -n true 2>/dev/null; }
}

install_bench() {
  if bench_is_current; then
    return
  fi
  if ! system_is_current bench && may_install_packages; then
    run_step "Installing OpenGL for the peers that draw" install_bench_packages
  fi
  run_step "Installing the peers of the benchmarks into .venv-bench" make_bench_environment
}

# ---------------------------------------------------------------- step: tools apart from the robot's environment

tool_hash() { # VENV REQUIREMENTS
  (cd "$REPOSITORY" && printf '%s in %s\n' "$(readlink -f "$PYTHON")" "$1" | hash_of "$2")
}

tool_is_current() { # VENV REQUIREMENTS
  [[ -x $1/bin/python3 ]] && stamp_is "$1/.stamp" "$(tool_hash "$1" "$2")"
}

make_tool_environment() { # VENV REQUIREMENTS
  "$PYTHON" -m venv --clear "$1"
  pip_install "$1" --requirement "$REPOSITORY/$2"
  tool_hash "$1" "$2" >"$1/.stamp"
}

install_tool() { # TITLE VENV REQUIREMENTS
  tool_is_current "$2" "$3" || run_step "$1" make_tool_environment "$2" "$3"
}

# Installs a tool that runs in the robot's environment without being part of it: into .cache/NAME, which is put on PYTHONPATH.
install_aside() { # NAME REQUIREMENT
  [[ -d $CACHE/$1 ]] ||
    run_step "Installing $1" add_aside "$1" "$2"
}

add_aside() { # NAME REQUIREMENT
  "$VENV/bin/python3" -m pip install --quiet --target "$CACHE/$1" "$2"
}

# In an environment of its own, or the audit's packages would be listed in the robot's bill of materials.
install_audit() {
  install_tool "Installing what makes the bill of materials into .venv-audit" "$AUDIT_VENV" requirements-audit.txt
}

# Installs the newest Home Assistant that there is for this Python; it needs an older paho than the robot.
install_ha() {
  install_tool "Installing Home Assistant into .venv-ha" "$HA_VENV" requirements-ha.txt
}

# Installs the tools that make the site of the documents.
install_docs() {
  install_tool "Installing what makes the site into .venv-docs" "$DOCS_VENV" requirements-docs.txt
}

# ---------------------------------------------------------------- all of it

install_dependencies() { # library|runtime|dev
  if [[ $1 == library ]]; then
    if library_is_current; then
      return
    elif ros_is_installed; then # the robot's environment serves the library as well, and a later `run` need not make it
      run_step "Installing Python packages into .venv" make_python_environment runtime
    else
      require_python
      run_step "Installing Python packages into .venv" make_library_environment
    fi
    return
  fi
  if ! system_is_current "$1"; then
    require_ros
    local -a missing
    mapfile -t missing < <(missing_system_packages "$1")
    require_root "${missing[@]}"
    run_step "Installing ${#missing[@]} system packages and what they need" install_system_packages "$1"
  fi
  if ! python_is_current "$1"; then
    run_step "Installing Python packages into .venv" make_python_environment "$1"
  fi
  if [[ $1 == dev ]] && ! npm_is_current; then
    run_step "Installing npm packages for the tests into .cache/npm" install_npm_packages
  fi
}

main() {
  local extent=runtime
  case ${1:-} in
    "") ;;
    --dev) extent=dev ;;
    --library) extent=library ;;
    *)
      say "usage: ./install_dependencies.sh [--library | --dev]   (--library: without ROS; --dev: also what the tests need)"
      say "came: $*"
      exit 2
      ;;
  esac
  with_setup_lock install_dependencies "$extent"
  say "All dependencies are there. Next: ./roomba run, or catkin_make in your workspace."
  if [[ $(command -v python3) != "$PYTHON" && $(command -v python3) != /bin/python3 ]]; then
    say "The python3 of this shell is $(command -v python3), which need not know ROS; type then:"
    say "    catkin_make -DPYTHON_EXECUTABLE=$PYTHON"
  fi
}

if [[ ${BASH_SOURCE[0]} == "$0" ]]; then
  main "$@"
fi
