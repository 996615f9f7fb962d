# shellcheck shell=bash
# Sourced by scripts/test: which tests a NAME means.

PYTEST_FOLDERS=(tests)

# Slow cases are marked where they stand: a gtest has `Nightly` in its name, a case of pytest the marker `nightly`, one of
# a rostest the decorator `nightly`, which looks at this environment; a whole CTest entry has the label `nightly`.
select_cases() {  # true: the nightly ones as well
  if [ "$1" = true ]; then
    export ROBOT_CONTROL_NIGHTLY=1
    unset GTEST_FILTER
    NIGHTLY_LABEL=
    PYTEST_CASES=()
  else
    unset ROBOT_CONTROL_NIGHTLY
    export GTEST_FILTER='-*Nightly*'
    NIGHTLY_LABEL=nightly
    # A case that waits for ever ends the run, which names it.
    PYTEST_CASES=(-m 'not nightly' --timeout=900 --timeout-method=thread --max-worker-restart=0)
  fi
}
select_cases false

# CTest entries that contain one of the names: test programs by their own name, rostests by that below tests/, for
# their full name, _ctest_robot_control_rostest_build_robot_control_tests_system_drives.test, contains the project's.
ctest_pattern() {  # NAME …
  local IFS='|'
  echo "^(_ctest_robot_control_rostest_(.*tests_.*)?|test_.*)?($*)"
}

pytest_expression() {  # NAME …
  local expression
  expression=$(printf ' or %s' "$@")
  echo "${expression# or }"
}

has_ctest_entry() {  # build folder, NAME
  local entries
  entries=$(cd "$1" && ctest -N -R "$(ctest_pattern "$2")" ${NIGHTLY_LABEL:+-LE "$NIGHTLY_LABEL"})
  ! grep -q '^Total Tests: 0$' <<<"$entries"
}

has_pytest_case() {  # NAME; a file that cannot be read may hold it: the run itself shows it
  local status=0 none=5
  $PYTHON -m pytest -q --collect-only "${PYTEST_FOLDERS[@]}" "${PYTEST_CASES[@]}" -k "$(pytest_expression "$1")" \
    >/dev/null 2>&1 </dev/null || status=$?
  [ $status -ne $none ]
}

no_such_test() {  # NAME
  fail "no test's name contains '$1'${NIGHTLY_LABEL:+; of those that scripts/test --nightly adds none was looked at}"
}
