# From the output of `elastocheck gate SCENE...`: "gate:scene <tab> gate: scene <tab> margin" of every scene that did not
# pass. Margin: tolerances of its worst number.
function tell() { if (scene != "") print "gate:" scene "\tgate: " scene "\t" margin }

/^[^ ].*\.yaml: / {
    tell()
    scene = margin = ""
    row = 0
    if ($0 ~ /: passed: /) next
    scene = $1
    sub(/:$/, "", scene)
    sub(/.*\//, "", scene)
    sub(/\.yaml$/, "", scene)
    next
}
/^  branch / { row = 1; next }
row == 1 { margin = sprintf("%.2g", $(NF - 1)); row = 2 }
/ numbers out of tolerance, in / { ended = 1 }
END {
    tell()
    if (!ended) print "gate:all\tgate (crash)\t"
}
