#!/usr/bin/env bash
# From a bare Debian machine to a green test summary: ./test.sh [PRESET]
# PRESET is one of CMakePresets.json: release (default), dev, asan, tsan, coverage, no-cholmod.
set -euo pipefail
cd "$(dirname "$0")"
. .ci/prepare.sh

preset=${1:-release}
install_packages packages.txt
[ "$preset" = release ] || install_packages packages-dev.txt
configure_and_build "$preset"
say "Testing ($preset)"
ctest --test-dir "build/$preset" --parallel "$(nproc)" --output-on-failure --progress
