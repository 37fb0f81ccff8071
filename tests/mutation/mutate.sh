#!/bin/sh
# Alarms that are shown to ring: puts each fault of faults.txt into a copy of the tree, rebuilds what changed, runs
# the alarms (every GoogleTest suite, the gate on every scene) and writes the matrix fault × alarm.
#
#   mutate.sh [-n] [-o DIR] [-w WORK] [FAULT...]
#   mutate.sh -s [-w WORK]
#
# FAULT: names from faults.txt, default all; -n only looks whether each still has its place in the code. DIR gets
# results.md and results.csv (default: here). WORK keeps the copy, its build and what was found between runs (default:
# build/mutation). Exit code 1: a fault survived, or an alarm rings without a fault.
#
# -s: the sample, in minutes: no copy, but this checkout and its release build, right after its tests have passed. Each
# fault is put into its file, only the suite named beside it (`sample SUITE`) is built and run, and the file is put back,
# also when this is interrupted; after a kill the next run does so first.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
output=$here
work=$root/build/mutation
dry='' chosen='' root_is_mutated=''
while getopts nso:w: option; do
    case $option in
    n) dry=yes ;;
    s) chosen=sample root_is_mutated=yes ;;
    o) output=$OPTARG ;;
    w) work=$OPTARG ;;
    *) exit 2 ;;
    esac
done
shift $((OPTIND - 1))
faults=$here/faults.txt
tree=$work/tree
build=$work/build
kept=$work/kept_of_copy
if [ "$root_is_mutated" ]; then
    tree=$root
    build=$root/build/release
    kept=$work/kept_of_checkout  # never what a run on the copy has left: that may be older than the checkout
fi
unset CI GITHUB_ACTIONS  # the copy's baselines are not committed anywhere

# field FAULT KEY: its value in faults.txt
field() { awk -v fault="$1" -v key="$2" -f "$here/field.awk" "$faults"; }
names() {
    awk -v key="${chosen:-fault}" '$1 == "fault" { name = $2 } $1 == key { print name }' "$faults"
}

# replace FAULT PREFIX: the one occurrence of its text in the copy; fails when there is not exactly one.
replace() {
    file=$(field "$1" "$2file")
    FIND=$(field "$1" "$2find") MAKE=$(field "$1" "$2make") awk '
        BEGIN { find = ENVIRON["FIND"]; make = ENVIRON["MAKE"] }
        {
            at = index($0, find)
            if (find != "" && at > 0) {
                ++count
                rest = substr($0, at + length(find))
                if (index(rest, find) > 0) ++count
                $0 = substr($0, 1, at - 1) make rest
            }
            print
        }
        END { exit count != 1 }' "$tree/$file" >"$work/mutant" || {
        echo "mutate: $1: what it replaces does not occur exactly once in $file" >&2
        return 1
    }
    cat "$work/mutant" >"$tree/$file"
}
files() { field "$1" file && field "$1" also-file; }
# The sound files are kept, so that the tree may be worked on meanwhile.
apply() {
    rm -rf "$kept"
    mkdir -p "$kept"
    for file in $(files "$1" | sort -u); do
        mkdir -p "$(dirname "$kept/$file")" && cp -p "$tree/$file" "$kept/$file"
    done
    replace "$1" '' || return 1
    [ -z "$(field "$1" also-file)" ] || replace "$1" also-
}
# Newer than what was built from the fault.
revert() {
    for file in $(files "$1" | sort -u); do cp "$kept/$file" "$tree/$file"; done
    rm -rf "$kept"
}

# The alarms one by one, as "suite" lines of what is run, in the order in which they are asked.
alarms() {
    for test in $tests; do
        "$build/tests/$test" --gtest_list_tests | awk '/^[^ ]+\./ { sub(/\..*/, ""); print }'
    done
    for scene in "$tree"/models/scenes/*.yaml; do echo "gate:$(basename "$scene" .yaml)"; done
    echo Performance
}
tests='models/test_models recursive/test_recursive recursive/test_series recursive/test_series_and_reference
    recursive/test_allocation reference/test_equilibrium reference/test_energy legs/test_legs
    compare/test_compare compare/test_characteristics compare/test_trade gate/test_judge gate/test_gate reports/test_reports'
# Of what is no GoogleTest, the one that looks at the build tree itself.
of_build_tree=Performance.ValgrindIsLookedForWhenItIsNeeded

# ring FOLDER [STAMP]: runs the alarms (those built since STAMP) and leaves "alarm <tab> test <tab> margin" of those
# that rang in FOLDER/rang.
ring() {
    rm -rf "$1" && mkdir -p "$1"
    command=$build/reports/elastocheck
    for test in $tests; do
        case $test in
        gate/* | reports/*) touched="$build/tests/$test $command" ;;  # these run the command
        *) touched="$build/tests/$test" ;;
        esac
        # shellcheck disable=SC2086 # a list of words
        if [ $# -lt 2 ] || [ -n "$(find $touched -newer "$2")" ]; then echo "$test"; fi
    done | OUT=$1 BUILD=$build xargs -P "$(nproc)" -I{} sh -c '
        log=$OUT/$(basename {}).log
        timeout 400 "$BUILD/tests/{}" --gtest_brief=1 >"$log" 2>&1 || echo "exit $?" >>"$log"'
    timeout 400 "$command" gate "$tree"/models/scenes/*.yaml --class cross-build >"$1/gate.log" 2>&1 || true
    for test in $tests; do
        log=$1/$(basename "$test").log
        [ ! -f "$log" ] || awk -v run="$(basename "$test")" -f "$here/tests_that_rang.awk" "$log"
    done >"$1/rang"
    awk -f "$here/scenes_that_rang.awk" "$1/gate.log" >>"$1/rang"
    ctest --test-dir "$build" -R "^$of_build_tree\$" --no-tests=error >"$1/build_tree.log" 2>&1 ||
        printf '%s\t%s\t\n' "${of_build_tree%%.*}" "$of_build_tree" >>"$1/rang"
}

# shellcheck disable=SC2046 # lists of words
if [ $# -eq 0 ]; then set -- $(names); fi
twice=$(names | sort | uniq -d)
[ -z "$twice" ] || { echo "mutate: stands twice in faults.txt:" $twice >&2; exit 2; }
for fault in "$@"; do
    [ -n "$(field "$fault" file)" ] || { echo "mutate: no fault '$fault' in faults.txt" >&2; exit 2; }
done

if [ "$root_is_mutated" ]; then
    # put_back: what a fault, of this run or of one that was killed, has left in the checkout.
    put_back() {
        [ ! -d "$kept" ] || (cd "$kept" && find . -type f) | while read -r file; do
            cp "$kept/$file" "$root/$file"
        done
        rm -rf "$kept"
    }
    put_back
    trap put_back EXIT
    trap 'exit 130' INT TERM HUP
    survived=0
    for fault in "$@"; do
        suite=$(field "$fault" sample)
        apply "$fault" || exit 2
        cmake --build "$build" --target "$(basename "$suite")" >"$work/build.log" 2>&1 || {
            echo "mutate: $fault does not compile" >&2
            tail -5 "$work/build.log" >&2
            exit 2
        }
        timeout 400 "$build/tests/$suite" --gtest_brief=1 >"$work/sample.log" 2>&1 || echo "exit $?" >>"$work/sample.log"
        revert "$fault"
        first=$(awk -v run="$(basename "$suite")" -f "$here/tests_that_rang.awk" "$work/sample.log" | head -1 | cut -f2)
        echo "$fault: ${first:-SURVIVED}"
        [ "$first" ] || survived=1
    done
    exit "$survived"
fi

# What differs gets a new time, older sources included and what an interrupted run left: a build goes by times.
mkdir -p "$tree" "$output"
rooms='README.md models recursive reference compare reports tests'
# shellcheck disable=SC2086 # a list of words
(cd "$root" && find CMakeLists.txt $rooms -type f) | while read -r file; do
    cmp -s "$root/$file" "$tree/$file" && continue
    mkdir -p "$tree/$(dirname "$file")"
    cp "$root/$file" "$tree/$file"
done
(cd "$tree" && find . -type f) | while read -r file; do [ -f "$root/$file" ] || rm "$tree/$file"; done
if [ "$dry" ]; then
    for fault in "$@"; do
        apply "$fault" || exit 2
        revert "$fault"
    done
    echo "mutate: $# faults have their place"
    exit
fi
[ -f "$build/build.ninja" ] || cmake -S "$tree" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release \
    "-DCMAKE_CXX_FLAGS_RELEASE=-O1 -DNDEBUG -w" >"$work/configure.log"
targets="elastocheck_command $(for test in $tests; do basename "$test"; done)"
# shellcheck disable=SC2086 # a list of words
compile() { cmake --build "$build" --target $targets >"$work/build.log" 2>&1; }
echo "mutate: building the copy"
compile || { tail -30 "$work/build.log" >&2; exit 2; }
ring "$work/sound"
if [ -s "$work/sound/rang" ]; then
    echo "mutate: these alarms ring without a fault:" >&2
    cat "$work/sound/rang" >&2
    exit 1
fi

alarms >"$work/alarms"
[ $# -lt "$(grep -c '^fault ' "$faults")" ] || rm -rf "$work/results"
mkdir -p "$work/results"
for fault in "$@"; do
    stamp=$work/stamp
    touch "$stamp" && sleep 1
    apply "$fault" || exit 2
    rm -rf "$work/results/$fault"
    if compile; then
        ring "$work/results/$fault" "$stamp"
    else
        revert "$fault"
        echo "mutate: $fault does not compile" >&2
        tail -5 "$work/build.log" >&2
        exit 2
    fi
    revert "$fault"
    if [ -s "$work/results/$fault/rang" ]; then
        first=$(head -1 "$work/results/$fault/rang" | cut -f2)
        echo "$fault: $first ($(cut -f1 "$work/results/$fault/rang" | sort -u | wc -l) alarms)"
    else
        echo "$fault: SURVIVED"
    fi
done

# With what earlier runs found of the other faults.
# shellcheck disable=SC2046 # a list of words
sh "$here/matrix.sh" "$faults" "$work" "$output" $(chosen='' && names | while read -r fault; do
    [ ! -f "$work/results/$fault/rang" ] || echo "$fault"
done)
