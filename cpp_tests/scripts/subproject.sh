#!/bin/sh
# Another project takes quadrel into its own build with add_subdirectory and with FetchContent:
# subproject.sh QUADREL_ROOT CARGO_TARGET_DIR FOLDER
set -eu
root=$1
cargo=$2
folder=$3
rm -rf "$folder"
mkdir -p "$folder"
for way in subdirectory fetch; do
    mkdir "$folder/$way"
    {
        echo 'cmake_minimum_required(VERSION 3.18)'
        echo 'project(host LANGUAGES C CXX)'
        if [ $way = fetch ]; then
            echo 'include(FetchContent)'
            echo "FetchContent_Declare(quadrel SOURCE_DIR $root SOURCE_SUBDIR cmake)"
            echo 'FetchContent_MakeAvailable(quadrel)'
        else
            echo "add_subdirectory($root/cmake quadrel)"
        fi
        echo "add_executable(host $root/cpp_tests/consumer/main.c)"
        echo 'target_link_libraries(host PRIVATE Quadrel::quadrel_static m)'
    } > "$folder/$way/CMakeLists.txt"
    cmake -S "$folder/$way" -B "$folder/$way/build" -DQUADREL_CARGO_TARGET_DIR="$cargo" > "$folder/$way.log"
    cmake --build "$folder/$way/build" >> "$folder/$way.log" 2>&1 || { cat "$folder/$way.log"; exit 1; }
    "$folder/$way/build/host"
done
