#!/bin/sh
# Builds quadrel with coverage counters and fuzzes its C interface: run.sh FOLDER SECONDS
set -eu
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$1
seconds=$2
mkdir -p "$folder/corpus"
# What cargo-fuzz sets, on the stable compiler, for this crate alone: what it depends on is that of other builds.
cargo=${CARGO_TARGET_DIR:-$root/target}
CARGO_TARGET_DIR="$cargo" cargo rustc --release --locked --lib --no-default-features --crate-type staticlib \
    --manifest-path "$root/Cargo.toml" -- -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
    -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
    -Cllvm-args=-sanitizer-coverage-trace-compares -Cdebug-assertions=on
cp "$cargo/release/libquadrel.a" "$folder/libquadrel.a"
clang++ -std=c++17 -O1 -g -fsanitize=fuzzer,address -I"$root/include" "$root/cpp_tests/fuzz/calls.cpp" \
    "$folder/libquadrel.a" -lm -ldl -lpthread -o "$folder/calls"
cd "$folder"
./calls -max_total_time="$seconds" -timeout=120 -rss_limit_mb=4096 -max_len=400 -print_final_stats=1 corpus
