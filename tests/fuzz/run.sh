#!/usr/bin/env bash
# Feeds mutated rawlogs to the reader, under the address and undefined-behaviour sanitizers.
#   tests/fuzz/run.sh [SECONDS]      60 by default; findings are in build/fuzz
# Needs clang with its fuzzer runtime (libclang-rt-14-dev); without it nothing is done.
set -euo pipefail
cd "$(dirname "$0")/../.."
seconds=${1:-60}
compiler=$(command -v clang++-14 || command -v clang++ || true)
out=build/fuzz
mkdir -p "$out/corpus"
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' > "$out/probe.cpp"
if [ -z "$compiler" ] || ! "$compiler" -fsanitize=fuzzer "$out/probe.cpp" -o "$out/probe" 2> "$out/probe.log"; then
  echo "no clang with a fuzzer runtime here: nothing done"
  exit 0
fi

includes=(-Imodules/core/include -Imodules/rawlog/include -isystem /usr/include/eigen3)
for folder in /usr/include/mrpt/*/include; do includes+=(-isystem "$folder"); done
libraries=()
for name in obs maps img poses math config containers expr io rtti serialization system core; do libraries+=("-lmrpt-$name"); done
echo "building..."
"$compiler" -std=c++17 -O1 -g -fsanitize=fuzzer,address,undefined -fno-sanitize=null,alignment,vptr \
  -fno-sanitize-recover=all "${includes[@]}" tests/fuzz/rawlog_fuzz.cpp modules/core/src/*.cpp \
  modules/rawlog/src/*.cpp modules/rawlog/src/velodyne/*.cpp "${libraries[@]}" -lz -ldl -pthread -o "$out/rawlog_fuzz"

gzip -dcf rawlogs/*.rawlog 2> /dev/null | head -c 40000 > "$out/corpus/seed" || true
printf '%s\n' '"\xa3mrpt::obs::CObservationVelodyneScan\x02"' '"\xa3mrpt::obs::CObservationRotatingScan\x00"' \
  '"\x9amrpt::obs::CObservationIMU\x04"' '"\x98mrpt::obs::CSensoryFrame\x02"' \
  '"\x9cmrpt::obs::CObservationImage\x04"' '"\x94mrpt::poses::CPose3D\x03"' '"\x88"' '"\xff\xff\xff\x7f"' > "$out/dictionary"
# MRPT is built without the sanitizer, which then sees wrong ends of vectors.
cd "$out"
ASAN_OPTIONS=detect_container_overflow=0 ./rawlog_fuzz -dict=dictionary -max_total_time="$seconds" -max_len=65536 \
  -rss_limit_mb=1000 -timeout=10 -print_final_stats=1 corpus
