#!/usr/bin/env bash
# Fuzzes for a while: tests/fuzz/run.sh SECONDS [TARGET...]; all targets one after the other if
# none is named. Needs clang++. What it finds stays in build/fuzz/findings; the corpus grows in
# build/fuzz/corpus from run to run. TIMBRE_FUZZ_SEEDS names a folder of more files to start from;
# they are only read, and then all goes to build/fuzz/corpus-seeded, so that nothing of them is
# ever packed.
set -euo pipefail
[[ ${1:-} =~ ^[0-9]+$ ]] || { sed -n '2,6s/^# //p' "$0"; exit 2; }
seconds=$1
shift
cd "$(dirname "$0")/../.."
here=tests/fuzz build=build/fuzz
corpus=$build/corpus${TIMBRE_FUZZ_SEEDS:+-seeded}

if [ $# -eq 0 ]; then
  for file in "$here"/inputs/*.inputs; do set -- "$@" "$(basename "$file" .inputs)"; done
fi
cmake --preset fuzz >/dev/null
cmake --build "$build" --target $(printf 'fuzz_%s ' "$@")

# Several formats share a dictionary: stl_text and stl_binary have that of stl.
dictionary_of() {
  local file
  for file in "$here/dictionaries/$1.dict" "$here/dictionaries/${1%%_*}.dict"; do
    [ -f "$file" ] && { echo "-dict=$file"; return; }
  done
  true
}

mkdir -p "$build/findings"
failed=()
for target; do
  own=$corpus/$target
  /usr/bin/python3 "$here/inputs.py" unpack "$here/inputs/$target.inputs" "$own"
  limits=(-rss_limit_mb=1024 -malloc_limit_mb=96 -timeout=5 -max_len=4096)
  "$build/$here/fuzz_$target" "${limits[@]}" $(dictionary_of "$target") \
    -max_total_time="$seconds" -print_final_stats=1 -artifact_prefix="$build/findings/$target-" \
    "$own" ${TIMBRE_FUZZ_SEEDS:+"$TIMBRE_FUZZ_SEEDS"} || failed+=("$target")

  least=$corpus/$target.least
  rm -rf "$least"
  mkdir -p "$least"
  "$build/$here/fuzz_$target" "${limits[@]}" -merge=1 "$least" "$own" 2>&1 | tail -n 1
  [ -n "${TIMBRE_FUZZ_SEEDS:-}" ] ||
    echo "To store the minimised corpus: $here/inputs.py pack $here/inputs/$target.inputs $least"
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "Findings of ${failed[*]} in $build/findings. Make one small, and keep it beside its repair:" >&2
  echo "  $build/$here/fuzz_TARGET -minimize_crash=1 -runs=10000 FILE" >&2
  echo "  $here/inputs.py keep $here/inputs/TARGET.inputs FILE" >&2
  exit 1
fi
