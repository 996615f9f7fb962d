# shellcheck shell=bash
# Sourced first by scripts/test and .ci/run: starts the script again without the caller's environment, in which a variable
# may hide what fails on another machine. Programs are Debian's alone, Python modules not those of ~/.local.

# What still passes: the user, the terminal, how the network is reached, where PyPI is, the folders of recorded data,
# and a compiler's launcher.
KEPT='HOME|USER|LOGNAME|TERM|CI|(https?|ftp|no|HTTPS?|FTP|NO)_(proxy|PROXY)|PIP_.*|(SSL_CERT|REQUESTS_CA|CURL_CA)_[A-Z]+|ROBOT_(RECORDINGS|CORPUS|QUADRUPEDS)|CMAKE_C(XX)?_COMPILER_LAUNCHER|CCACHE_.*'

# The process id is that of the script which was started again already: a script that it calls has another one.
if [ "${CLEAN_ENVIRONMENT-}" != $$ ]; then
  mapfile -d '' -t kept < <(env -0 | grep -zE "^($KEPT)=")
  exec env -i "${kept[@]}" PATH=/usr/bin:/bin:/usr/sbin:/sbin LANG=C.UTF-8 PYTHONNOUSERSITE=1 CLEAN_ENVIRONMENT=$$ \
    /bin/bash "$0" "$@"
fi
unset CLEAN_ENVIRONMENT
