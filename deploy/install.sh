#!/usr/bin/env bash
# Installs the Debian packages that are missing: install.sh build|test|run
#   build: what is needed to build and run; test: also what the tests need; run: only to run
set -euo pipefail

packages=(
  g++ cmake ninja-build ccache
  libboost1.81-dev nlohmann-json3-dev libtinygltf-dev libspdlog-dev libfmt-dev
  libcli11-dev libexpected-dev libsqlite3-dev libssl-dev libcurl4-openssl-dev ca-certificates
  libpng-dev libcadical-dev libeigen3-dev libmeshoptimizer-dev zlib1g-dev prometheus-cpp-dev
)
if [ "${1:-build}" = test ]; then
  packages+=(libgtest-dev curl openssl python3 python3-pytest python3-pytest-xdist
             python3-jsonschema chromium clang-format faketime slowhttptest)
  command -v npm >/dev/null || packages+=(nodejs npm)
fi

if [ "${1:-build}" = run ]; then
  packages=(ca-certificates libcurl4 libfmt9 libmeshoptimizer2d libpng16-16
            libprometheus-cpp-core1.0 libspdlog1.10 libsqlite3-0 libssl3 libtinygltf2d zlib1g)
fi

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

echo "installing: ${missing[*]}"
sudo=()
[ "$(id -u)" -eq 0 ] || sudo=(sudo)
"${sudo[@]}" apt-get update -qq
DEBIAN_FRONTEND=noninteractive "${sudo[@]}" apt-get install -y -qq --no-install-recommends "${missing[@]}"
