#!/usr/bin/env bash
# Builds lowlap in build/ci and tests it, on a fresh Debian 12 machine too: the
# packages are installed first, as root or through sudo.
#
#   tests/run.sh             install, check the formatting, build, test
#   tests/run.sh --tidy      cppcheck and clang-tidy on the sources as well (some
#                            minutes more)
#   tests/run.sh --no-slow   without the tests that work on photographs
#   tests/run.sh --long      those that count over many simulated scenes, adjust
#                            much, or kill and interrupt very often, as well (a
#                            quarter of an hour more)
#
# Instead, in builds of their own, without the tests that work on photographs:
#
#   tests/run.sh --sanitize  the tests under ASan and UBSan, and those of threaded
#                            libraries under TSan
#   tests/run.sh --coverage  the lines of src/lowlap that the tests reach; fails
#                            under 90 %
#   tests/run.sh --fuzz      every reader under a fuzzer for a minute, with ASan
#                            and UBSan
#
# Tests on photographs look for them in $LOWLAP_DATA, or in shared/data beside
# the repository, and are skipped without them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tidy=false
check=
slow=true
long=false
for option in "$@"; do
  case $option in
    --tidy) tidy=true ;;
    --sanitize | --coverage | --fuzz) check=${option#--} ;;
    --no-slow) slow=false ;;
    --long) long=true ;;
    *)
      sed -n '2,25s/^# \{0,1\}//p' tests/run.sh >&2
      echo "unknown option $option" >&2
      exit 2
      ;;
  esac
done

step() { printf '\n== %s\n' "$*"; }
build=build/ci
jobs=$(nproc)
# What ccache needs to know of precompiled headers.
export CCACHE_SLOPPINESS=pch_defines,time_macros

# configure FOLDER OPTION...
configure() {
  step "Configuring $1"
  cmake -S . -B "$1" -G Ninja -DCMAKE_CXX_COMPILER_LAUNCHER=ccache \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DLOWLAP_WARNINGS_AS_ERRORS=ON "${@:2}"
}

# compile FOLDER TARGET...
compile() {
  step "Building $1 with $jobs jobs"
  cmake --build "$1" --parallel "$jobs" --target "${@:2}"
}

if [[ $check ]]; then
  source tests/checks.sh
  "run_$check"
  exit
fi

step "Packages"
tools=(ccache clang-format doxygen dpkg-dev
       pybind11-dev python3-dev python3-numpy python3-pip python3-setuptools
       python3-wheel groff-base colmap chromium)
if $tidy; then tools+=(clang-tidy clang-tools cppcheck); fi
bash tutorials/install_dependencies.sh "${tools[@]}"

step "Formatting"
find src tests third_party_adapters tutorials \
  \( -name '*.cc' -o -name '*.h' \) -print0 |
  xargs -0 clang-format --dry-run -Werror

configure "$build" -DCMAKE_BUILD_TYPE=Release -DLOWLAP_BUILD_EXAMPLES=ON \
  -DLOWLAP_BUILD_PYTHON=ON -DPython_EXECUTABLE=/usr/bin/python3
compile "$build" all docs

if $tidy; then
  step "cppcheck"
  cppcheck --std=c++17 --language=c++ --enable=warning,performance,portability \
    --suppressions-list=tests/cppcheck_suppressions.txt --quiet \
    --suppress=missingIncludeSystem --error-exitcode=1 -j "$jobs" \
    -I src -I . '-DLOWLAP_VERSION="0"' src/lowlap src/cli third_party_adapters

  step "clang-tidy"
  # Clang cannot read GCC's precompiled headers, and is to see every source.
  cmake -S . -B build/tidy -G Ninja -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
    -DLOWLAP_PRECOMPILED_HEADERS=OFF -DLOWLAP_UNITY_BUILD=OFF
  run-clang-tidy -quiet -p build/tidy -j "$jobs" \
    "^$PWD/(src|third_party_adapters)/.*\.cc$"
fi

step "Testing"
left_out=()
$slow || left_out+=(slow)
$long || left_out+=(long)
ctest --test-dir "$build" --output-on-failure --parallel "$jobs" \
  ${left_out:+--label-exclude "$(IFS='|'; echo "${left_out[*]}")"}
