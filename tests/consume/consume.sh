#!/usr/bin/env bash
# Installs timbre into an empty folder, builds the examples of the docs against it, runs them.
# consume.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cmake --install "$build" --prefix "$work/installed" >/dev/null
cmake -S "$source/tests/consume" -B "$work/build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$work/installed" -DEXAMPLE="$source/docs/examples/first_steps.cpp" >/dev/null
cmake --build "$work/build"
"$work/installed/bin/timbre" dataset make ellipsoid -o "$work/a.ply" --resolution 600
answer=$("$work/build/consumer" "$work/a.ply" "$work/a.ply")
echo "$answer"
grep -q "lambda_1 = " <<<"$answer"
grep -q "vertex 0 -> " <<<"$answer"

cmake -S "$source/tests/consume" -B "$work/figures" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$work/installed" -DEXAMPLE="$source/docs/examples/course_figures.cpp" >/dev/null
cmake --build "$work/figures"
"$work/figures/consumer" "$work/a.ply" "$work" | grep -q " vertices"
for file in linear.npy cubic.ply uneven.ply E.ply; do
  test -s "$work/$file"
done

cmake -S "$source/tests/consume" -B "$work/curve" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_PREFIX_PATH="$work/installed" -DEXAMPLE="$source/docs/examples/closed_curve.cpp" >/dev/null
cmake --build "$work/curve"
"$work/curve/consumer" "$work" | grep -q "^201 coefficients: error "
for file in curve_compression.svg curve_smoothing.svg; do
  test -s "$work/$file"
done
