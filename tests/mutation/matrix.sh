#!/bin/sh
# matrix.sh FAULTS WORK OUTPUT FAULT...: results.md (for people), results.csv (fault × alarm) and results.json (for the
# report) from what mutate.sh left in WORK. Exit code 1 when a fault survived.
set -eu
faults=$1 work=$2 output=$3
shift 3
here=$(dirname "$0")
field() { awk -v fault="$1" -v key="$2" -f "$here/field.awk" "$faults"; }
made=$work/matrix  # moved to OUTPUT whole; OUTPUT may be WORK itself
mkdir -p "$made"
survived=0
{
    printf 'fault'
    while read -r alarm; do printf ',%s' "$alarm"; done <"$work/alarms"
    printf '\n'
    for fault in "$@"; do
        printf '%s' "$fault"
        while read -r alarm; do
            if cut -f1 "$work/results/$fault/rang" | grep -qxF "$alarm"; then printf ',x'; else printf ','; fi
        done <"$work/alarms"
        printf '\n'
    done
} >"$made/results.csv"
{
    echo "# Faults and the alarms that ring"
    echo
    echo "Written by \`./dev mutate\`; the whole matrix is in results.csv. The margin is the first
alarm's: measured over allowed, where it tells both."
    echo
    echo "| fault | in | what it simulates | first to ring | margin | alarms |"
    echo "|---|---|---|---|--:|--:|"
    for fault in "$@"; do
        rang=$work/results/$fault/rang
        if [ -s "$rang" ]; then
            first=$(head -1 "$rang" | cut -f2) margin=$(head -1 "$rang" | cut -f3)
        else
            first='**survived**' margin='' survived=$((survived + 1))
        fi
        alarms=$(cut -f1 "$rang" | sort -u | wc -l)
        echo "| $fault | $(field "$fault" file) | $(field "$fault" is) | $first | $margin | $alarms |"
    done
    echo
    echo "$# faults, $survived survived, $(wc -l <"$work/alarms") alarms. Never rang:"
    echo
    cat "$work"/results/*/rang | cut -f1 | sort -u >"$work/rang"
    grep -vxF -f "$work/rang" "$work/alarms" | sed 's/^/- /' || echo "- none"
} >"$made/results.md"
awk -f "$here/results_json.awk" "$made/results.md" >"$made/results.json"
mv "$made/results.csv" "$made/results.md" "$made/results.json" "$output"
[ "$survived" -eq 0 ] || { echo "mutate: $survived of $# faults survived: $output/results.md" >&2; exit 1; }
