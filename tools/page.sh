#!/bin/sh
# Builds the workbench's page into python/ulna/serve/page/, where Node is new enough; else says so: the rest needs none.
# Usage: tools/page.sh build | check   (check: types, lint and the page's own tests; fails where Node is not there)
set -eu
purpose=${1:-build}
wanted=20.19
found=$(node --version 2>/dev/null | sed 's/^v//' || true)
oldest=$(printf '%s\n%s\n' "$wanted" "${found:-0}" | sort -V | head -n 1)
if [ "$oldest" != "$wanted" ] || ! command -v npm >/dev/null 2>&1; then
    echo "make page: Node $wanted or newer, with npm, is needed for the page of ulna workbench; found ${found:-none}." >&2
    [ "$purpose" = build ] || exit 1
    echo "           Everything else is built without it. Install Node, then: make page" >&2
    exit 0
fi
cd "$(dirname "$0")/../page"
if [ ! -e node_modules/.locked ] || [ package-lock.json -nt node_modules/.locked ]; then
    npm ci --silent --no-audit --no-fund
    touch node_modules/.locked
fi
case $purpose in
build)
    # how large each file is interests whoever works on the page; others what went wrong
    said=$(npm run --silent build 2>&1) || { printf '%s\n' "$said" >&2; exit 1; }
    ;;
check) npm run --silent check && npm run --silent test ;;
esac
