#!/usr/bin/env bash
# section.sh PAGE.md NAME < TEXT: replaces the text between the lines <!-- begin NAME --> and <!-- end NAME --> of a page.
set -euo pipefail
page=$1 name=$2
grep -q "^<!-- begin $name -->$" "$page" && grep -q "^<!-- end $name -->$" "$page" || {
  echo "section.sh: $page: has no part '$name': add the lines <!-- begin $name --> and <!-- end $name -->" >&2
  exit 1
}
text=$(cat)
new=$(mktemp "$page.XXXXXX")
while IFS= read -r line; do
  case $line in
    "<!-- begin $name -->") printf '%s\n\n%s\n\n' "$line" "$text"; inside=1 ;;
    "<!-- end $name -->") inside=; printf '%s\n' "$line" ;;
    *) [ -n "${inside:-}" ] || printf '%s\n' "$line" ;;
  esac
done < "$page" > "$new"
chmod 644 "$new"
mv "$new" "$page"
