#!/bin/sh
# Makes the README's pictures: compare/report/overview.png, the report's first screen in headless Chromium, and
# app/view/window.png, the window under Xvfb. `sh app/picture.sh window` makes the latter alone.
set -eu
sh "$(dirname "$0")/setup.sh" test
cd "$(dirname "$0")/.."
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

python3 tests/app/view_test.py build/bin/arealab "$work/view" ViewTest.test_picture_of_the_readme
mv "$work/view/window.png" app/view/window.png
[ "${1:-}" != window ] || exit 0

build/bin/arealab compare gloss mirror spheres scan sixteen --size 384x384 --out "$work/out"
chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking \
  --disable-component-update --disable-sync --hide-scrollbars --user-data-dir="$work/profile" \
  --window-size=1280,1690 --virtual-time-budget=20000 --screenshot="$work/overview.png" "file://$work/out/index.html"
mv "$work/overview.png" compare/report/overview.png
