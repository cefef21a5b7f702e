#!/usr/bin/env bash
# Builds lowlap in build/ci and tests it, on a fresh Debian 12 machine too: the
# packages are installed first, as root or through sudo.
#
#   tests/run.sh           install, check the formatting, build, test
#   tests/run.sh --tidy    clang-tidy on the sources as well (some minutes more)
#   tests/run.sh --no-slow without the tests that work on photographs
#
# Tests on photographs look for them in $LOWLAP_DATA, or in shared/data beside
# the repository, and are skipped without them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

tidy=false
ctest_options=()
for option in "$@"; do
  case $option in
    --tidy) tidy=true ;;
    --no-slow) ctest_options+=(--label-exclude slow) ;;
    *)
      sed -n '2,10s/^# \{0,1\}//p' tests/run.sh >&2
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

step "Packages"
tools=(ccache clang-format doxygen dpkg-dev
       pybind11-dev python3-dev python3-numpy python3-pip python3-setuptools
       python3-wheel groff-base colmap chromium)
if $tidy; then tools+=(clang-tidy clang-tools); fi
bash tutorials/install_dependencies.sh "${tools[@]}"

step "Formatting"
find src tests third_party_adapters tutorials \
  \( -name '*.cc' -o -name '*.h' \) -print0 |
  xargs -0 clang-format --dry-run -Werror

step "Configuring"
cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DCMAKE_CXX_COMPILER_LAUNCHER=ccache -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
  -DLOWLAP_WARNINGS_AS_ERRORS=ON -DLOWLAP_BUILD_EXAMPLES=ON \
  -DLOWLAP_BUILD_PYTHON=ON -DPython_EXECUTABLE=/usr/bin/python3

step "Building with $jobs jobs"
cmake --build "$build" --parallel "$jobs"

step "Reference pages"
cmake --build "$build" --target docs

if $tidy; then
  step "clang-tidy"
  # Clang cannot read GCC's precompiled headers, and is to see every source.
  cmake -S . -B build/tidy -G Ninja -DCMAKE_EXPORT_COMPILE_COMMANDS=ON \
    -DLOWLAP_PRECOMPILED_HEADERS=OFF -DLOWLAP_UNITY_BUILD=OFF
  run-clang-tidy -quiet -p build/tidy -j "$jobs" -warnings-as-errors='*' \
    "^$PWD/(src|third_party_adapters)/.*\.cc$"
fi

step "Testing"
ctest --test-dir "$build" --output-on-failure --parallel "$jobs" \
  "${ctest_options[@]}"
