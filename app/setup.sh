#!/bin/sh
# Installs what is missing on Debian 12 and builds AreaLab into build/. A second run finds nothing to do.
# Used by app/try.sh and tests/run.sh; `sh app/setup.sh test` also installs what only the tests need.
set -eu
cd "$(dirname "$0")/.."

packages="g++ cmake ninja-build pkg-config python3-glad libglm-dev libopenimageio-dev libassimp-dev
  libtomlplusplus-dev libtbb-dev libcli11-dev libfmt-dev libeigen3-dev nlohmann-json3-dev
  libembree-dev libdeflate-dev zlib1g-dev libegl-dev libosmesa6-dev libosmesa6 libegl1 libegl-mesa0 libgl1-mesa-dri libgtest-dev libgmock-dev
  libglfw3-dev libimgui-dev libstb-dev libgl1 libglx-mesa0 fonts-dejavu-core
  glmark2-data ca-certificates libvulkan-dev mesa-vulkan-drivers glslang-dev glslang-tools spirv-cross node-d3"
if [ "${1:-}" = test ]; then
  packages="$packages git chromium chromium-driver python3-selenium xvfb xdotool"
fi

missing=""
if command -v dpkg-query >/dev/null 2>&1; then
  for package in $packages; do
    [ "$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || missing="$missing $package"
  done
else
  missing=" $packages"
fi
if [ -n "$missing" ]; then
  missing=$(echo $missing)
  case "$(. /etc/os-release 2>/dev/null && echo "${ID:-}${VERSION_ID:-}")" in
    debian12) ;;
    *)
      echo "AreaLab promises Debian 12 only; elsewhere install the equivalents of: $missing" >&2
      exit 2
      ;;
  esac
  if [ "$(id -u)" = 0 ]; then
    sudo=""
  elif command -v sudo >/dev/null 2>&1; then
    sudo="sudo"
  else
    echo "missing packages; as root: apt-get install $missing" >&2
    exit 2
  fi
  echo "installing: $missing" >&2
  $sudo apt-get update -qq >&2
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing >&2
fi

[ -f build/build.ninja ] || cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON >&2
cmake --build build --parallel "$(nproc)" >&2  # more jobs than cores cost a seventh
