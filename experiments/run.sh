#!/usr/bin/env bash
# All experiments of docs/results.md: simulates, runs every variant of the method, writes tables and plots, and
# puts them into docs/results.md. Each run leaves a file of its own, so that it goes on where it was stopped; results
# of other programs or method files are kept apart.
#   experiments/run.sh [-j JOBS] [-s SEEDS] [-o FOLDER] [-g "GROUPS"] [-n]
#     -j  jobs at a time (default: the cores there are)      -s  seeds of sweeps and starts (default 5)
#     -o  folder of results (default out/experiments)        -n  leave docs/ alone
#     -g  of: sweep recording cost sequence start (default: these), reality (ten scenarios with all that is wrong at
#         once; some 15 minutes a seed and core), slam (prints its table: slam.sh)
# Recordings that are not in the repository are taken from $TAUT_DATA (default ../shared/data) and left out, visibly,
# where they are absent.
set -euo pipefail
# shellcheck source=common.sh
. "$(dirname "$0")/common.sh"
jobs=$(nproc) seeds=5 out=$root/out/experiments groups="sweep recording cost sequence start" docs=yes
while getopts j:s:o:g:n option; do
  case $option in
    j) jobs=$OPTARG ;;
    s) seeds=$OPTARG ;;
    o) out=$OPTARG ;;
    g) groups=$OPTARG ;;
    n) docs=no ;;
    *) sed -n '2,/^set/{/^#/p}' "$0" >&2; exit 2 ;;
  esac
done
for program in slam simulate evaluate; do
  [ -x "$bin/taut-$program" ] || { echo "$bin/taut-$program is missing: build it first" >&2; exit 1; }
done
version=$(cat "$bin"/taut-{slam,simulate,evaluate} "$bin"/../lib/libtaut_*.so "$root"/config/{default,paper}.yaml \
  "$root"/experiments/{common,job}.sh | sha256sum | cut -c 1-12)
export RESULTS=$out/$version/results
mkdir -p "$RESULTS"
[ -s "$out/$version/commit" ] || git -C "$root" describe --always --dirty --abbrev=9 >"$out/$version/commit" || true
rm -rf "$out/$version"/work.*

recordings() {
  local name
  for name in hall_violent handheld_real_imu; do
    if [ -e "$data/$name.rawlog" ]; then echo "$name"; else echo "$name is absent from $data: left out" >&2; fi
  done
}

plan() { # the jobs of a group, one a line
  local prior place seed name
  case $1 in
    sweep)
      for seed in $(seq "$seeds"); do
        for prior in good bias consumer 100hz offset all; do echo "sweep $prior rate 180 $seed"; done
        for place in "rate "{60,500,0,360} "speed "{10,2,15,0.5,5}; do echo "sweep good $place $seed"; done
        for prior in bias consumer 100hz offset all; do
          for place in "rate 500" "speed 10"; do echo "sweep $prior $place $seed"; done
        done
      done ;;
    recording) for name in hall_fast $(recordings); do echo "recording $name"; done ;;
    sequence)
      for name in hall_violent corridor_walk corridor_narrow_view forest_flight street_vehicle stairwell_walk \
        hall_fast_rosette; do
        echo "sequence $name"
      done ;;
    start)
      for seed in $(seq "$seeds"); do
        for name in "street VLP-16" "street HDL-32E" "forest VLP-16" "forest HDL-32E" "flight OS1-64"; do
          echo "start $name $seed"
        done
      done ;;
    reality)
      for seed in $(seq "$seeds"); do
        for name in "$root"/config/scenarios/reality_*.yaml; do echo "reality $(basename "$name" .yaml) $seed"; done
      done ;;
    cost) for seed in $(seq "$seeds"); do for name in $(recordings | head -1); do echo "cost $name $seed"; done; done ;;
    *) echo "no such group: $1" >&2; return 1 ;;
  esac
}

failed=0
for group in $groups; do
  [ "$group" != slam ] || { "$root/experiments/slam.sh" -s "$seeds" -o "$out/slam" || failed=1; continue; }
  echo "$(date +%T) $group" >&2
  at_once=$jobs
  [ "$group" = cost ] && at_once=1 # the modes in turn, alone on the machine
  plan "$group" | xargs -P "$at_once" -L 1 "$root/experiments/job.sh" || failed=1
done
"$root/experiments/report.sh" "$out/$version" "$docs"
[ $failed -eq 0 ] || { echo "some jobs failed (above): run again to try them once more" >&2; exit 1; }
