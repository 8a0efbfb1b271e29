#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test; then, built by Clang with the sanitizers, every fuzz target for a
# while, and all unit tests but the longest (tests/support/long_with_sanitizers.txt).
# PRESET=release (or debug, asan, tsan, fuzz) bash tests/run.sh runs one of them alone.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
read -ra presets <<<"${PRESET:-release fuzz}"

bash cmake/install_dependencies.sh chromium clang libclang-rt-14-dev  # Chromium opens the report's page
test_cases=  # as release has compiled them, for fuzz after it
for preset in "${presets[@]}"; do
  echo "chiaro: building preset $preset"
  options=()
  [ "$preset" != fuzz ] || options=(-D CHIARO_TEST_CASES_OF="$test_cases")
  cmake --preset "$preset" "${options[@]}" >/dev/null
  cmake --build --preset "$preset"
  echo "chiaro: testing preset $preset"
  ctest --preset "$preset" --parallel "$(nproc)"
  [ "$preset" != release ] || test_cases=$PWD/build/release
done
