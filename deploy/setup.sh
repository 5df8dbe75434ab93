#!/usr/bin/env bash
# Installs the Debian packages that rayfarm is built with (packages.txt), as root or by sudo. Quick when all are there.
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)

mapfile -t wanted < <(sed 's/#.*//' "$here/packages.txt" | xargs -n1)
declare -A installed
while read -r name status; do
  [ "$status" = installed ] && installed[$name]=yes
done < <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null || true)
missing=()
for package in "${wanted[@]}"; do
  [ -n "${installed[$package]-}" ] || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  if ! command -v sudo >/dev/null; then
    echo "setup: ${#missing[@]} packages are missing; run deploy/setup.sh as root, or install sudo:" >&2
    echo "  ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi

# A freshly started Debian often runs apt by itself: wait for it.
apt_get() { "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -o DPkg::Lock::Timeout=300 "$@"; }

echo "setup: installing ${#missing[@]} packages: ${missing[*]}" >&2
for try in 1 2 3; do
  apt_get -o Acquire::Retries=3 update >&2 && break
  [ $try = 3 ] && exit 1
  sleep 10
done
apt_get -o Acquire::Retries=3 install -y --no-install-recommends "${missing[@]}" >&2
