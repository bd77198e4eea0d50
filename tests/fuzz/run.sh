#!/usr/bin/env bash
# Feeds every reader of taut with mutated inputs, under the address and undefined-behaviour sanitizers. Installs what
# is missing and builds first. README.md beside this tells more.
#   tests/fuzz/run.sh [--together] [SECONDS] [TARGET ...]
#   tests/fuzz/run.sh --ci
# SECONDS (60 by default) are those of each target; with --together, of all of them. As many targets run at once as
# there are processors (JOBS=N: N). --ci is a minute for the targets of foreign formats, which need less than half of
# the libraries. Prints the executions of each; inputs that are a finding are in build/fuzz/findings. The exit code is 1
# if there are any.
set -euo pipefail
cd "$(dirname "$0")/../.."
together=false
all=()
for file in tests/fuzz/targets/*.cpp; do all+=("$(basename "$file" .cpp)"); done
if [ "${1:-}" = --ci ]; then
  foreign=()
  for target in "${all[@]}"; do
    case "$target" in mesh | method | run_report | scenario) ;; *) foreign+=("$target") ;; esac
  done
  set -- --together 60 "${foreign[@]}"
fi
if [ "${1:-}" = --together ]; then together=true; shift; fi
seconds=60
if [[ "${1:-}" =~ ^[0-9]+$ ]]; then seconds=$1; shift; fi
jobs=${JOBS:-$(nproc)}
targets=("$@")
[ $# -gt 0 ] || targets=("${all[@]}")
for target in "${targets[@]}"; do
  [ -f "tests/fuzz/targets/$target.cpp" ] || { echo "$0: there is no target '$target'" >&2; exit 2; }
done
if $together; then
  seconds=$((seconds * jobs / ${#targets[@]}))
  [ "$seconds" -gt 0 ] || seconds=1
fi

cmake/install-dependencies.sh --fuzz
cmake --preset fuzz
cmake --build --preset fuzz -j "$jobs" --target fuzz_seeds "${targets[@]/#/fuzz_}"

out=build/fuzz
for target in "${targets[@]}"; do rm -f "$out/logs/$target".*; done
rm -rf "$out/seeds"
mkdir -p "$out/findings" "$out/logs"
export TMPDIR
TMPDIR=$(mktemp -d "$([ -w /dev/shm ] && echo /dev/shm || echo /tmp)/taut_fuzz.XXXXXX")
trap 'rm -rf "$TMPDIR"' EXIT
# MRPT is built without the sanitizer, which then sees wrong ends of vectors.
export ASAN_OPTIONS=detect_container_overflow=0:quarantine_size_mb=64 LSAN_OPTIONS=suppressions=$PWD/cmake/lsan.supp
export UBSAN_OPTIONS=print_stacktrace=1 ASAN_SYMBOLIZER_PATH=/usr/bin/llvm-symbolizer-14
"$out/bin/fuzz_seeds" "$out/seeds" .

# run_target TARGET: its exit code goes to logs/TARGET.code
run_target() {
  local target=$1 dictionary=tests/fuzz/dictionaries/$1.dict code=0
  local arguments=(-max_total_time="$seconds" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=512 -print_final_stats=1
                   -artifact_prefix="$out/findings/$target-")
  [ ! -f "$dictionary" ] || arguments+=(-dict="$dictionary")
  mkdir -p "$out/corpus/$target"
  "$out/bin/fuzz_$target" "${arguments[@]}" "$out/corpus/$target" "$out/seeds/$target" \
    > "$out/logs/$target.log" 2>&1 || code=$?
  echo "$code" > "$out/logs/$target.code"
}
export -f run_target
export seconds out
echo "${#targets[@]} targets, $seconds s each, $jobs at once"
printf '%s\n' "${targets[@]}" | xargs -P "$jobs" -I {} bash -c 'run_target {}'

findings=0
printf '%-18s %12s %8s %8s\n' target executions inputs edges
for target in "${targets[@]}"; do
  log=$out/logs/$target.log
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  edges=$(grep -oE 'cov: [0-9]+' "$log" | tail -1 | cut -d' ' -f2 || true)
  verdict=
  if [ "$(cat "$out/logs/$target.code")" != 0 ]; then
    findings=$((findings + 1))
    verdict="FINDING: $(grep -m1 -oE 'SUMMARY: .*' "$log" || tail -1 "$log") (see $log)"
  fi
  printf '%-18s %12s %8s %8s %s\n' "$target" "${executions:-?}" "$(find "$out/corpus/$target" -type f | wc -l)" \
    "${edges:-?}" "$verdict"
done
echo "$findings of ${#targets[@]} targets have a finding"
[ "$findings" -eq 0 ]
