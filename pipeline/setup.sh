#!/usr/bin/env bash
# Sets up what building and testing need beside Rust, and does nothing where it is all there:
#   1. system packages: a C compiler, make, Python with venv, the shared libraries that Gmsh and VTK load.
#      As root they are installed with apt, else the command to run is printed.
#   2. .venv with the wheels of pipeline/requirements.txt.
set -euo pipefail
cd "$(dirname "$0")/.."

say() { printf 'setup: %s\n' "$*"; }

# --- 1. system packages ------------------------------------------------------------------------------------

# soname -> package of Debian and Ubuntu.
libraries="
libGLU.so.1        libglu1-mesa
libGL.so.1         libgl1
libEGL.so.1        libegl1
libEGL_mesa.so.0   libegl-mesa0
libXrender.so.1    libxrender1
libXcursor.so.1    libxcursor1
libXfixes.so.3     libxfixes3
libXext.so.6       libxext6
libXft.so.2        libxft2
libfontconfig.so.1 libfontconfig1
libXinerama.so.1   libxinerama1
libX11.so.6        libx11-6
libgomp.so.1       libgomp1
"
packages=()
command -v cc >/dev/null || packages+=(gcc libc6-dev)
command -v make >/dev/null || packages+=(make)
# An existing .venv brings its own Python.
if ! [ -x .venv/bin/python ] && ! python3 -c 'import ensurepip, venv' 2>/dev/null; then
  packages+=(python3 python3-venv)
fi
# ldconfig is not on the path of every user.
cache=$(PATH="$PATH:/usr/sbin:/sbin" ldconfig -p)
while read -r soname package; do
  [ -z "$soname" ] || grep -qF "$soname " <<<"$cache" || packages+=("$package")
done <<<"$libraries"

if [ ${#packages[@]} -gt 0 ]; then
  install="apt-get install -y --no-install-recommends ${packages[*]}"
  if ! command -v apt-get >/dev/null; then
    say "missing: ${packages[*]} (Debian's names); install them and run this again" >&2
    exit 3
  elif [ "$(id -u)" -ne 0 ]; then
    say "missing system packages; run this as root, then again \`make setup\`:" >&2
    printf '  apt-get update && %s\n' "$install" >&2
    exit 3
  fi
  say "installing ${packages[*]}"
  export DEBIAN_FRONTEND=noninteractive
  # Another apt may be at work: wait for its lock.
  wait=(-o DPkg::Lock::Timeout=1200)
  apt-get "${wait[@]}" -q update
  apt-get "${wait[@]}" -q install -y --no-install-recommends "${packages[@]}"
fi

if ! command -v cargo >/dev/null; then
  say "cargo is missing; install Rust (https://rustup.rs) and run this again" >&2
  exit 3
fi

# --- 2. Python wheels --------------------------------------------------------------------------------------

# The stamp is written last: an interrupted installation is taken up again.
stamp=.venv/requirements.txt
if ! cmp -s pipeline/requirements.txt "$stamp"; then
  if ! .venv/bin/python -c 'import pip' 2>/dev/null; then
    say "making .venv"
    python3 -m venv --clear .venv
  fi
  say "installing the wheels of pipeline/requirements.txt into .venv"
  .venv/bin/python -m pip install --quiet --disable-pip-version-check --retries 10 -r pipeline/requirements.txt
  cp pipeline/requirements.txt "$stamp"
fi
