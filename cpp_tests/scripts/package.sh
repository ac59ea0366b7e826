#!/bin/sh
# Installs quadrel, moves the installation elsewhere, and builds and runs the consumer there, with CMake and
# with pkg-config: package.sh QUADREL_BUILD CONSUMER FOLDER
set -eu
build=$1
consumer=$2
folder=$3
rm -rf "$folder"
mkdir -p "$folder"
cmake --install "$build" --prefix "$folder/first" > "$folder/install.log"
mv "$folder/first" "$folder/moved"
for file in quadrel.h quadrel.hpp quadrel_vtk.hpp quadrel_p4est.h; do [ -f "$folder/moved/include/$file" ] || { echo "$file is missing"; exit 1; }; done
if grep -rIl "$folder/first" "$folder/moved"; then echo "these files know where they were installed"; exit 1; fi
cmake -S "$consumer" -B "$folder/consumer" -DCMAKE_PREFIX_PATH="$folder/moved" -DCMAKE_BUILD_TYPE=Release > "$folder/configure.log"
cmake --build "$folder/consumer" > "$folder/build.log"
ctest --test-dir "$folder/consumer" --output-on-failure
"$consumer/build_with_pkg_config.sh" "$folder/moved" "$folder/pkg_config"
