#!/usr/bin/env bash
# From a bare Debian machine to a database, a query and a map: ./demo.sh
set -euo pipefail
cd "$(dirname "$0")"
. .ci/prepare.sh

install_packages packages.txt
configure_and_build release --target timbre_command
timbre=$PWD/build/release/cli/timbre
shapes=demo/creatures/remeshed
rm -rf demo
mkdir -p demo

# Shows a command as one would type it, then runs it.
run() {
  printf '\n$ timbre %s\n' "$*"
  "$timbre" "$@"
}

say "1. Shapes: bodies with joints, each in several poses, vertices shuffled"
run dataset make creatures -o demo/creatures --sets remeshed --poses 6 --quiet
ls $shapes | head -n 4
run info $shapes/person0.ply

say "2. A database of what they sound like"
run db add demo/shapes.timbre $shapes/*.ply --labels $shapes/labels.txt | tail -n 3
run db verify demo/shapes.timbre

say "3. What else looks like this one, in any pose?"
run query demo/shapes.timbre --stored person0 -n 6
run eval retrieval demo/shapes.timbre

say "4. Which point of one is which point of the other?"
run match $shapes/person0.ply $shapes/person3.ply -o demo/person0_to_person3.txt
run symmetry $shapes/person0.ply -o demo/person0_mirror.txt

cat <<'END'

What happened
  timbre made a folder of creatures, computed the lowest eigenvalues of the
  Laplace-Beltrami operator of each (what the shape "sounds like"), stored them in
  one file, ranked the others by likeness to one of them, and mapped one pose onto
  another, vertex by vertex.
Where it is
  demo/shapes/                  meshes, labels.txt, ground truth
  demo/shapes.timbre            the database
  demo/person0_to_person3.txt   line i: the vertex of person3 for vertex i of person0
  demo/person0_mirror.txt       line i: the mirror image of vertex i
What to try next, with your own meshes
  build/release/cli/timbre info MESH
  build/release/cli/timbre db add my.timbre FOLDER/*.ply
  build/release/cli/timbre query my.timbre MESH
  build/release/cli/timbre match A.ply B.ply -o map.txt
END
