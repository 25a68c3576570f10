#!/usr/bin/env bash
# From a bare Debian machine to a page worth looking at, demo/report.html: ./demo.sh
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

say "1. Shapes: five kinds of creatures, each individual in a pose and in triangles of its own"
run dataset make creatures -o demo/creatures --sets remeshed --poses 4 --resolution 4500 \
  --species person,gorilla,horse,cat,ostrich --quiet
run info $shapes/person1.ply

say "2. A database of what they sound like"
run db add demo/creatures.timbre $shapes/*.ply --labels $shapes/labels.txt | tail -n 3
run db verify demo/creatures.timbre

say "3. What else looks like this one, in any pose?"
run query demo/creatures.timbre --stored gorilla1 -n 5
run eval retrieval demo/creatures.timbre

say "4. Which point of one is which point of the other?"
run match $shapes/person1.ply $shapes/person2.ply -o demo/person1_to_person2.txt
run eval match $shapes -n 2 -o demo/maps.jsonl --save-maps demo/maps
run eval match $shapes --kind sym -n 1 -o demo/mirrors.jsonl --save-maps demo/mirrors

say "5. One page of all that"
run report demo/creatures.timbre -o demo/report.html --set $shapes --matches demo/maps.jsonl \
  --maps demo/maps --symmetries demo/mirrors.jsonl --symmetry-maps demo/mirrors

cat <<'END'

What happened
  timbre made a folder of creatures, computed the lowest eigenvalues of the
  Laplace-Beltrami operator of each (what the shape "sounds like"), stored them in
  one file, ranked the others by likeness to one of them, mapped one individual onto
  another, vertex by vertex, and measured how right all that is against the truth.
Where it is
  demo/report.html              look here first, in any browser
  demo/creatures/remeshed/      meshes, labels.txt, truth
  demo/creatures.timbre         the database
  demo/person1_to_person2.txt   line i: the vertex of person2 for vertex i of person1
What to try next, with your own meshes
  build/release/cli/timbre info MESH
  build/release/cli/timbre db add my.timbre FOLDER/*.ply
  build/release/cli/timbre report my.timbre -o my.html
  build/release/cli/timbre match A.ply B.ply -o map.txt
END
