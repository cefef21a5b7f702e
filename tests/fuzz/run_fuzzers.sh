#!/usr/bin/env bash
# Runs fuzzers, prints what each did, and fails if there is a finding.
#
#   tests/fuzz/run_fuzzers.sh BUILD SECONDS [FUZZER...]
#
# BUILD holds the programs, and in corpus/FUZZER the inputs to start from, to
# which those that reach something new are added; a second run goes on from
# them. Inputs of findings are written to BUILD/findings, logs to BUILD/fuzz.
# Without names all fuzzers are run, FUZZ_JOBS at a time (default: one per core).
set -euo pipefail

build=$(realpath "${1:?the build folder is missing}")
seconds=${2:?the number of seconds is missing}
fuzzers=("${@:3}")
if (( ${#fuzzers[@]} == 0 )); then
  for program in "$build"/tests/fuzz/*_fuzzer; do
    fuzzers+=("$(basename "$program" _fuzzer)")
  done
fi

# The files of an input are written anew each time: in memory, if possible.
shared_memory=/dev/shm
[[ -w $shared_memory ]] || shared_memory=${TMPDIR:-/tmp}
TMPDIR=$(mktemp -d "$shared_memory/lowlap_fuzz.XXXXXX")
trap 'rm -rf "$TMPDIR"' EXIT
export TMPDIR
export ASAN_OPTIONS=quarantine_size_mb=16
export UBSAN_OPTIONS=print_stacktrace=1

run_one() {
  local build=$1 seconds=$2 name=$3
  local log=$build/fuzz/$name.log result=ok
  mkdir -p "$build/corpus/$name" "$build/findings" "$build/fuzz"
  # Nothing below a megabyte may take more than a gigabyte or ten seconds.
  "$build/tests/fuzz/${name}_fuzzer" "$build/corpus/$name" \
    -max_total_time="$seconds" -max_len=1000000 -timeout=10 \
    -rss_limit_mb=1024 -print_final_stats=1 \
    -artifact_prefix="$build/findings/$name-" >"$log" 2>&1 || result=FINDING
  local runs
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  printf '%-18s %12s executions  %s\n' "$name" "${runs:-0}" "$result"
  [[ $result == ok ]] && return
  grep -E 'ERROR:|runtime error:|finding:|SUMMARY:|Test unit written' "$log" |
    sed 's/^/    /' || true
  printf '    log: %s\n' "$log"
  return 1
}
export -f run_one

printf '%s\n' "${fuzzers[@]}" |
  xargs -P "${FUZZ_JOBS:-$(nproc)}" -I{} \
    bash -c 'run_one "$@"' run_one "$build" "$seconds" {}
