#!/usr/bin/env bash
# Instructions that the Gingerbread man takes (order 5, tolerance 1e-2, the whole program), counted by callgrind,
# against the stored number: fails when more than a tenth above it. Usage:
#   benches/speed/count.sh [BINARY]            compares
#   benches/speed/count.sh --renew [BINARY]    stores the present number
# The count does not depend on the machine's speed or load. It does depend, by some per cent, on the compiler and the C
# library, and on what valgrind tells the program of the processor: with AVX2 (as stored) the element energies take
# half the instructions, and the C library picks its FMA variants of pow, log and sin, and AVX2 ones of memcpy. Without
# AVX2 nothing is compared. glibc's choices are held fixed otherwise: valgrind hides AVX-512.
set -euo pipefail
cd "$(dirname "$0")/../.."
stored_in=benches/speed/instructions.txt
# Per cent above the stored number that are allowed.
allowed=10

renew=no
if [ "${1:-}" = --renew ]; then renew=yes; shift; fi
binary=${1:-${CARGO_TARGET_DIR:-target}/release/quadrel}
[ -x "$binary" ] || { echo "no program at $binary: cargo build --release"; exit 1; }
binary=$(realpath "$binary")
command -v valgrind >/dev/null || { echo "valgrind is missing: apt-get install valgrind"; exit 1; }
if ! grep -qw avx2 /proc/cpuinfo 2>/dev/null; then
    echo "no AVX2 here: the stored number does not apply, nothing is compared"
    exit 0
fi

scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
log="$scratch/log"
# Without a domain the program meshes the Gingerbread man, into the present folder.
(cd "$scratch" && env -i PATH="$PATH" LC_ALL=C valgrind --tool=callgrind --callgrind-out-file=/dev/null "$binary" \
    --order 5 --tolerance 1e-2 >"$log" 2>&1) || { cat "$log"; exit 1; }
count=$(sed -n 's/^==[0-9]*== Collected : *\([0-9]*\).*/\1/p' "$log")
elements=$(sed -n 's/.* \([0-9]*\) elements, [0-9]* nodes.*/\1/p' "$log" | head -n 1)
[ -n "$count" ] || { cat "$log"; echo "callgrind told no count"; exit 1; }

if [ "$renew" = yes ]; then
    # The second line is for the reader: what it was counted with.
    printf '%s\n%s, %s, %s\n' "$count" "$(rustc --version)" "$(ldd --version 2>&1 | head -n 1)" \
        "$(valgrind --version)" > "$stored_in"
    echo "stored $count instructions ($elements elements) in $stored_in"
    exit 0
fi
stored=$(head -n 1 "$stored_in")
change=$(awk -v now="$count" -v then="$stored" 'BEGIN { printf "%+.1f", 100 * (now / then - 1) }')
echo "instructions for the Gingerbread man: $count now ($elements elements), $stored stored: $change %, up to +$allowed % pass"
if awk -v change="$change" -v allowed="$allowed" 'BEGIN { exit !(change > allowed) }'; then
    echo "slower than stored: find out why, or, if the work is worth it, benches/speed/count.sh --renew"
    exit 1
elif awk -v change="$change" -v allowed="$allowed" 'BEGIN { exit !(change < -allowed) }'; then
    echo "faster than stored: benches/speed/count.sh --renew keeps what was gained"
fi
