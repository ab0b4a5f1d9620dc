#!/usr/bin/env bash
# From nothing to a castle: installs what is missing, builds, starts the server, makes a castle
# through its public API, writes castle.glb and keeps serving.
#
#   bash deploy/run.sh [--once] [--listen ADDRESS:PORT] [--data DIR] [--out FILE]
#
#   --once  ends the server when the castle is there
set -euo pipefail

once=false
listen=127.0.0.1:8080
root=$(cd "$(dirname "$0")/.." && pwd)
data=$root/data
out=$PWD/castle.glb
while [ $# -gt 0 ]; do
  case $1 in
    --once) once=true ;;
    --listen) listen=$2; shift ;;
    --data) data=$2; shift ;;
    --out) out=$2; shift ;;
    *) sed -n '2,7p' "$0" >&2; exit 2 ;;
  esac
  shift
done

bash "$root/deploy/install.sh" build
cd "$root"
cmake --preset release -DMODELSYNTH_TESTS=OFF >/dev/null
cmake --build --preset release --target modelsynthd modelsynth
bin=$root/build/release/bin

# The server's first line tells its address, the port too where 0 was asked for.
address_file=$(mktemp)
"$bin/modelsynthd" --data "$data" --listen "$listen" >"$address_file" &
server=$!
cleanup() {
  kill "$server" 2>/dev/null || true
  wait "$server" 2>/dev/null || true
  rm -f "$address_file"
}
trap cleanup EXIT
trap 'exit 130' INT
trap 'exit 143' TERM
for _ in $(seq 100); do
  grep -q '^listening on ' "$address_file" && break
  kill -0 "$server" 2>/dev/null || { echo "the server did not start" >&2; exit 1; }
  sleep 0.1
done
url=$(sed -n 's/^listening on //p' "$address_file")
[ -n "$url" ] || { echo "the server did not tell its address" >&2; exit 1; }

"$bin/modelsynth" submit --server "$url" --example castle --size 40x10x40 --seed 7 -o "$out"
echo "the castle is in $out"
if $once; then
  exit 0
fi
echo "serving on $url; data in $data; end with Ctrl-C"
wait "$server"
