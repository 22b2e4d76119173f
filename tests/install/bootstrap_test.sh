#!/usr/bin/env bash
# tools/bootstrap installs what is missing, with sudo if it must, and does nothing twice. dpkg-query,
# id, sudo and apt-get are played by scripts that write down how they are called.
# usage: bootstrap_test.sh SOURCE_DIRECTORY
set -euo pipefail
bootstrap=$1/tools/bootstrap
directory=$(mktemp -d)
trap 'rm -rf "$directory"' EXIT
bin=$directory/bin
mkdir "$bin"
calls=$directory/calls

play() { # play NAME 'SCRIPT'
  printf '#!/bin/bash\n%s\n' "$2" >"$bin/$1"
  chmod +x "$bin/$1"
}

fail() {
  echo "FAILED: $*" >&2
  cat "$directory/out" "$calls" >&2 2>/dev/null || true
  exit 1
}

# run USER_ID MISSING_PACKAGE: what bootstrap says goes to out, what it calls to calls.
run() {
  : >"$calls"
  play id "echo $1"
  play dpkg-query "for last; do :; done; [ \"\$last\" = '$2' ] || echo 'install ok installed'"
  code=0
  PATH=$bin:/usr/bin:/bin bash "$bootstrap" deps >"$directory/out" 2>&1 || code=$?
}

says() { grep -qF -- "$1" "$directory/out" || fail "it does not say: $1"; }
called() { grep -qxF -- "$1" "$calls" || fail "it does not call: $1"; }

play apt-get "echo \"apt-get \$*\" >>'$calls'"
play sudo "echo \"sudo \$*\" >>'$calls'; \"\$@\""

run 0 none
[ "$code" -eq 0 ] || fail "exit code $code with nothing missing"
says "All needed Debian packages are installed."
[ ! -s "$calls" ] || fail "it installs although nothing is missing"

run 0 libeigen3-dev
[ "$code" -eq 0 ] || fail "exit code $code as root"
says "Installing from Debian: libeigen3-dev"
called "apt-get install -y -q --no-install-recommends libeigen3-dev"
! grep -q sudo "$calls" || fail "root needs no sudo"

run 1000 libgtest-dev
[ "$code" -eq 0 ] || fail "exit code $code as a user with sudo"
called "sudo apt-get update -q"
called "apt-get install -y -q --no-install-recommends libgtest-dev"

if ! [ -x /usr/bin/sudo ] && ! [ -x /bin/sudo ]; then
  rm "$bin/sudo"
  run 1000 libgtest-dev
  [ "$code" -eq 5 ] || fail "exit code $code without sudo, not 5"
  says "Packages are missing and there is no sudo. As root, run:"
  says "apt-get install -y libgtest-dev"
fi
echo "passed"
