#!/usr/bin/env bash
# The tables of options in apps/vox/README.md are those of the program.
# Usage: options_readme.sh VOX SOURCE [--renew]; with --renew they are replaced.
#
# A table stands between the lines "<!-- options of vox COMMAND -->" and "<!-- end of options -->".
# All other lines of the page are written by hand.
set -euo pipefail
vox=$(realpath "$1")
page=$(realpath "$2")/apps/vox/README.md
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

"$vox" --markdown >"$folder/tables"
awk '
  /^<!-- options of vox .* -->$/ { command = $0 }
  FNR == NR && /^<!-- end of options -->$/ { command = "" }
  FNR == NR { if (command != "" && command != $0) table[command] = table[command] $0 "\n"; next }

  /^<!-- options of vox .* -->$/ {
    print
    printf "%s", table[command]
    printed[command] = 1
    inTable = 1
  }
  /^<!-- end of options -->$/ { inTable = 0 }
  !inTable
  END {
    for (command in table) if (!(command in printed)) {
      print "apps/vox/README.md lacks the line " command >"/dev/stderr"
      wrong = 1
    }
    exit wrong
  }
' "$folder/tables" "$page" >"$folder/page"

diff -u "$page" "$folder/page" && exit 0
if [ "${3:-}" = --renew ]; then
  cp "$folder/page" "$page"
  exit 0
fi
echo "apps/vox/README.md is not what the option table says. Renew it with"
echo "  tests/options_readme.sh $1 $2 --renew"
exit 1
