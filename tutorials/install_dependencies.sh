#!/usr/bin/env bash
# Installs what lowlap is built with, from Debian 12's packages. Further
# package names may be given. Does nothing, and needs no network, when all of
# them are installed already.
#
#   bash tutorials/install_dependencies.sh [PACKAGE...]
set -euo pipefail

packages=(
  g++ cmake ninja-build
  libeigen3-dev libceres-dev libsuitesparse-dev coinor-libclp-dev
  libopencv-dev libopencv-contrib-dev libexif-dev libjpeg-dev
  libflann-dev liblz4-dev
  nlohmann-json3-dev libcereal-dev libcli11-dev libexpected-dev
  zlib1g-dev libxxhash-dev libsqlite3-dev
  libgtest-dev libgmock-dev
  libjs-three
  "$@"
)

missing=()
for package in "${packages[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
if (( ${#missing[@]} == 0 )); then
  echo "All ${#packages[@]} packages are installed."
  exit 0
fi

as_root=()
if (( $(id -u) != 0 )); then
  if ! command -v sudo >/dev/null; then
    echo "Not root, and there is no sudo. As root, install: ${missing[*]}" >&2
    exit 1
  fi
  as_root=(sudo)
fi
echo "Installing ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -qq --no-install-recommends "${missing[@]}"
