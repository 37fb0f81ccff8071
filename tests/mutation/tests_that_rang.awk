# From the output of one GoogleTest run (named by -v run=...): "suite <tab> test <tab> margin" of every test that failed.
# Margin: measured over allowed, of the first message that tells both.
function ratio(a, b) { return b + 0 > 0 ? sprintf("%.2g", a / b) : "" }

/ vs / && match($0, /actual: [-+0-9.e]+ vs [-+0-9.e]+/) && margin == "" {
    split(substr($0, RSTART + 8, RLENGTH - 8), side, " vs ")
    if (side[1] + 0 > side[2] + 0) margin = ratio(side[1], side[2])
}
/^The difference between/ && match($0, / is [-+0-9.e]+, which exceeds/) {
    split(substr($0, RSTART + 4), word, ",")
    difference = word[1]
}
/ evaluates to [-+0-9.e]+\.$/ && difference != "" && margin == "" {
    bound = $NF
    sub(/\.$/, "", bound)
}
/^\[  FAILED  \] .* ms\)$/ {
    if (margin == "" && difference != "") margin = ratio(difference, bound)
    sub(/,$/, "", $4)
    split($4, name, ".")
    print name[1] "\t" $4 "\t" margin
    margin = difference = ""
    any = 1
}
/^exit / { code = $2 }
END {
    if (code == 124)
        print run "\t" run " (no end)\t"
    else if (code != "" && !any)
        print run "\t" run " (crash)\t"
}
