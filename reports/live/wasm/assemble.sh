#!/bin/sh
# assemble.sh PAGE-FOLDER WASM OUTPUT: the page in one file, without its scene (@SCENE@), which `elastocheck live` fills in.
# The policy of the page allows its own style and script by their hashes, its worker, WebAssembly, and no network.
set -eu
page=$1 wasm=$2 output=$3
part=$(mktemp -d)
trap 'rm -rf "$part"' EXIT
# The digest of a file in base64, as a policy names it.
digest() { env printf "$(sha256sum "$1" | cut -c 1-64 | sed 's/../\\x&/g')" | base64 -w 0; }
cat "$page/../../page/templates/html/colours.css.mustache" "$page/style.css" >"$part/style"
"$(dirname "$0")/bundle.sh" "$page" >"$part/script"
cat "$page/worker.js" >"$part/worker"
gzip -9 -n -c "$wasm" | base64 -w 0 >"$part/solver"
printf "default-src 'none'; script-src 'sha256-%s' 'wasm-unsafe-eval'; style-src 'sha256-%s'; worker-src blob:; img-src blob:; base-uri 'none'; form-action 'none'" \
    "$(digest "$part/script")" "$(digest "$part/style")" >"$part/policy"
# A line has one placeholder at most, @SCENE@ stays.
awk -v part="$part" '
    match($0, /@(POLICY|STYLE|WORKER|SOLVER|SCRIPT)@/) {
        name = tolower(substr($0, RSTART + 1, RLENGTH - 2))
        printf "%s", substr($0, 1, RSTART - 1)
        fflush()
        system("cat \"" part "/" name "\"")
        print substr($0, RSTART + RLENGTH)
        next
    }
    { print; fflush() }' "$page/page.html" >"$output.part"
mv "$output.part" "$output"
