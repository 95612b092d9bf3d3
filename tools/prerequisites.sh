#!/bin/sh
# Says what this machine lacks to build Ulna, all of it at once, and prints the Python to use on standard output.
# Usage: tools/prerequisites.sh build   (Python with venv, Rust, a C linker)
#        tools/prerequisites.sh test    (the same, and rustfmt and clippy)
set -u
purpose=${1:-build}
rust_wanted=1.89
missing=0

lacks() {
    missing=1
    printf 'make %s: %s\n' "$purpose" "$1" >&2
}

# Succeeds where $1 is a Python that is new enough and can make virtual environments.
python_new_enough() { "$1" -c 'import sys; sys.exit(sys.version_info < (3, 11))' >/dev/null 2>&1; }
python_has_venv() { "$1" -c 'import venv, ensurepip' >/dev/null 2>&1; }

# A named PYTHON is taken at its word: whoever names one wants that one or a complaint.
if [ -n "${PYTHON:-}" ]; then candidates=$PYTHON; else candidates="python3 python3.14 python3.13 python3.12 python3.11"; fi
python=""
too_old=""
without_venv=""
for candidate in $candidates; do
    command -v "$candidate" >/dev/null 2>&1 || continue
    if ! python_new_enough "$candidate"; then
        too_old="$candidate ($("$candidate" -V 2>&1))"
    elif ! python_has_venv "$candidate"; then
        without_venv="$candidate ($("$candidate" -V 2>&1))"
    else
        python=$candidate
        break
    fi
done
if [ -z "$python" ]; then
    if [ -n "$without_venv" ]; then
        lacks "$without_venv lacks the module venv (or ensurepip). On Debian and Ubuntu: apt-get install python3-venv"
    elif [ -n "$too_old" ]; then
        lacks "Python 3.11 or newer is needed; found only $too_old. Install one, or name it: make $purpose PYTHON=/path/to/python3"
    else
        lacks "no Python found (looked for: $candidates). Python 3.11 or newer is needed. On Debian and Ubuntu: apt-get install python3 python3-venv"
    fi
fi

if ! command -v cargo >/dev/null 2>&1 || ! command -v rustc >/dev/null 2>&1; then
    lacks "no Rust toolchain found (cargo and rustc). Rust $rust_wanted or newer is needed: install rustup, then: rustup toolchain install stable"
else
    rust_found=$(rustc --version 2>/dev/null | cut -d' ' -f2)
    oldest=$(printf '%s\n%s\n' "$rust_wanted" "$rust_found" | sort -V | head -n 1)
    [ "$oldest" = "$rust_wanted" ] || lacks "Rust $rust_wanted or newer is needed; rustc is ${rust_found:-not working}. Run: rustup update"
    if [ "$purpose" = test ]; then
        cargo fmt --version >/dev/null 2>&1 || lacks "cargo fmt is not installed. Run: rustup component add rustfmt"
        cargo clippy --version >/dev/null 2>&1 || lacks "cargo clippy is not installed. Run: rustup component add clippy"
    fi
fi

if ! command -v cc >/dev/null 2>&1 && ! command -v gcc >/dev/null 2>&1 && ! command -v clang >/dev/null 2>&1; then
    lacks "no C compiler found (cc, gcc or clang); Rust links with it. On Debian and Ubuntu: apt-get install gcc libc6-dev"
fi

[ "$missing" = 0 ] || exit 1
printf '%s\n' "$python"
