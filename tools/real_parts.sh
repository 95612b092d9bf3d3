#!/bin/sh
# Installs what the tests use for real and this machine lacks: PostgreSQL, Chromium, strace, mosquitto, socat and nginx, from Debian's packages, as root.
# Without it those tests skip and say so; with ULNA_REQUIRE=all, as in CI, they fail.
set -u
lacking=""
ls /usr/lib/postgresql/*/bin/initdb >/dev/null 2>&1 || command -v initdb >/dev/null 2>&1 || lacking="$lacking postgresql"
command -v chromium >/dev/null 2>&1 || command -v google-chrome >/dev/null 2>&1 || lacking="$lacking chromium"
command -v strace >/dev/null 2>&1 || lacking="$lacking strace"
command -v mosquitto >/dev/null 2>&1 || [ -x /usr/sbin/mosquitto ] || lacking="$lacking mosquitto"
command -v nginx >/dev/null 2>&1 || [ -x /usr/sbin/nginx ] || lacking="$lacking nginx-light"
command -v socat >/dev/null 2>&1 || lacking="$lacking socat"
[ -n "$lacking" ] || exit 0
echo "Installing what the tests use for real:$lacking"
export DEBIAN_FRONTEND=noninteractive
apt-get update -qq && exec apt-get install -y -qq --no-install-recommends $lacking
