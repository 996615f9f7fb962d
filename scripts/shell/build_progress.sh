# shellcheck shell=bash
# Sourced by environment.sh: what a build has done so far, from its log and its Makefiles.

# Targets that `all` of a CMake build folder (Unix Makefiles) builds, those that others need among them.
targets_of_all() {  # folder
  [ -f "$1/CMakeFiles/Makefile2" ] || { echo 0; return; }
  awk -F': ' '
    NF == 2 && $1 !~ /[ #%]/ && $1 ~ /(^|\/)all$/ && $2 ~ /^[^ ]*\/all$/ { needs[$1] = needs[$1] " " $2 }
    function visit(name,    parts, count, i) {
      if (name in seen) return
      seen[name] = 1
      if (name ~ /\.dir\/all$/) targets++
      count = split(needs[name], parts, " ")
      for (i = 1; i <= count; ++i) visit(parts[i])
    }
    END { visit("all"); print targets + 0 }' "$1/CMakeFiles/Makefile2"
}

# "configuring", then "37 % of the steps, 21 of 63 targets".
build_progress() {  # log, folder
  local percent done total
  percent=$(grep -aoE '^\[ *[0-9]+%\]' "$1" 2>/dev/null | tail -1 | tr -dc 0-9 || true)
  [ -n "$percent" ] || { echo configuring; return; }
  done=$(grep -acE '^\[ *[0-9]+%\] Built target ' "$1" || true)
  total=$(targets_of_all "$2")
  echo "$percent % of the steps, $done of $((total > done ? total : done)) targets"
}

# While the process lives: on a terminal one line that changes, else a line every half minute.
watch_build() {  # log, folder, process
  local started=$SECONDS next=0 text
  while sleep 1 >/dev/null 2>&1 && kill -0 "$3" 2>/dev/null; do
    if [ -t 1 ]; then
      printf '\r\033[K   %s, %s s' "$(build_progress "$1" "$2")" $((SECONDS - started))
    elif [ $((SECONDS - started)) -ge "$next" ]; then
      text=$(build_progress "$1" "$2")
      [ "$next" -eq 0 ] || printf '   %s, %s s\n' "$text" $((SECONDS - started))
      next=$((SECONDS - started + ${BUILD_PROGRESS_PAUSE:-30}))
    fi
  done
}

# Runs the command with its output in the log, and shows meanwhile how far it is; its exit code. The command stays in
# the foreground, where Ctrl-C reaches it.
with_progress() {  # log, folder, command …
  local log=$1 folder=$2 watcher code=0
  shift 2
  : >"$log"
  watch_build "$log" "$folder" $$ &
  watcher=$!
  "$@" >"$log" 2>&1 </dev/null || code=$?
  kill "$watcher" 2>/dev/null || true
  wait "$watcher" 2>/dev/null || true
  [ ! -t 1 ] || printf '\r\033[K'
  return $code
}
