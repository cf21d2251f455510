#!/usr/bin/env bash
# try_deb.sh [PRESET]: makes the .deb of build/PRESET (default release) and tries it where nothing else is: a bare Debian 12
# made on the spot (debootstrap, some 300 MB with the package's own dependencies). Installs it, runs what README.md
# shows, looks for manuals and completions, and removes it again. Needs root, debootstrap and a Debian mirror
# (MIRROR, default http://deb.debian.org/debian); so no part of ./run test.
set -euo pipefail
cd "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")/.."

preset=${1:-release}
mirror=${MIRROR:-http://deb.debian.org/debian}
[ "$(id -u)" -eq 0 ] || { echo "try_deb.sh: needs root" >&2; exit 2; }
command -v debootstrap >/dev/null || { echo "try_deb.sh: needs the package debootstrap" >&2; exit 2; }

work=$(mktemp -d)
trap 'rm -rf --one-file-system "$work"' EXIT
root=$work/debian
cpack --config "build/$preset/CPackConfig.cmake" -B "$work/package"
deb=$(ls "$work"/package/*.deb)
dpkg-deb --info "$deb" | grep -E '^ (Package|Version|Depends|Installed-Size)'

echo "==> a bare Debian 12"
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$work/debootstrap.log" 2>&1 || { tail "$work/debootstrap.log" >&2; exit 1; }
cp "$deb" tests/data/kodim23.png tests/data/kodim05.png "$root/root/"

# A file system of processes, which some packages' scripts want, in a namespace that ends with the script.
cat >"$root/root/try.sh" <<'TRY'
set -euo pipefail
export DEBIAN_FRONTEND=noninteractive LC_ALL=C.UTF-8 HOME=/root
cd /root
apt-get update -qq
apt-get install -qq -y --no-install-recommends ./imgmesh_*.deb >install.log 2>&1 || { tail -n 30 install.log; exit 1; }
echo "==> installed with $(grep -c '^Setting up' install.log) packages in all"

dpkg -L imgmesh >listed
tools="build reconstruct info compare convert warp segment encode decode"
for tool in $tools; do
    imgmesh-$tool --help >/dev/null
    imgmesh-$tool --version
    # Some installations leave manuals out, so ask the package and not the disk.
    for file in /usr/share/man/man1/imgmesh-$tool.1 /usr/share/bash-completion/completions/imgmesh-$tool \
        /usr/share/zsh/vendor-completions/_imgmesh-$tool /usr/share/fish/vendor_completions.d/imgmesh-$tool.fish; do
        grep -qxE "$file(.gz)?" listed || { echo "the package lacks $file"; exit 1; }
    done
done
if find /usr/bin/imgmesh-* /usr/lib -path '*imgmesh*' -type f -perm -100 -exec ldd {} + 2>&1 | grep 'not found'; then exit 1; fi

for picture in kodim23 kodim05; do
    imgmesh-build $picture.png -o $picture.glb
    imgmesh-info $picture.glb --validate --warnings-as-errors
    for mode in map gouraud wire patches; do imgmesh-reconstruct -q $picture.glb -o $picture-$mode.png --mode $mode; done
done
imgmesh-reconstruct -q kodim23.glb -o again.jpg # by OpenImageIO
imgmesh-reconstruct -q kodim23.glb -o again.exr
imgmesh-build -q again.jpg -o jpg.glb
imgmesh-convert -q kodim23.glb -o kodim23.gltf --draco none
imgmesh-convert -q kodim23.glb -o kodim23.svg --shading gradient
imgmesh-compare kodim23.png kodim23.glb
imgmesh-warp -q kodim23.glb --image kodim23.png --handle 200,150:9,-4 -o moved.png
imgmesh-segment -q kodim23.glb -o labels.png --outlines outlines.png
ls -l

# The module for Python, which the package recommends and does not need.
apt-get install -qq -y --no-install-recommends python3-numpy >install.log 2>&1 || { tail -n 30 install.log; exit 1; }
python3 -B -c '
import imgmesh
mesh = imgmesh.build("kodim23.png")
mesh.write("python.glb")
imgmesh.write_image("python.jpg", mesh.reconstruct())
print(mesh, imgmesh.compare("kodim23.png", mesh))'
cmp python.glb kodim23.glb

apt-get purge -qq -y imgmesh >/dev/null 2>&1
if find / -xdev -not -path '/proc/*' -not -path '/root/*' -name '*imgmesh*' | grep -v '^/var/\(lib\|log\|cache\)/'; then
    echo "left behind after purge"
    exit 1
fi
TRY
unshare --mount --pid --fork sh -c "mount -t proc none '$root/proc' 2>/dev/null; exec chroot '$root' bash /root/try.sh"
echo "==> $(basename "$deb") works on a bare Debian 12"
