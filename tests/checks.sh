# The checks of tests/run.sh that need a build of their own. It sources this
# file, and has set `jobs` and the functions step, configure and compile.

# install label: what is tested there is the installation, not the code.
left_out="slow|long|install"

# sanitizer_build FOLDER SANITIZERS OPTION...
# With -O1 the reports name the right lines, and the tests are quick enough.
sanitizer_build() {
  step "Packages"
  bash tutorials/install_dependencies.sh ccache clang libclang-rt-14-dev \
    libomp-dev llvm python3
  configure "$1" -DCMAKE_CXX_COMPILER=clang++ \
    -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 -gline-tables-only" \
    -DLOWLAP_SANITIZE="$2" "${@:3}"
}

# One build for the fuzzers and for the tests.
asan_build() {
  sanitizer_build build/asan address,undefined -DLOWLAP_BUILD_FUZZERS=ON
}

run_fuzz() {
  asan_build
  compile build/asan fuzzers lowlap_cli
  step "Inputs to start from"
  python3 tests/fuzz/make_corpus.py build/asan/src/cli/lowlap build/asan/corpus
  step "Fuzzing with $jobs jobs"
  FUZZ_JOBS=$jobs bash tests/fuzz/run_fuzzers.sh build/asan 60
}

run_sanitize() {
  asan_build
  compile build/asan all
  step "Testing under ASan and UBSan"
  UBSAN_OPTIONS=print_stacktrace=1 \
    ctest --test-dir build/asan --output-on-failure --parallel "$jobs" \
    --label-exclude "$left_out"

  # The libraries that start threads.
  local threaded=(core features matching scale averaging adjustment pipeline study)
  local programs=("${threaded[@]/#/lowlap_}")
  sanitizer_build build/tsan thread
  compile build/tsan "${programs[@]/%/_test}"
  step "Testing under TSan"
  TSAN_OPTIONS="suppressions=$PWD/tests/tsan_suppressions.txt" \
    ctest --test-dir build/tsan --output-on-failure --parallel "$jobs" \
    --label-exclude "$left_out" \
    --tests-regex "^($(IFS='|'; echo "${threaded[*]}"))\."
}

run_coverage() {
  step "Packages"
  bash tutorials/install_dependencies.sh ccache gcovr
  # -pthread: threads count without losing any. ccache does not know
  # -fprofile-update, which it stands for.
  configure build/coverage -DCMAKE_BUILD_TYPE=RelWithDebInfo \
    -DCMAKE_CXX_FLAGS_RELWITHDEBINFO="-O1 --coverage -pthread"
  compile build/coverage all
  # Counts add up over runs, and over a build that asks programs for their tests.
  find build/coverage -name '*.gcda' -delete
  step "Testing"
  ctest --test-dir build/coverage --output-on-failure --parallel "$jobs" \
    --label-exclude "$left_out"
  step "Lines of src/lowlap that the tests reach"
  gcovr --root . --filter src/lowlap/ --object-directory build/coverage \
    -j "$jobs" --sort-percentage --print-summary --fail-under-line 90 build/coverage
}
