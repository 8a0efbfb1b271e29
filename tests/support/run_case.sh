#!/usr/bin/env bash
# Runs one end-to-end case: run_case.sh PROGRAM SOURCE_DIR CASE_DIR WORK_DIR
set -euo pipefail
export CHIARO=$1 SOURCE=$2 CASE=$3
rm -rf "$4" && mkdir -p "$4" && cd "$4"
bash "$CASE/run"
