# results.md → results.json: what the report shows of the faults.
BEGIN { FS = " \\| "; print "[" }
/^\| / && !/^\| fault / {
    sub(/^\| /, ""); sub(/ \|$/, "")
    $0 = $0
    gsub(/["\\]/, "\\\\&")
    printf "%s {\"fault\": \"%s\", \"in\": \"%s\", \"simulates\": \"%s\", \"first\": \"%s\", \"margin\": \"%s\", \"alarms\": %d}",
        (count++ ? ",\n" : ""), $1, $2, $3, ($4 == "**survived**" ? "" : $4), $5, $6
}
END { print "\n]" }
