#!/usr/bin/env bash
# Fails where a comment or libvox/DESIGN.md itself names a section that libvox/DESIGN.md does not have, and
# where DESIGN.md names a file that is not there. Usage: design.sh SOURCE
set -euo pipefail
cd "$1"
design=libvox/DESIGN.md

# FILE:LINE NUMBER for each section that a comment names. A reference may go on in the next line.
references() {
  find libvox apps tests cmake CMakeLists.txt -name '*.h' -o -name '*.cpp' -o -name '*.cmake' -o \
    -name 'CMakeLists.txt' -o -name '*.sh' -o -name '*.py' | sort |
    xargs awk '
      FNR == 1 { open = "" }
      {
        line = $0
        sub(/^[ \t]*(\/\/[\/!]?<?|#|\*)?[ \t]*/, "", line)
        text = open == "" ? line : open " " line
        if (open == "") at = FILENAME ":" FNR
        open = ""
        while (match(text, /DESIGN(\.md)?,? sections? [0-9]+((,|,? and) [0-9]+)*/)) {
          found = substr(text, RSTART, RLENGTH)
          text = substr(text, RSTART + RLENGTH)
          if (text ~ /^(,|,? and)?$/) open = found text
          gsub(/[^0-9]+/, " ", found)
          count = split(found, numbers, " ")
          for (i = 1; i <= count; ++i) print at, numbers[i]
          at = FILENAME ":" FNR
        }
        if (match(text, /DESIGN(\.md)?,?( sections?)?$/)) open = substr(text, RSTART)
      }' | sort -u
}

# The same for sections that DESIGN.md names itself. "paper, section 4" is one of the paper.
ownReferences() {
  tr '\n' ' ' <"$design" | sed -E 's/paper, sections? [0-9.]+//g' |
    grep -oE 'sections? [0-9]+((,|,? and) [0-9]+)*' | grep -oE '[0-9]+' | sort -un | sed "s|^|$design |"
}

wrong=0
checked=0
while read -r place section; do
  checked=$((checked + 1))
  grep -q "^## $section\. " "$design" && continue
  echo "$place names section $section, which $design does not have"
  wrong=1
done < <(references; ownReferences)

for path in $(grep -oE '`[a-z_]+/[a-z_0-9]+`' "$design" | tr -d '`' | sort -u); do
  compgen -G "$path.*" >/dev/null || compgen -G "libvox/$path.*" >/dev/null || {
    echo "$design names $path, which is not there"
    wrong=1
  }
done

echo "$checked references checked"
[ "$checked" -gt 0 ] && [ "$wrong" -eq 0 ]
