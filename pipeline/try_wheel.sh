#!/usr/bin/env bash
# Installs the wheel in target/wheels into a clean environment, as a user would, and goes from a template to series for ParaView with it.
set -euo pipefail
cd "$(dirname "$0")/.."
wheels=(target/wheels/mpm_geotechnics-*.whl)
[ -f "${wheels[0]}" ] && [ ${#wheels[@]} -eq 1 ] || { echo "try_wheel: there is not one wheel in target/wheels; run \`make wheel\`" >&2; exit 2; }
clean=$(mktemp -d)
trap 'rm -rf "$clean"' EXIT
python=$(.venv/bin/python -c 'import sys; print(sys._base_executable)')
"$python" -m venv "$clean/env"
"$clean/env/bin/pip" install --quiet --disable-pip-version-check "${wheels[0]}"
cd "$clean"
# Nothing of this checkout is found: not its programs, and not Gmsh's library in its .venv.
mpm() { env -i HOME="$clean" PATH="$clean/env/bin:/usr/bin:/bin" LD_DEBUG=libs LD_DEBUG_OUTPUT="$clean/libraries" mpm "$@"; }
mpm --version
mpm new footing
mpm run footing --set mesh.parameters.h=0.3
[ -s footing/out/points.pvd ]
grep -q "calling init: $clean/env/[^ ]*libgmsh" "$clean"/libraries.* ||
  { echo "try_wheel: Gmsh's library is not that of the environment" >&2; exit 1; }
echo "try_wheel: ${wheels[0]##*/} works in a clean environment"
