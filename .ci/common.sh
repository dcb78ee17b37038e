# SPDX-License-Identifier: LGPL-2.1-or-later
# shellcheck shell=bash disable=SC2034
# Sourced by examples/run, tests/run and .ci/run: install what is missing, run a step with its log and its time.
# Everything runs at the top of the checkout; logs are in build/logs/.

cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
export LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive
mkdir -p build/logs
# Debian's own Python: FreeCAD runs in it.
PATH=/usr/bin:/bin:$PATH

# What each script needs, on Debian 12 (bookworm).
packages_build=(g++ cmake ninja-build libopenvdb-dev libembree-dev libtbb-dev libboost-iostreams-dev libpng-dev
    zlib1g-dev python3-dev)
packages_freecad=(freecad python3-numpy)
packages_tests=(python3-pytest python3-hypothesis python3-numpy xvfb xauth libgl1-mesa-dri ffmpeg pkg-config libcgal-dev
    lib3mf-dev)
packages_ci=(git clang-format clang-tidy cppcheck shellcheck dpkg-dev file pycodestyle pyflakes3 mypy)

die() {
    echo "$*" >&2
    exit 1
}

# step NAME COMMAND...: runs with its output in build/logs/NAME.log, which is printed when the command fails. Not within
# an if: there Bash takes no notice of what fails before the last line of a function.
step() {
    local name=$1 log=build/logs/$1.log started=$SECONDS status
    shift
    set +e
    (
        set -e
        "$@"
    ) >"$log" 2>&1 </dev/null
    status=$?
    set -e
    if ((status)); then
        tail -n 200 "$log" >&2
        die "$name failed (status $status); the whole log: $PWD/$log"
    fi
    printf '%-20s %4d s\n' "$name" $((SECONDS - started))
}

# need PACKAGE...: installs what is missing; asks for nothing when all is there.
need() {
    local package missing=()
    command -v dpkg-query >/dev/null || die "this script installs Debian packages; elsewhere install by hand: $*"
    for package in "$@"; do
        [[ $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) == installed ]] || missing+=("$package")
    done
    ((${#missing[@]})) || return 0
    local root=()
    if ((EUID)); then
        sudo -n true 2>/dev/null || [[ -t 0 && -n $(command -v sudo) ]] ||
            die "packages are missing and this user cannot install them; as root:
    apt-get install --no-install-recommends ${missing[*]}"
        root=(sudo env DEBIAN_FRONTEND=noninteractive)
    fi
    step packages install_packages
}

# In need()'s scope: the lists are refreshed only when they do not know what is wanted. A server that does not answer is
# asked again; what else installs packages at that moment is waited for, ten minutes at most.
install_packages() {
    local apt=("${root[@]}" apt-get -q -y --no-install-recommends -o Dpkg::Use-Pty=0 -o Acquire::Retries=5
        -o DPkg::Lock::Timeout=600)
    "${apt[@]}" install "${missing[@]}" && return
    "${apt[@]}" update && "${apt[@]}" install "${missing[@]}"
}

# configure PRESET [-DOPTION=VALUE...]
configure() {
    local launcher=()
    if command -v ccache >/dev/null; then
        launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    fi
    cmake --preset "$1" "${launcher[@]}" "${@:2}"
}
