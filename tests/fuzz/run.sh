#!/usr/bin/env bash
# Looks for inputs that break a fuzz target: run.sh PROGRAM SECONDS FOLDER. What it learns stays in FOLDER/corpus, an
# input that breaks the target in FOLDER; the log ends with the number of inputs tried.
set -euo pipefail
program=$1 seconds=$2
mkdir -p "$3/corpus"
folder=$(cd "$3" && pwd)
seeds=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/seeds
name=$(basename "$program")
corpora=("$folder/corpus" "$seeds/${name#fuzz_}")
case $name in fuzz_frame | fuzz_target) corpora+=("$seeds/gltf") ;; esac
case $name in
  fuzz_frame | fuzz_target | fuzz_gltf) words=gltf ;;
  fuzz_image_file | fuzz_transport_cache) words=exr ;;
  *) words=${name#fuzz_} ;;
esac
dictionary=()
[ ! -e "$seeds/../dictionaries/$words.dict" ] || dictionary=("-dict=$seeds/../dictionaries/$words.dict")

# Leaks are the unit tests' to find: the libraries that are not compiled with the sanitizer keep what they have. Shadows of
# up to 64 MB are set, not mapped anew, which takes longer where there are threads.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1:clear_shadow_mmap_threshold=67108864
export UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1
exec "$program" -max_total_time="$seconds" -timeout=20 -detect_leaks=0 -rss_limit_mb=4000 -malloc_limit_mb=2000 \
  -print_final_stats=1 -close_fd_mask=1 -artifact_prefix="$folder/" "${dictionary[@]}" "${corpora[@]}"
