# Sourced by claims: the scene of the arguments by every method of $M, each to its own METHOD.csv; prints how
# many had which outcome, and keeps their messages in `said`.
M='published closed balanced tangent chord midpoint adaptive series'
every() {
    : > said
    for m in $M; do
        if elastocheck solve "$@" --method $m > $m.csv 2> err; then echo converged; else sed -n "s/^$m: \([^:]*\):.*/\1/p" err; fi
        cat err >> said
    done | sort | uniq -c | tr -s ' '
    cat said >&2
}
