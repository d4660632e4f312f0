#!/usr/bin/env bash
# Make the virtual environment .venv anew, with exactly the packages of requirements.lock.
# Starting from nothing makes it safe to repeat after an interruption and leaves no unpinned package.
set -euo pipefail
cd "$(dirname "$0")/.."

python=$(setup/find-python.sh)
echo "Installing the Python packages of requirements.lock into .venv (takes a minute or two)"
rm -rf .venv
"$python" -m venv .venv
.venv/bin/python -m pip --disable-pip-version-check -qq install --no-deps -r requirements.lock
