#!/usr/bin/env bash
# Builds a libFuzzer target with clang and runs it:
#
#   bash tests/fuzz/run.sh TARGET SECONDS [OPTION OF LIBFUZZER...]
#
# Begins with corpus/TARGET; what is found on the way is kept in build/fuzz/corpus/TARGET, an input
# that breaks something as build/fuzz/TARGET-crash-* (or -leak-, -timeout-, -oom-).
set -euo pipefail

root=$(cd "$(dirname "$0")/../.." && pwd)
cd "$root"
if [ $# -lt 2 ] || [ ! -f "tests/fuzz/targets/$1.cpp" ]; then
  sed -n '2,7p' "$0" >&2
  echo "targets: $(basename -s .cpp -a tests/fuzz/targets/*.cpp | tr '\n' ' ')" >&2
  exit 2
fi
target=$1 seconds=$2
shift 2
command -v clang++-16 >/dev/null || {
  echo "clang-16 and libclang-rt-16-dev are needed" >&2
  exit 2
}
[ -f build/fuzz/build.ninja ] || cmake --preset fuzz -DMODELSYNTH_TESTS=ON >/dev/null
cmake --build build/fuzz --target "fuzz_$target"
found=build/fuzz/corpus/$target
mkdir -p "$found"
# Both outputs of the code under test are closed: --config prints each fault it finds.
exec "build/fuzz/bin/fuzz_$target" -max_total_time="$seconds" -max_len=20000 -timeout=20 \
  -rss_limit_mb=4096 -close_fd_mask=3 -artifact_prefix="build/fuzz/$target-" "$@" "$found" \
  "tests/fuzz/corpus/$target"
