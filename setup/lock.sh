#!/usr/bin/env bash
# Write requirements.lock anew: the newest versions of all that pyproject.toml asks for.
set -euo pipefail
cd "$(dirname "$0")/.."

# Built by Intel for x86-64 only; elsewhere pagd solves with SciPy.
x86_only='intel-cmplr-lib-ur|intel-openmp|mkl|pypardiso|tbb|tcmlib|umf'

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
# Debian's own Python where it is there: newer patch versions may have packages that it refuses.
debian=/usr/bin/python3.11
[ -x "$debian" ] || debian=$(setup/find-python.sh)
"$debian" -m venv "$scratch"
"$scratch/bin/pip" install --quiet --upgrade pip
"$scratch/bin/pip" install --quiet --editable '.[cluster,dev]'
{
    echo '# Every package of the environment, made by setup/lock.sh from pyproject.toml.'
    "$scratch/bin/pip" freeze --all --exclude pip --exclude pagd |
        sed -E "s/^(($x86_only)==.*)/\1; platform_machine == \"x86_64\"/"
} >requirements.lock.new
mv requirements.lock.new requirements.lock
