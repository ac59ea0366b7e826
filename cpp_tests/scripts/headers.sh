#!/bin/sh
# The headers are clean in every language and compiler promised: headers.sh INCLUDE_FOLDER [VTK'S_INCLUDE_FOLDER [MPI'S]],
# a folder empty: without it
set -eu
check() {
    compiler=$1 language=$2 standard=$3 header=$4
    command -v "$compiler" > /dev/null || { echo "$compiler is missing"; exit 1; }
    printf '#include "%s"\n' "$header" |
        "$compiler" -x "$language" -std="$standard" -Wall -Wextra -Wpedantic -Werror -I"$include" ${vtk:+-isystem "$vtk"} ${mpi:+-isystem "$mpi"} -fsyntax-only -
}
include=$1
vtk=${2:-}
mpi=${3:-}
for compiler in gcc clang; do
    for standard in c99 c11; do
        check $compiler c $standard quadrel.h
        [ -z "$mpi" ] || check $compiler c $standard quadrel_p4est.h
    done
done
for compiler in g++ clang++; do
    for standard in c++11 c++17 c++20; do check $compiler c++ $standard quadrel.h; done
    for standard in c++17 c++20; do
        check $compiler c++ $standard quadrel.hpp
        [ -z "$vtk" ] || check $compiler c++ $standard quadrel_vtk.hpp
        [ -z "$mpi" ] || check $compiler c++ $standard quadrel_p4est.h
    done
done
