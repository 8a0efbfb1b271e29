#!/usr/bin/env bash
# Installs the Debian 12 packages that chiaro is built on, and those named as arguments, where they are missing. Works as
# root and with sudo.
set -euo pipefail
packages=(g++ cmake ninja-build python3 libembree-dev libopenimageio-dev openimageio-tools libpng-dev libwebp-dev libavif-dev libopenexr-dev libopencolorio-dev libtinygltf-dev
  libceres-dev libeigen3-dev libtbb-dev libcli11-dev nlohmann-json3-dev libfmt-dev libnanoflann-dev libdraco-dev libmeshoptimizer-dev libgtest-dev libbenchmark-dev
  libjs-three libjs-chart.js "$@")

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
if [ ${#missing[@]} -eq 0 ]; then
  echo "chiaro: all packages are installed"
  exit 0
fi
echo "chiaro: installing ${missing[*]}"
run=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "chiaro: error: not root and no sudo: install as root: ${missing[*]}" >&2; exit 1; }
  run=(sudo)
fi
"${run[@]}" apt-get update -qq
"${run[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
