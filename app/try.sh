#!/bin/sh
# The main job in one command: installs what is missing, builds, compares every technique with the truth on the
# built-in scenes, and prints where the report is. Arguments go to `arealab compare`.
set -eu
sh "$(dirname "$0")/setup.sh"
cd "$(dirname "$0")/.."
exec build/bin/arealab compare --out out "$@"
