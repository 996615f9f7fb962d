# shellcheck shell=bash
# Sourced by scripts/test: which tests a NAME means.

PYTEST_FOLDERS=(tests/tools tests/loop tests/behaviour tests/docs)

# CTest entries that contain one of the names: test programs by their own name, rostests by that below tests/, for
# their full name, _ctest_robot_control_rostest_tests_system_drives.test, contains the project's.
ctest_pattern() {  # NAME …
  local IFS='|'
  echo "^(_ctest_robot_control_rostest_tests_.*|test_.*)?($*)"
}

pytest_expression() {  # NAME …
  local expression
  expression=$(printf ' or %s' "$@")
  echo "${expression# or }"
}

has_ctest_entry() {  # build folder, NAME
  local entries
  entries=$(cd "$1" && ctest -N -R "$(ctest_pattern "$2")")
  ! grep -q '^Total Tests: 0$' <<<"$entries"
}

has_pytest_case() {  # NAME; a file that cannot be read may hold it: the run itself shows it
  local status=0 none=5
  $PYTHON -m pytest -q --collect-only "${PYTEST_FOLDERS[@]}" -k "$(pytest_expression "$1")" \
    >/dev/null 2>&1 </dev/null || status=$?
  [ $status -ne $none ]
}

no_such_test() {  # NAME
  fail "no test's name contains '$1'"
}
