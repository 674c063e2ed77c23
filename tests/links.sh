#!/usr/bin/env bash
# Every relative link and picture in the Markdown pages leads to a file that exists, and to a
# heading of that file if it names one. Every `path/of/a/file` from the root exists, too, with or
# without its extension. Usage: links.sh SOURCE
set -euo pipefail
cd "$1"

# Lines of a page outside of its code blocks.
prose() { awk '/^ *```/ { inCode = !inCode; next } !inCode' "$1"; }

# Targets of [text](target) and src="target", one a line. What stands in `code` is no link.
targets() {
  prose "$1" | sed -E 's/`[^`]*`//g' |
    grep -oE '\]\([^) ]+|src="[^"]+' | sed -E 's/^(\]\(|src=")//' || true
}

# Headings of a page as GitHub names them in addresses: "Two commands" is two-commands.
anchors() {
  prose "$1" | sed -n 's/^##* //p' | tr '[:upper:]' '[:lower:]' | sed 's/[^a-z0-9 _-]//g; s/ /-/g'
}

# Paths in `code`, one a line.
paths() { grep -oE '`(apps|cmake|libvox|scenes|tests)/[A-Za-z0-9_./-]+`' "$1" | tr -d '`' || true; }

wrong=0
checked=0
while read -r page; do
  while read -r path; do
    checked=$((checked + 1))
    [ -e "$path" ] || compgen -G "$path.*" >/dev/null || {
      echo "$page: $path does not exist"
      wrong=1
    }
  done < <(paths "$page")
  while read -r target; do
    case $target in *://* | mailto:*) continue ;; esac
    checked=$((checked + 1))
    file=${target%%#*}
    file=${file:+$(dirname "$page")/$file}
    file=${file:-$page}
    if [ ! -e "$file" ]; then
      echo "$page: $target does not exist"
      wrong=1
    elif [[ $target == *#* ]] && ! anchors "$file" | grep -qx -- "${target#*#}"; then
      echo "$page: $target: there is no such heading"
      wrong=1
    fi
  done < <(targets "$page")
done < <(find . \( -path ./.git -o -path ./build -o -path ./out \) -prune -o -name '*.md' -print)

echo "$checked links and paths checked"
[ "$checked" -gt 0 ] && [ "$wrong" -eq 0 ]
