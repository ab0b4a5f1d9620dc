#!/usr/bin/env bash
# Counts the instructions of one small solve (one_solve.cpp) and compares them with
# instructions.txt: unlike times, they are the same whatever else runs. Needs valgrind.
#
#   bash tests/bench/instructions.sh [--update]
#
#   --update  writes what was counted to instructions.txt
#
# Exit code 1 when more than 10 % over what is recorded. Looks for the program in
# build/release/bin, or in MODELSYNTH_BIN_DIR.
set -euo pipefail

here=$(cd "$(dirname "$0")" && pwd)
program=${MODELSYNTH_BIN_DIR:-$here/../../build/release/bin}/one_solve
record=$here/instructions.txt
tolerance_percent=10
update=false
case ${1:-} in
  --update) update=true ;;
  "") ;;
  *) sed -n '2,10p' "$0" >&2; exit 2 ;;
esac
command -v valgrind >/dev/null || { echo "valgrind is not installed" >&2; exit 2; }
[ -x "$program" ] || { echo "$program is missing: build the preset release" >&2; exit 2; }

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

count() {  # LEVEL
  valgrind --tool=callgrind --toggle-collect=counted_solve \
    --callgrind-out-file="$scratch/$1.out" "$program" "$1" >"$scratch/$1.log" 2>&1 || return
  awk '$1 == "totals:" { print $2 }' "$scratch/$1.out"
}

code=0
for level in portable avx2; do
  status=0
  counted=$(count "$level") || status=$?
  recorded=$(awk -v level="$level" '$1 == level { print $2 }' "$record" 2>/dev/null || true)
  if [ "$status" -eq 3 ]; then
    echo "$level: this processor does not have it"
    counted=$recorded
  elif [ "$status" -ne 0 ] || [ "${counted:-0}" -eq 0 ]; then
    cat "$scratch/$level.log" >&2
    exit 2
  elif [ -z "$recorded" ]; then
    echo "$level: $counted instructions, nothing recorded"
    $update || code=1
  else
    awk -v level="$level" -v counted="$counted" -v recorded="$recorded" 'BEGIN {
      printf "%s: %d instructions, recorded %d (%+.1f %%)\n",
        level, counted, recorded, 100 * (counted - recorded) / recorded }'
    if ! $update && [ $((counted * 100)) -gt $((recorded * (100 + tolerance_percent))) ]; then
      echo "$level: more than $tolerance_percent % over" >&2
      code=1
    fi
  fi
  [ -z "$counted" ] || echo "$level $counted" >>"$scratch/counted"
done
if $update; then
  {
    echo "# Instructions of one_solve by the vector level it may use, as instructions.sh counts them:"
    echo "# release preset, g++ $(g++ -dumpfullversion), glibc $(getconf GNU_LIBC_VERSION | cut -d' ' -f2)."
    cat "$scratch/counted"
  } >"$record"
fi
exit $code
