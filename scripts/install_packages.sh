#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# install_packages.sh [--with-checks]: installs what packaging/system-packages.txt lists and the machine lacks.
# Says nothing and touches nothing when all is there. Needs Debian's apt-get, and root or sudo when something is missing.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
list=$root/packaging/system-packages.txt
with_checks=${1:-}

wanted=() group=always
while read -r line; do
  case $line in
    "# group: "*) group=${line#"# group: "} ;;
    "" | "#"*) ;;
    *) if [ "$group" != check ] || [ "$with_checks" = --with-checks ]; then wanted+=("$line"); fi ;;
  esac
done <"$list"

if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
  echo "install_packages: not a Debian system; make sure that you have the equivalents of: ${wanted[*]}" >&2
  exit 0
fi

# A name may also be provided by another package (libjpeg-dev, pkg-config), which dpkg -l does not tell.
installed=$(dpkg-query -W -f='${db:Status-Status} ${Package} ${Provides}\n' 2>/dev/null |
  sed -n 's/^installed //p' | sed 's/([^)]*)//g; s/,/ /g' | tr ' ' '\n' | sort -u)
missing=()
for package in "${wanted[@]}"; do
  grep -qxF "$package" <<<"$installed" || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  command -v sudo >/dev/null || {
    echo "install_packages: as root, run: apt-get install -y --no-install-recommends ${missing[*]}" >&2
    exit 1
  }
  as_root=(sudo)
fi
echo "Installing ${#missing[@]} system packages: ${missing[*]}"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
run_apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 apt-get -q -o Acquire::Retries=3 -o DPkg::Lock::Timeout=300 \
    -o Dpkg::Use-Pty=0 "$@" </dev/null >"$log" 2>&1 || {
    tail -n 25 "$log" >&2
    echo "install_packages: apt-get $1 failed (its last lines are above)" >&2
    exit 1
  }
}
run_apt update
run_apt install -y --no-install-recommends "${missing[@]}"
