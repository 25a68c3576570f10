#!/usr/bin/env bash
# Draws the pictures of README and docs anew, from creatures made on the spot: docs/pictures.sh
set -euo pipefail
cd "$(dirname "$0")/.."
timbre=$PWD/build/release/cli/timbre
pictures=$PWD/docs/pictures
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

"$timbre" dataset make creatures -o . --sets remeshed --force --poses 4 -q
cd remeshed
draw() { "$timbre" render "$@" --force -q >/dev/null; }

for name in person1 gorilla2 horse3 kangaroo1 octopus3 elephant1 ostrich2 cat3; do
  draw $name.ply -o "$pictures/$name.png" --size 160
done
for number in 1 3 6 12; do
  draw horse0.ply -o "$pictures/eigenfunction$number.png" --size 220 --eigenfunction $number
done
for time in 5 30 60; do
  draw horse0.ply -o "$pictures/hks$time.png" --size 220 --signature hks --column $time
done
"$timbre" match person1.ply person2.ply -o map.txt -q
draw person1.ply --map map.txt --onto person2.ply -o "$pictures/match.png" --size 300
"$timbre" distance gorilla1.ply --vertices 0 -o d.npy -q
draw gorilla1.ply -o "$pictures/distance.png" --size 300 --values d.npy --colours sequential \
  --lines 14 --markers 0
ls -l "$pictures"
