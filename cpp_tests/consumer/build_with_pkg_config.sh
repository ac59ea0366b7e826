#!/bin/sh
# Builds and runs the consumer without CMake: build_with_pkg_config.sh PREFIX FOLDER
set -eu
here=$(cd "$(dirname "$0")" && pwd)
prefix=$1
folder=$2
PKG_CONFIG_PATH=$(find "$prefix" -type d -name pkgconfig)
export PKG_CONFIG_PATH
mkdir -p "$folder"
pkg-config --exact-version=0.1.0 quadrel
flags=$(pkg-config --cflags quadrel)
shared="$(pkg-config --libs quadrel) -Wl,-rpath,$(pkg-config --variable=libdir quadrel)"
static=$(pkg-config --variable=static_library quadrel)
# What the static library needs beside itself.
system=$(pkg-config --static --libs-only-l quadrel | sed 's/-lquadrel//')
for language in c cpp; do
    compiler="${CC:-cc} -std=c99"
    [ $language = c ] || compiler="${CXX:-c++} -std=c++17"
    $compiler $flags "$here/main.$language" $shared -lm -o "$folder/shared_$language"
    $compiler $flags "$here/main.$language" "$static" $system -lm -o "$folder/static_$language"
    "$folder/shared_$language"
    "$folder/static_$language"
done
ldd "$folder/shared_c" | grep -q 'libquadrel\.so\.0\.1 =>' || { echo "the SONAME is not libquadrel.so.0.1"; exit 1; }
if ldd "$folder/static_c" | grep -q quadrel; then echo "the static program needs the shared library"; exit 1; fi
