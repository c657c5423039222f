#!/bin/sh
# Installs what is missing, builds, and runs every test. Arguments go to ctest, e.g. `sh tests/run.sh -R glsl`.
set -eu
sh "$(dirname "$0")/../app/setup.sh" test
cd "$(dirname "$0")/.."
exec ctest --test-dir build --output-on-failure --parallel 2 "$@"
