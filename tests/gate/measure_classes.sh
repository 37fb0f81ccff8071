#!/bin/sh
# Measures what the cross-build tolerances rest on: builds the command with several compilers and flags, lets
# each measure every built-in scene, and prints how far apart they are, by unit.
#
#   ./dev classes
set -eu
cd "$(dirname "$0")/../.."
work=build/classes

# name | compiler | optimisation; -w: g++ 12 warns wrongly in its own AVX-512 headers
while IFS='|' read -r name compiler flags; do
    echo "$name: $compiler $flags"
    cmake -S . -B "$work/$name" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
        "-DCMAKE_CXX_FLAGS_RELEASE=$flags" >"$work-$name.log" 2>&1 &&
        cmake --build "$work/$name" --target elastocheck_command >>"$work-$name.log" 2>&1 ||
        { tail -30 "$work-$name.log" >&2; exit 1; }
    rm -rf "$work/$name/baselines"
    env -u CI "$work/$name/reports/elastocheck" gate models/scenes/*.yaml --baseline "$work/$name/baselines" \
        --accept --reason "measuring the classes of builds" >>"$work-$name.log"
done <<'BUILDS'
gcc-O3|g++|-O3 -DNDEBUG
gcc-O0|g++|-O0
gcc-native|g++|-O3 -march=native -DNDEBUG -w
clang-O3|clang++|-O3 -DNDEBUG
BUILDS

build/release/tests/gate/class_table "$work/gcc-O3/baselines" "$work/gcc-O0/baselines" \
    "$work/gcc-native/baselines" "$work/clang-O3/baselines"
