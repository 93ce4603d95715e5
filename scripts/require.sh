#!/bin/sh
# Stop with a clear line unless a tool of the needed version is here: require.sh python [COMMAND] | require.sh node
# require.sh choose prints the Python to take: a 3.11 where one runs, since pybullet has packages for 3.11 only.
set -eu

case "$1" in
choose)
    for command in python3.11 python3; do
        if "$command" -c 'import ensurepip, venv' >/dev/null 2>&1; then
            echo "$command"
            exit 0
        fi
    done
    echo python3
    ;;
python)
    command="${2:-python3}"
    if ! command -v "$command" >/dev/null 2>&1; then
        echo "Handloom needs Python 3.11 or newer; there is no '$command' here. Install it, or say where it is: make PYTHON=/path/to/python3" >&2
        exit 1
    fi
    if ! "$command" -c 'import sys; sys.exit(sys.version_info < (3, 11))'; then
        echo "Handloom needs Python 3.11 or newer; '$command' is $("$command" --version 2>&1). Name a newer one: make PYTHON=python3.11" >&2
        exit 1
    fi
    if ! "$command" -c 'import ensurepip, venv' 2>/dev/null; then
        echo "'$command' cannot make virtual environments. On Debian and Ubuntu: apt install python3-venv" >&2
        exit 1
    fi
    if ! "$command" -c 'import sys; sys.exit(sys.version_info >= (3, 12))'; then
        echo "setup: '$command' is $("$command" --version 2>&1), and pybullet has packages for 3.11 only: everything but the physics term will work." >&2
        echo "setup: For physics too, install Python 3.11, remove .venv, and run make again; or compile pybullet (7 minutes): .venv/bin/python -m pip install pybullet" >&2
    fi
    ;;
node)
    if ! command -v node >/dev/null 2>&1 || ! command -v npm >/dev/null 2>&1; then
        echo "Handloom builds its browser app with Node 20.19 or newer and npm; they are not on the PATH. See https://nodejs.org" >&2
        exit 1
    fi
    if ! node -e 'const [a, b] = process.versions.node.split(".").map(Number); process.exit(a > 20 || (a === 20 && b >= 19) ? 0 : 1)'; then
        echo "Handloom needs Node 20.19 or newer; 'node' is $(node --version)." >&2
        exit 1
    fi
    ;;
*)
    echo "usage: require.sh choose | require.sh python [COMMAND] | require.sh node" >&2
    exit 2
    ;;
esac
