#!/bin/sh
# bundle.sh PAGE-FOLDER: the modules of the page as one script, in the order in which they need each other at the start.
# Their names share one scope, so that imports and the word export are left out (tests/live/lint.mjs checks them).
set -eu
page=$1
echo "'use strict';"
cat "$page/../../page/templates/html/suspension.js.mustache" "$page/../../page/templates/html/chart.js.mustache"
for module in base run state solver solve points guides view numbers hand effects proof notes charts tables files picture wish variants app; do
    sed -e '/^import .*;$/d' -e '/^import /,/;$/d' -e 's/^export //' "$page/$module.js"
done
