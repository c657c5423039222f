#!/bin/sh
# Makes the README's picture, compare/report/overview.png: the report's first screen, in headless Chromium.
set -eu
sh "$(dirname "$0")/setup.sh" test
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
build/bin/arealab compare gloss mirror spheres scan sixteen --size 384x384 --out "$work/out"
chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking \
  --disable-component-update --disable-sync --hide-scrollbars --user-data-dir="$work/profile" \
  --window-size=1280,1690 --virtual-time-budget=20000 --screenshot="$work/overview.png" "file://$work/out/index.html"
mv "$work/overview.png" compare/report/overview.png
