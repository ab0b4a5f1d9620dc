#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test. The last line counts them.
#
#   bash tests/run.sh [--quick | --thorough]
#
#   --quick     the release build alone, without the sanitizers
#   --thorough  every program and the server under AddressSanitizer, too: an hour
set -uo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root" || exit 1
quick=false
thorough=false
case ${1:-} in
  --quick) quick=true ;;
  --thorough) thorough=true ;;
  "") ;;
  *) sed -n '2,7p' "$0" >&2; exit 2 ;;
esac
results=$root/build/test-results
rm -rf "$results"
mkdir -p "$results"
touch "$results/broken"

step() { printf '\n=== %s (%s s)\n' "$1" "$SECONDS"; }

# Counts as a failure of its own when a step cannot even be run.
broken() { echo "failed: $*" | tee -a "$results/broken"; return 1; }
must() { "$@" || broken "$@"; }

build() {  # PRESET TARGET...
  local preset=$1
  shift
  step "build $preset"
  must cmake --preset "$preset" -DMODELSYNTH_TESTS=ON >"$results/$preset.configure.log" 2>&1 || { cat "$results/$preset.configure.log"; return 1; }
  must cmake --build --preset "$preset" --target "$@" >"$results/$preset.build.log" 2>&1 \
    || { tail -n 60 "$results/$preset.build.log"; return 1; }
}

# A program that works for minutes is run in parts: PROGRAM.1of2 is every second of its tests.
run_program() {  # PRESET PROGRAM[.PARTofPARTS]
  local preset=$1 part=$2 program=${2%%.*} code index=0 parts=1
  [ "$part" = "$program" ] || { index=${part#*.}; parts=${index#*of}; index=$((${index%of*} - 1)); }
  GTEST_TOTAL_SHARDS=$parts GTEST_SHARD_INDEX=$index "build/$preset/bin/$program" --gtest_brief=1 \
    --gtest_output="xml:$results/$preset.$part.xml" >"$results/$preset.$part.log" 2>&1
  code=$?
  step "$preset $part"
  cat "$results/$preset.$part.log"
  # 1 is that of failed tests, which the file counts; a sanitizer's report may stand beside tests
  # that passed.
  [ $code -le 1 ] && [ -s "$results/$preset.$part.xml" ] \
    || broken "$preset $part: exit code $code"
}

# Two at a time.
unit() {  # PRESET PROGRAM...
  local preset=$1 program
  shift
  for program in "$@"; do
    while [ "$(jobs -rp | wc -l)" -ge 2 ]; do
      wait -n
    done
    run_program "$preset" "$program" &
  done
  wait
}

service() {  # PRESET PYTEST-ARGUMENTS...
  local preset=$1 processes=2
  shift
  [ "$preset" = release ] && processes=3
  step "$preset service tests"
  # A file's tests stay in one process: they share a server, and what they measure of it.
  MODELSYNTH_BIN_DIR=$root/build/$preset/bin /usr/bin/python3 -m pytest -q -p no:cacheprovider \
    -n "$processes" --dist loadfile --junitxml="$results/$preset.service.xml" "$@"
  [ -s "$results/$preset.service.xml" ] || broken "$preset service tests"
}

# The service tests wait more than they work, so the next build runs meanwhile; what they print
# comes when they have ended.
beside() {  # COMMAND...
  "$@" >"$results/beside.log" 2>&1 &
  beside_pid=$!
}
join() {
  [ -n "${beside_pid:-}" ] || return 0
  wait "$beside_pid"
  cat "$results/beside.log"
  beside_pid=
}

step install
must bash deploy/install.sh test
export CCACHE_DIR=${CCACHE_DIR:-$HOME/.cache/modelsynth-ccache}

step format
# shellcheck disable=SC2046
must clang-format --dry-run -Werror $(git ls-files '*.h' '*.cpp')

programs=(solver_tests thread_tests wire_tests cli_tests fuzz_tests golden_tests store_tests
  jobs_tests ops_tests webhook_tests property_tests.1of2 property_tests.2of2)
build release all && {
  unit release "${programs[@]}"
  beside service release tests/layout tests/service
}
# AddressSanitizer is for what reads requests and computes, ThreadSanitizer for what runs on several
# threads, and that sees freed memory as well. Of the solver, AddressSanitizer sees what the property
# tests and the fuzzers reach, which is most of it; indices of vectors are checked in every build
# (_GLIBCXX_ASSERTIONS).
asan_programs=(property_tests.1of2 property_tests.2of2 fuzz_tests wire_tests)
if $thorough; then
  asan_programs=("${programs[@]}")
fi
if ! $quick; then
  # shellcheck disable=SC2046
  build asan $(printf '%s\n' "${asan_programs[@]%%.*}" | sort -u) \
    $($thorough && echo modelsynthd modelsynth)
  built=$?
  join
  export MODELSYNTH_SANITIZED=1 MODELSYNTH_CASES=60 MODELSYNTH_SOLID_PERCENT=10
  [ $built -eq 0 ] && {
    unit asan "${asan_programs[@]}"
    if $thorough; then
      beside service asan tests/service/test_hostile_http.py tests/service/test_websocket.py \
        tests/service/test_websocket_control.py tests/service/test_multi_stream.py \
        tests/service/test_examples_api.py tests/service/test_crash.py tests/service/test_tls.py \
        tests/service/test_access.py
    fi
  }
  build tsan thread_tests store_tests jobs_tests modelsynthd
  built=$?
  join
  # Of determinism eight workers alone: one and two take minutes and race less. Under this sanitizer
  # the servers work all the time, so no build runs beside them.
  [ $built -eq 0 ] && {
    unit tsan thread_tests store_tests jobs_tests
    service tsan tests/service/test_events.py tests/service/test_determinism.py \
      tests/service/test_jobs_api.py tests/service/test_waits_and_keys.py \
      tests/service/test_job_lists.py tests/service/test_websocket.py \
      tests/service/test_websocket_control.py tests/service/test_multi_stream.py \
      tests/service/test_submit_stream.py tests/service/test_hostile_http.py \
      tests/service/test_examples_api.py tests/service/test_access.py tests/service/test_tls.py \
      --deselect "tests/service/test_determinism.py::test_any_number_of_workers_makes_the_same_models[1]" \
      --deselect "tests/service/test_determinism.py::test_any_number_of_workers_makes_the_same_models[2]" \
      --deselect tests/service/test_tls.py::test_the_command_line_client_speaks_it
  }
fi

join
step summary
/usr/bin/python3 tests/summary.py "$(wc -l <"$results/broken")" "$results"/*.xml
