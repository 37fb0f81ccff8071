#!/bin/sh
# speed_figures.sh PROGRAMS BUILD: measures speed, writes speed.md with the commit, and puts it into README.md.
set -eu
cd "$(dirname "$0")"
scenes=../../models/scenes
commit=$(git -c safe.directory='*' describe --always --dirty --exclude='*')
processor=$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)
{
    echo "Commit $commit, $processor, $2:"
    echo
    "$1/benchmark_recursion"
    echo
    "$1/benchmark_step" $scenes/chrono_mcpherson.yaml $scenes/mcpherson_strut.yaml $scenes/front_axle.yaml 1000
    echo
    "$1/benchmark_batch" $scenes/chrono_mcpherson.yaml 400
} >"$1/speed.md"
mv "$1/speed.md" speed.md
sed -i -e '/^<!-- speed.md -->/,/^<!-- end -->/{//!d}' -e '/^<!-- speed.md -->/r speed.md' README.md
