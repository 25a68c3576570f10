#!/usr/bin/env bash
# Measures what README and docs claim about the creatures: docs/figures.sh FOLDER
# Takes about a quarter of an hour on two cores; interrupted, it goes on where it stopped.
set -euo pipefail
timbre=$(cd "$(dirname "$0")/.." && pwd)/build/release/cli/timbre
mkdir -p "$1"
cd "$1"
[ -f remeshed/labels.txt ] || "$timbre" dataset make creatures -o . --force
"$timbre" db add creatures.timbre remeshed/*.ply --labels remeshed/labels.txt -q >added.txt

printf '\n| channel | mAP | NN | FT | ST | E | DCG |\n| --- | --- | --- | --- | --- | --- | --- |\n'
for channel in dna_weyl dna_log dna_raw gps_q; do
  "$timbre" eval retrieval creatures.timbre --channel $channel |
    awk -F '\t' -v channel=$channel '/^all queries/ {
      printf "| `%s` | %.3f | %.3f | %.3f | %.3f | %.3f | %.3f |\n", channel, $2, $3, $4, $5, $6, $7 }'
done
printf '\nMaps of timbre match, first 40 pairs:\n'
"$timbre" eval match remeshed -n 40 -o tensor.jsonl
printf '\nDescriptors and ZoomOut alone, the same pairs:\n'
"$timbre" eval match remeshed -n 40 -o functional.jsonl --method functional --samples 500
printf '\nSymmetries, two shapes of each species:\n'
[ -f two/remeshed/labels.txt ] || "$timbre" dataset make creatures -o two --sets remeshed --poses 2
"$timbre" eval match two/remeshed --kind sym -o symmetry.jsonl
