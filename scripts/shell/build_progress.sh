# shellcheck shell=bash
# Sourced by environment.sh: what a build has done so far, from its log and its Makefiles.

# "37 % of the work, 21 of 63 targets" of what a target of a CMake build folder (Unix Makefiles) needs, by the log of
# the build; before that "configuring". The work of an object is 8 kB, for its headers, and the length of its sources:
# GCC's time for those of this project is in proportion to it within a factor of about two.
build_progress() {  # log, folder, target
  grep -qaE '^\[ *[0-9]+%\]' "$1" 2>/dev/null && [ -f "$2/compile_commands.json" ] || { echo configuring; return; }
  awk -v folder="$(cd "$2" && pwd -P)/" -v wanted="$3" '
    function visit(rule,    parts, count, i) {
      if (rule in seen) return
      seen[rule] = 1
      count = split(needs[rule], parts, " ")
      for (i = 1; i <= count; ++i) visit(parts[i])
      if (sub(/\.dir\/all$/, "", rule)) { targets++; if (rule_name(rule) in built) finished++ }
    }
    function rule_name(rule) { sub(/.*\//, "", rule); return rule }
    function length_of(file,    line, sum) {  # with the sources that a file of a unity build includes
      while ((getline line < file) > 0) {
        sum += length(line) + 1
        if (file ~ /\/Unity\// && match(line, /"\/.*"/)) sum += length_of(substr(line, RSTART + 1, RLENGTH - 2))
      }
      close(file)
      return sum
    }
    FILENAME ~ /Makefile2$/ {
      if (split($0, pair, ": ") == 2 && pair[1] ~ /^[^ #%]*all$/ && pair[2] ~ /^[^ ]*\/all$/) {
        needs[pair[1]] = needs[pair[1]] " " pair[2]
      }
      next
    }
    FILENAME ~ /\.json$/ {
      split($0, quoted, "\"")
      if (quoted[2] == "directory") place = substr(quoted[4] "/", length(folder) + 1)
      if (quoted[2] == "command" && match($0, / -o [^ ]*/)) object = place substr($0, RSTART + 4, RLENGTH - 4)
      if (quoted[2] == "file") source[object] = quoted[4]
      next
    }
    / Building [A-Z]+ object / { begun[$NF] = 1 }
    / Built target / { built[$NF] = 1 }
    END {
      for (rule in needs) if (rule ~ ("(^|/)CMakeFiles/" wanted "\\.dir/all$") || rule == wanted) visit(rule)
      for (object in source) {
        rule = object
        sub(/\.dir\/.*/, "", rule)
        if (!((rule ".dir/all") in seen)) continue
        work = 8000 + length_of(source[object])
        total += work
        if (rule_name(rule) in built || (object in begun && (getline line < (folder object)) >= 0)) done += work
        close(folder object)
      }
      if (total == 0) total = 1
      printf "%d %% of the work, %d of %d targets\n", 100 * done / total, finished, targets
    }' "$2/CMakeFiles/Makefile2" "$2/compile_commands.json" "$1"
}

# While the process lives: on a terminal one line that changes, else a line every half minute.
watch_build() {  # log, folder, target, process
  local started=$SECONDS next=0 text
  while sleep 1 >/dev/null 2>&1 && kill -0 "$4" 2>/dev/null; do
    if [ -t 1 ]; then
      printf '\r\033[K   %s, %s s' "$(build_progress "$1" "$2" "$3")" $((SECONDS - started))
    elif [ $((SECONDS - started)) -ge "$next" ]; then
      text=$(build_progress "$1" "$2" "$3")
      [ "$next" -eq 0 ] || printf '   %s, %s s\n' "$text" $((SECONDS - started))
      next=$((SECONDS - started + ${BUILD_PROGRESS_PAUSE:-30}))
    fi
  done
}

# Runs the command with its output in the log, and shows meanwhile how far it is; its exit code. The command stays in
# the foreground, where Ctrl-C reaches it.
with_progress() {  # log, folder, command …
  local log=$1 folder=$2 target=all watcher code=0
  shift 2
  [[ "$*" =~ --target\ ([^ ]+) ]] && target=${BASH_REMATCH[1]}
  : >"$log"
  watch_build "$log" "$folder" "$target" $$ &
  watcher=$!
  "$@" >"$log" 2>&1 </dev/null || code=$?
  kill "$watcher" 2>/dev/null || true
  wait "$watcher" 2>/dev/null || true
  [ ! -t 1 ] || printf '\r\033[K'
  return $code
}
