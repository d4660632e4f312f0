#!/usr/bin/env bash
# Print the Python to build the environment with: $PYTHON if set, else the first that is new enough.
set -euo pipefail
cd "$(dirname "$0")/.."

if [ -n "${PYTHON:-}" ]; then
    candidates=("$PYTHON")
else
    candidates=(python3.11 python3 python3.12 python3.13 python3.14)
fi

# Not the Python of .venv, which is removed before it is made anew.
IFS=: read -ra folders <<<"$PATH"
PATH=
for folder in "${folders[@]}"; do
    [ "$folder" -ef .venv/bin ] || PATH+=${PATH:+:}$folder
done

for candidate in "${candidates[@]}"; do
    if "$candidate" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then
        command -v "$candidate"
        exit 0
    fi
done
echo "pagd needs Python 3.11 or newer, which none of these is: ${candidates[*]}." \
    "Install python3.11, or name another by 'make PYTHON=/path/to/python3'." >&2
exit 1
