# Sourced by bench, tests/run and .ci/run, which set `root` (the repository) and `program` (their name in messages).
# Everything here writes to stderr only: stdout belongs to the program that is started in the end.

say() { printf '%s: %s\n' "$program" "$*" >&2; }

fail() {
  say "$@"
  exit 2
}

# quietly COMMAND...: shows what the command printed only if it fails.
quietly() {
  local output
  output=$("$@" 2>&1 </dev/null) && return
  printf '%s\n' "$output" >&2
  return 1
}

progress_every=10  # s between two lines in a log

# with_progress COMMAND...: quietly, for ninja: "[3/81] Building ..." becomes "3 of 81 steps, 12 s", on a terminal in one line that
# is rewritten.
with_progress() {
  local begin=$SECONDS told=$SECONDS output='' line
  while IFS= read -r line; do
    [[ $line =~ ^\[([0-9]+)/([0-9]+)\] ]] || { output+=$line$'\n' && continue; }
    line="building, ${BASH_REMATCH[1]} of ${BASH_REMATCH[2]} steps, $((SECONDS - begin)) s"
    if [[ -t 2 ]]; then
      printf '\r%s: %s ' "$program" "$line" >&2
    elif ((SECONDS - told >= progress_every)); then
      say "$line"
      told=$SECONDS
    fi
  done < <("$@" 2>&1 </dev/null)
  [[ ! -t 2 ]] || printf '\r\e[K' >&2
  wait $! || { printf '%s' "$output" >&2 && return 1; }
}

# locked FOLDER COMMAND...: only one process at a time does something to the folder.
locked() {
  local folder=$1
  shift
  mkdir -p "$folder" || fail "cannot create $folder"
  (flock 9 && "$@") 9<"$folder"
}

# ---- Debian packages ----

package_list=$root/configs/debian-packages.txt

# packages SECTION...: what these sections of the list hold.
packages() {
  awk -v sections="$*" '
    { sub(/#.*/, "") }
    /^\[/ { wanted = index(" " sections " ", " " substr($1, 2, length($1) - 2) " "); next }
    wanted && NF { print $1 }' "$package_list"
}

missing_packages() {
  comm -23 <(packages "$@" | sort) <(packages "$@" |
    xargs dpkg-query --show --showformat '${db:Status-Status} ${Package}\n' 2>/dev/null |
    sed -n 's/^installed //p' | sort -u)
}

# ensure_packages SECTION...: installs what is missing, or says what to type and ends the script.
ensure_packages() {
  if ! [[ -e /etc/debian_version ]] || ! command -v dpkg-query >/dev/null; then
    say "not a Debian system: going on without looking for the packages in configs/debian-packages.txt"
    return
  fi
  locked "$root/build" ensure_debian_packages "$@" || exit 2
}

ensure_debian_packages() {
  local missing
  mapfile -t missing < <(missing_packages "$@")
  ((${#missing[@]})) || return 0
  say "missing Debian packages: ${missing[*]}"
  local by_hand="apt-get install -y --no-install-recommends ${missing[*]}"
  if ((EUID != 0)); then
    say "install them, then run this again:"
    printf 'sudo %s\n' "$by_hand" >&2
    return 2
  fi
  if [[ -z ${CI:-}${yes:-} ]]; then
    say "installing them in five seconds; Ctrl-C stops, ./bench --yes does not wait ..."
    sleep 5
  fi
  export DEBIAN_FRONTEND=noninteractive
  local install=(apt-get install -y --no-install-recommends -o DPkg::Lock::Timeout=300 "${missing[@]}")
  # The package lists of a bare machine are empty or old: an attempt that failed is repeated after an update.
  quietly "${install[@]}" 2>/dev/null || { quietly apt-get update && quietly "${install[@]}"; } ||
    { say "that failed; by hand: $by_hand"; return 2; }
}

# ---- Build ----

cpu_features() { grep -m1 -E '^(flags|Features)' /proc/cpuinfo 2>/dev/null | cksum; }

# A build folder that was copied along with the repository refers to another source folder or, because of -march=native,
# another kind of processor. Without these files everything in it is made anew.
forget_foreign_build() {
  local dir=$1 home
  [[ -e $dir/CMakeCache.txt ]] || return 0
  home=$(sed -n 's/^CMAKE_HOME_DIRECTORY:INTERNAL=//p' "$dir/CMakeCache.txt")
  if ! [[ $home -ef $root ]] || { [[ -e $dir/.cpu ]] && [[ $(<"$dir/.cpu") != "$(cpu_features)" ]]; }; then
    rm -f "$dir"/{CMakeCache.txt,build.ninja,.ninja_log,.ninja_deps,.cpu,bench}
  fi
}

# configure FOLDER PRESET [CMAKE_ARGUMENT...]
configure() {
  local dir=$1 preset=$2 fresh=()
  shift 2
  [[ -e $dir/build.ninja ]] || fresh=(--fresh)  # no leftovers of a configuration that failed
  quietly cmake -S "$root" --preset "$preset" -B "$dir" "${fresh[@]}" "$@" || return
  cpu_features >"$dir/.cpu"
}

# compile FOLDER TARGETS: announces itself, if there is anything to compile. TARGETS are words in one argument.
compile() {
  local dir=$1 targets files
  read -ra targets <<<"$2"
  quietly ninja -C "$dir" build.ninja || return  # files that came or went
  # By its own name, build.ninja would be made anew first, and a dry run would plan no further.
  cp "$dir/build.ninja" "$dir/plan.ninja"
  files=$(ninja -C "$dir" -f plan.ninja -n "${targets[@]}" | grep -c 'Building CXX object' || true)
  ((files == 0)) || say "building, $files files to compile ..."
  with_progress ninja -C "$dir" "${targets[@]}"
}

# build_preset FOLDER PRESET TARGETS [CMAKE_ARGUMENT...]: always configures, so that the arguments are in force.
build_preset() {
  local dir=$1 preset=$2 target=$3
  shift 3
  forget_foreign_build "$dir" && configure "$dir" "$preset" "$@" && compile "$dir" "$target"
}
