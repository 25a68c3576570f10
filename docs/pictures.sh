#!/usr/bin/env bash
# Draws the pictures of README and docs anew, from creatures made on the spot: docs/pictures.sh
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
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
# docs/operators.md: the gorilla coarse, its half refined by the example.
cmake --install "$root/build/release" --prefix "$work/installed" >/dev/null
build_example() {  # into $work/NAME/consumer
  cmake -S "$root/tests/consume" -B "$work/$1" -DCMAKE_BUILD_TYPE=Release \
    -DCMAKE_PREFIX_PATH="$work/installed" -DEXAMPLE="$root/docs/examples/$1.cpp" >/dev/null
  cmake --build "$work/$1" >/dev/null
}
build_example course_figures
"$timbre" dataset make creatures -o "$work/coarse" --sets remeshed --species gorilla --poses 2 \
  --resolution 1000 -q
"$timbre" dataset make ellipsoid -o "$work/ellipsoid.ply" --resolution 160 -q
"$timbre" dataset make rectangle -o "$work/plate.ply" --resolution 3000 -q
mkdir "$work/gorilla" "$work/ellipsoid"
"$work/course_figures/consumer" "$work/coarse/remeshed/gorilla0.ply" "$work/gorilla"
"$work/course_figures/consumer" "$work/ellipsoid.ply" "$work/ellipsoid"
for operator in graph robust; do
  draw "$work/gorilla/uneven.ply" -o "$pictures/uneven_$operator.png" --size 220 --view front \
    --operator $operator --eigenfunction 4 --lines 24
done
for elements in linear cubic; do
  draw "$work/ellipsoid/$elements.ply" -o "$pictures/elements_$elements.png" --size 260x220 \
    --view front --values "$work/ellipsoid/$elements.npy" --lines 14
done
for boundary in dirichlet neumann; do
  draw "$work/plate.ply" -o "$pictures/boundary_$boundary.png" --size 240x128 --view front \
    --boundary $boundary --eigenfunction 7 --lines 16
done
for letter in A B C D E; do
  draw "$work/gorilla/$letter.ply" -o "$pictures/filter_$letter.png" --size 150 --view front
done
# docs/filter.md
filter() { "$timbre" filter "$@" --force -q >/dev/null; }
for count in 10 40 160 640; do
  filter horse0.ply --low-pass $count -o low.ply
  draw low.ply -o "$pictures/low_pass_$count.png" --size 160 --view left
done
draw horse0.ply -o "$pictures/low_pass_all.png" --size 160 --view left
printf '0 1\n200 1\n600 2.5\n6000 2.5\n' >enhance.txt
filter gorilla0.ply --transfer enhance.txt -k 500 --detail keep -o enhanced.ply
filter gorilla0.ply --smooth 0.0005 -k 500 -o smooth.ply
draw gorilla0.ply -o "$pictures/transfer_none.png" --size 180 --view front
draw enhanced.ply -o "$pictures/transfer_enhanced.png" --size 180 --view front
draw smooth.ply -o "$pictures/transfer_smooth.png" --size 180 --view front
draw lizard0.ply -o "$pictures/fiedler.png" --size 260x180 --eigenfunction 1 --lines 24
filter horse0.ply --nodal 12 -o labels.npy
draw horse0.ply -o "$pictures/nodal.png" --size 220 --values labels.npy --colours categorical
build_example closed_curve
"$work/closed_curve/consumer" "$pictures"
ls -l "$pictures"
