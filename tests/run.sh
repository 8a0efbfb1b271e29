#!/usr/bin/env bash
# Installs what is missing, builds, and runs every test.  PRESET=asan bash tests/run.sh for the sanitizers.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=${PRESET:-release}

bash cmake/install_dependencies.sh chromium  # opens the report's page
echo "chiaro: building preset $preset"
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset"
echo "chiaro: testing"
ctest --preset "$preset" --parallel "$(nproc)"
