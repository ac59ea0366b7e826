#!/bin/sh
# The shared library shows the functions of symbols.txt and nothing else: symbols.sh LIBRARY LIST
set -eu
found=$(nm -D --defined-only "$1" | awk '{ print $3 }' | LC_ALL=C sort)
if [ "$found" != "$(cat "$2")" ]; then
    echo "exported symbols are not those of $2:"
    printf '%s\n' "$found" | diff "$2" - || true
    exit 1
fi
readelf -d "$1" | grep -q 'SONAME.*\[libquadrel\.so\.0\.1\]' || { echo "the SONAME is not libquadrel.so.0.1"; exit 1; }
