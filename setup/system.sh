#!/usr/bin/env bash
# Install the system packages that are missing, as root or by sudo; say which ones where neither works.
# Those of system-packages.txt, and of the lists beside it that are given as arguments.
set -euo pipefail
cd "$(dirname "$0")"

lists=(system-packages.txt "$@")
libraries=$(PATH=$PATH:/usr/sbin:/sbin ldconfig -p)
python=$(./find-python.sh)

present() {
    case $1 in
    *.so.*) [[ $libraries == *[[:space:]]"$1 "* ]] ;;
    *) command -v "$1" >/dev/null ;;
    esac
}

missing_packages() {
    local wanted package
    while read -r wanted package _; do
        present "$wanted" || echo "$package"
    done < <(grep -hv '^#' "${lists[@]}")
    # Debian splits off the part of Python that makes virtual environments.
    "$python" -c 'import ensurepip' 2>/dev/null ||
        "$python" -c 'import sys; print("python%d.%d-venv" % sys.version_info[:2])'
}

refuse() {
    {
        echo "pagd needs these system packages: ${packages[*]}"
        echo "$1"
        echo "    apt-get install --no-install-recommends ${packages[*]}"
    } >&2
    exit 1
}

mapfile -t packages < <(missing_packages)
((${#packages[@]})) || exit 0

command -v apt-get >/dev/null ||
    refuse "This system has no apt-get: please install what corresponds here to"
as_root=(env DEBIAN_FRONTEND=noninteractive)
if ((EUID)); then
    # Without a terminal nobody can type the password.
    { [ -t 0 ] && command -v sudo >/dev/null; } || sudo -n true 2>/dev/null ||
        refuse "Only root may install them. Please ask an administrator for"
    as_root=(sudo "${as_root[@]}")
fi
apt_get=("${as_root[@]}" apt-get -qq -o DPkg::Lock::Timeout=300)

echo "Installing system packages: ${packages[*]}"
{
    # First finish what an interrupted installation may have left.
    "${as_root[@]}" dpkg --configure -a &&
        "${apt_get[@]}" update &&
        "${apt_get[@]}" install --no-install-recommends "${packages[@]}"
} >/dev/null || refuse "Installing them failed, see above. Please try again by hand:"
