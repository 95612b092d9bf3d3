#!/bin/sh
# Runs a command of the build and says what it is before, and how long it took after.
# Usage: tools/step.sh "What it does (about how long)" "command"
set -eu
printf '%s …\n' "$1"
began=$(date +%s)
sh -c "$2"
printf '  done in %d s.\n' $(($(date +%s) - began))
