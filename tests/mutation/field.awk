# The value of `key` of the fault `fault` in faults.txt.
$1 == "fault" { inside = $2 == fault }
inside && $1 == key {
    sub(/^[ ]*[^ ]+ ?/, "")
    print
    exit
}
