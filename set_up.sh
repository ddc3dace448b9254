# Steps of the set-up that only a checkout needs: the catkin workspace, compiled loops, and all steps in order. ./roomba sources this file.
# shellcheck shell=bash

# shellcheck source=install_dependencies.sh
. "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/install_dependencies.sh"
WORKSPACE=$REPOSITORY/.workspace

# ---------------------------------------------------------------- step: catkin workspace

source_folders() {
  # Without the folder build, which pip leaves when it makes a wheel of this checkout.
  find "$REPOSITORY" -mindepth 1 -maxdepth 1 -type d -not -name '.*' -not -name build -printf '%f\n' | sort
}

workspace_hash() {
  local -a sources=(package.xml CMakeLists.txt setup.py)
  (
    cd "$REPOSITORY"
    mapfile -t -O "${#sources[@]}" sources < <(find msg srv action env-hooks -type f | sort)
    { find scripts -name '*.py' | sort; source_folders; environment_identity; } | hash_of "${sources[@]}"
  )
}

workspace_is_current() {
  [[ -f $WORKSPACE/devel/setup.bash ]] && stamp_is "$WORKSPACE/.stamp" "$(workspace_hash)"
}

# Only Python is generated here (a workspace of one's own also generates the other languages).
run_catkin_make() {
  env -u CMAKE_PREFIX_PATH -u ROS_PACKAGE_PATH -u PYTHONPATH -u ROS_DISTRO \
    PATH="/usr/sbin:/usr/bin:/sbin:/bin" ROS_LANG_DISABLE=gencpp:genlisp \
    catkin_make --directory "$WORKSPACE" --no-color -DPYTHON_EXECUTABLE="$PYTHON"
}

# The package in the workspace is a folder of links to the repository's visible folders. A link to the whole repository
# would contain this workspace again, and rosrun, which follows links, would find every script more than once.
link_sources() {
  local package=$WORKSPACE/src/roomba_robot name
  mkdir -p "$package"
  find "$package" -type l -delete
  while read -r name; do
    ln -s "$REPOSITORY/$name" "$package/$name"
  done < <(source_folders; printf '%s\n' package.xml CMakeLists.txt setup.py)
}

build_workspace() {
  local hash
  hash=$(workspace_hash)
  rm -f "$WORKSPACE/.stamp"
  link_sources
  if ! run_catkin_make; then
    printf 'The build failed; once more, from nothing, in case an older build is in the way.\n'
    rm -rf "$WORKSPACE/build" "$WORKSPACE/devel"
    run_catkin_make
  fi
  # catkin's intermediate copies are executable too: rosrun would take them for scripts of the package
  chmod -f a-x "$WORKSPACE"/build/atomic_configure/*.py || true
  printf '%s\n' "$hash" >"$WORKSPACE/.stamp"
}

# ---------------------------------------------------------------- step: compiled loops

# Hash of all files with compiled functions and of all that they import. Each state of these files that was compiled has a
# stamp, so changing back to an earlier branch compiles nothing.
compiled_hash() {
  PYTHONPATH=$REPOSITORY/src "$VENV/bin/python3" -m roomba.compiled_sources | hash_of "$(environment_stamp)"
}

# Prints the stamp of the environment that there is, with ROS or without.
environment_stamp() {
  local level
  for level in runtime library; do
    if [[ -r $VENV/.stamp-$level ]]; then
      printf '%s\n' "$VENV/.stamp-$level"
      return
    fi
  done
}

# Whether the loops that a clean needs are compiled; the rest is compiled in the background, or when it is needed.
compiled_is_current() {
  [[ -n $(environment_stamp) ]] && { compiled_is_complete || [[ -e $(compiled_stamp).left ]]; }
}

compiled_is_complete() {
  [[ -e $(compiled_stamp) ]]
}

compiled_stamp() {
  local hash
  hash=$(compiled_hash) || return
  printf '%s\n' "$CACHE/compiled/$hash"
}

# A loop that does not compile does not fail the set-up: it only makes the first start slow, and the tests report it.
compile_loops() { # library|runtime|dev
  local half=bursts stamp
  stamp=$(compiled_stamp)
  enter_what_there_is
  [[ $1 == library ]] || half=ticks # on ROS the robot runs tick by tick: bursts are compiled later
  if python3 -m roomba.commands.first_use "$half"; then
    count_loops_left "$stamp" || true
  fi
}

# Makes bytecode if packages were installed since the last time. Errors do not count: a package may bring files for another Python.
compile_packages() {
  local -a packages=("$VENV"/lib/python3*/site-packages)
  [[ ! $VENV/.bytecode -nt ${packages[0]} ]] || return 0
  "$VENV/bin/python3" -m compileall -qq -j 0 "${packages[@]}" || true
  touch "$VENV/.bytecode"
}

# Compiles bytecode on all cores, then loops, two processes at a time. numba touches each cache folder that it reads: folders not
# touched for 30 days belong to sources that no longer exist, and are removed.
compile_other_loops() {
  local stamp mapping
  stamp=$(compiled_stamp)
  enter_what_there_is
  compile_packages
  python3 -m roomba.commands.map.warm &
  mapping=$!
  if ! { python3 -m roomba.commands.trials.warm && count_loops_left "$stamp" && python3 -m roomba.commands.warm_up others; }; then
    wait "$mapping" || true
    return 1
  fi
  wait "$mapping" && count_loops_left "$stamp" || return 1
  mv -f "$stamp.left" "$stamp"
  mkdir -p "$CACHE/numba" # NUMBA_CACHE_DIR may name another folder
  find "$CACHE/numba" "$CACHE/compiled" -mindepth 1 -maxdepth 1 -mtime +30 -exec rm -r {} +
}

# Counts the loops that are not compiled yet; fails if the sources were changed since STAMP was made.
count_loops_left() { # STAMP
  [[ $(compiled_stamp) == "$1" ]] || return 1
  mkdir -p "$CACHE/compiled"
  python3 -m roomba.commands.compiling >"$1.counted"
  mv "$1.counted" "$1.left" # another command may be reading it
}

# Begins to compile the rest in the background, if that is not under way, with the lowest priority. Ctrl-C does not end the
# compilation. If it ends before all is compiled, the next command compiles what is left.
compile_beside() {
  say "It is usable; $(<"$(compiled_stamp).left") loops are still being compiled in the background, while the processor is free."
  mkdir -p "$CACHE/logs"
  (
    flock --nonblock 8 || exit 0
    renice -n 19 -p "$BASHPID"
    compile_other_loops
  ) 8>"$CACHE/compiling.lock" </dev/null &>"$CACHE/logs/compile_beside.log" &
  disown
}

compile_all() {
  (
    flock --wait 1800 8
    compiled_is_complete || compile_other_loops || true
  ) 8>"$CACHE/compiling.lock"
}

enter_what_there_is() {
  # The environment with ROS may be there without a workspace: then the library's is enough.
  if [[ -r $VENV/.stamp-runtime && -r $WORKSPACE/devel/setup.bash ]]; then
    enter_environment
  else
    enter_library
  fi
}

# ---------------------------------------------------------------- all steps

set_up_is_complete() { # library|runtime|dev
  if [[ $1 == library ]]; then
    library_is_current && compiled_is_current
    return
  fi
  system_is_current "$1" && python_is_current "$1" && workspace_is_current && compiled_is_current &&
    { [[ $1 != dev ]] || { npm_is_current && compiled_is_complete; }; }
}

set_up_missing_steps() { # library|runtime|dev
  install_dependencies "$1"
  if [[ $1 != library ]] && ! workspace_is_current; then
    run_step "Building the catkin workspace in .workspace" build_workspace
  fi
  if ! compiled_is_current; then
    run_step "Compiling the loops that a clean needs" compile_loops "$1"
    compiled_is_current || say "warning: not all could be compiled, the first start will be slow; see .cache/logs/compile_loops.log"
  fi
  if [[ $1 == dev ]] && ! compiled_is_complete; then
    run_step "Compiling all other loops" compile_all
  fi
}

# Whether nothing that the steps check has changed since all of them were found complete: one check instead of some forty.
# A file that is removed or new makes its folder newer.
is_as_before() { # library|runtime|dev
  local stamp=$CACHE/.complete-$1 folder
  local -a sources=(roomba set_up.sh install_dependencies.sh constraints.txt requirements.txt requirements-*.txt src)
  [[ -e $stamp ]] || return 1
  for folder in "$REPOSITORY" "$VENV" "$CACHE/compiled" "$WORKSPACE" "$WORKSPACE/devel" /usr/bin /var/lib/dpkg; do
    [[ ! $folder -nt $stamp ]] || return 1
  done
  [[ $1 == library ]] || sources+=(package.xml CMakeLists.txt setup.py msg srv action env-hooks scripts)
  [[ -z $(cd "$REPOSITORY" && find "${sources[@]}" -name __pycache__ -prune -o -newer "$stamp" -print -quit 2>&1) ]]
}

set_up() { # library|runtime|dev
  if is_as_before "$1"; then
    return
  fi
  local began
  [[ -w $REPOSITORY ]] || fail "expected that you may write into $REPOSITORY, which is to be set up; it belongs to" \
    "$(stat -c %U "$REPOSITORY"). Run this as that user, or in a clone of your own."
  mkdir -p "$CACHE"
  began=$(mktemp "$CACHE/.began.XXXXXX")
  if set_up_is_complete "$1"; then
    if compiled_is_complete; then
      mv -f "$began" "$CACHE/.complete-$1"
    else
      rm -f "$began"
      compile_beside
    fi
    return
  fi
  rm -f "$began"
  local started=$SECONDS
  say "Setting up $REPOSITORY (if interrupted, the next command goes on where this one stopped)"
  with_setup_lock set_up_missing_steps "$1"
  say "Set up in $((SECONDS - started)) s"
  compiled_is_complete || ! compiled_is_current || compile_beside
}

# ---------------------------------------------------------------- what is there

# One line per step of the set-up: name, state, what is missing. The state is unavailable if no set-up can do the step on this system.
describe_steps() {
  local missing
  missing=$(system_words runtime)
  if distribution >/dev/null; then
    describe_step "system packages" "$missing" test -z "$missing"
  else
    printf 'system packages\tunavailable\t%s\n' "$missing"
  fi
  describe_step "Python packages" "" python_is_current runtime
  describe_step "catkin workspace" "" workspace_is_current
  describe_step "compiled loops" "" compiled_is_current
  missing=$(system_words dev)
  describe_step "system packages for tests" "$missing" test -z "$missing"
  describe_step "Python packages for tests" "" python_is_current dev
  describe_step "npm packages for tests" "" npm_is_current
}

describe_step() { # NAME DETAIL IS_CURRENT...
  local name=$1 detail=$2 state=missing
  shift 2
  if "$@"; then
    state=current
  fi
  printf '%s\t%s\t%s\n' "$name" "$state" "$detail"
}

# ---------------------------------------------------------------- environment

# Prints the port of ROS_MASTER_URI, or nothing if that master is on another machine.
local_master_port() {
  local uri=${ROS_MASTER_URI:-http://localhost:11311} host port
  [[ $uri =~ ^http://([^/:]+|\[[^]]+\]):([0-9]+)/?$ ]] ||
    fail "ROS_MASTER_URI: expected http://HOST:PORT, came '$uri'. Set it so, or unset it."
  host=${BASH_REMATCH[1]} port=${BASH_REMATCH[2]}
  case $host in
    localhost | 127.* | "[::1]" | "$HOSTNAME" | "${ROS_IP:-localhost}" | "${ROS_HOSTNAME:-localhost}") printf '%s\n' "$port" ;;
  esac
}

# Enters ROS, the virtual environment and the workspace, without anything that the calling shell had sourced before.
enter_environment() {
  local port
  port=$(local_master_port)
  if [[ -n $port && -z ${ROS_IP:-}${ROS_HOSTNAME:-} ]]; then
    export ROS_IP=127.0.0.1 # no other machine needs to see this robot's nodes
  fi
  export PYTHONNOUSERSITE=1
  # The robot's matrices are small: a second thread would only wait for the first, and use a core for that.
  export OPENBLAS_NUM_THREADS=${OPENBLAS_NUM_THREADS:-1}
  keep_bytecode
  unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH ROS_DISTRO PYTHONPATH
  set +u # the hooks of ROS read variables that are not set
  # shellcheck source=/dev/null
  . "$WORKSPACE/devel/setup.bash"
  set -u
  export PYTHONPATH=$REPOSITORY/src:$PYTHONPATH # the sources themselves, not through catkin's relay modules
}

# Without stored bytecode each start of a program, and of each node, compiles some 300 modules anew: 0.2 s of a core.
keep_bytecode() {
  unset PYTHONDONTWRITEBYTECODE
}

# Enters the library alone, from the sources: no ROS, no workspace, nothing that the calling shell had sourced before.
enter_library() {
  export PYTHONNOUSERSITE=1
  export OPENBLAS_NUM_THREADS=${OPENBLAS_NUM_THREADS:-1}
  keep_bytecode
  unset CMAKE_PREFIX_PATH ROS_PACKAGE_PATH ROS_DISTRO
  export NUMBA_CACHE_DIR=${NUMBA_CACHE_DIR:-$CACHE/numba}
  export PATH=$VENV/bin:$PATH PYTHONPATH=$REPOSITORY/src
}
