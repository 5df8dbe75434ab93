#!/usr/bin/env bash
# Installs what rayfarm is built with: Debian packages (packages.txt), as root or by sudo, and the browser app's npm
# packages. `deploy/setup.sh tests` also installs what only the tests need. Quick when all is there.
set -euo pipefail
here=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")" && pwd)
top=$(dirname -- "$here")
lists=("$here/packages.txt") npm_folders=("$top/master/web")
case ${1-} in
  "") ;;
  tests) lists+=("$here/packages-tests.txt") npm_folders+=("$top/tests/web") ;;
  *) echo "usage: deploy/setup.sh [tests]" >&2; exit 2 ;;
esac

mapfile -t wanted < <(sed 's/#.*//' "${lists[@]}" | xargs -n1)
# Where node comes from elsewhere it brings its npm along, which Debian's cannot stand beside.
if command -v node >/dev/null && command -v npm >/dev/null; then
  mapfile -t wanted < <(printf '%s\n' "${wanted[@]}" | grep -vx -e nodejs -e npm)
fi
declare -A installed
while read -r name status; do
  [ "$status" = installed ] && installed[$name]=yes
done < <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "${wanted[@]}" 2>/dev/null || true)
missing=()
for package in "${wanted[@]}"; do
  [ -n "${installed[$package]-}" ] || missing+=("$package")
done

install_npm_packages() {
  local folder
  for folder in "${npm_folders[@]}"; do
    [ "$folder/node_modules/.package-lock.json" -nt "$folder/package-lock.json" ] && continue
    echo "setup: installing the npm packages of $(basename -- "$(dirname -- "$folder")")/$(basename -- "$folder")" >&2
    # Not `npm ci`: npm 11 refuses a lock file without download addresses. The versions are those of the lock file.
    (cd -- "$folder" && npm install --no-save --no-fund --no-audit --loglevel=error >&2)
    touch -- "$folder/node_modules/.package-lock.json"
  done
}
if [ ${#missing[@]} = 0 ]; then
  install_npm_packages
  exit
fi

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
install_npm_packages
