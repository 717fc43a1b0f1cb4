#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# embed_test.sh SOURCE BUILD CMAKE CXX: see CMakeLists.txt.
set -euo pipefail
source=$1 build=$2 cmake=$3 cxx=$4
work=$build/tests/install/work
rm -rf "$work"
mkdir -p "$work"

"$cmake" --install "$build" --prefix "$work/prefix" >"$work/install.log"
for file in bin/catoptric share/man/man1/catoptric.1 include/catoptric/renderer/frame.h lib/libcatoptric.so; do
  [ -e "$work/prefix/$file" ] || { echo "not installed: $file" >&2; exit 1; }
done
[ -n "$("$work/prefix/bin/catoptric" --version)" ]

"$cmake" -S "$source/examples/embed" -B "$work/embed" -G Ninja -DCMAKE_PREFIX_PATH="$work/prefix" \
  -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_BUILD_TYPE=Release >"$work/configure.log"
"$cmake" --build "$work/embed" >"$work/build.log" || { cat "$work/build.log" >&2; exit 1; }
"$work/embed/catoptric_embed" "$work/picture.png"

# The picture is a PNG of 480 x 360 with more than a flat colour in it.
python3 - "$work/picture.png" <<'PYTHON'
import struct, sys, zlib
data = open(sys.argv[1], "rb").read()
assert data[:8] == b"\x89PNG\r\n\x1a\n", "not a PNG"
assert struct.unpack(">II", data[16:24]) == (480, 360), "wrong size"
packed, at = b"", 8
while at < len(data):
    length, kind = struct.unpack(">I4s", data[at:at + 8])
    packed += data[at + 8:at + 8 + length] if kind == b"IDAT" else b""
    at += 12 + length
assert len(set(zlib.decompress(packed))) > 64, "hardly any different bytes: an empty picture"
PYTHON

# A run without an argument is refused with the usage.
status=0
"$work/embed/catoptric_embed" 2>/dev/null || status=$?
[ $status = 2 ] || { echo "usage error gave exit $status" >&2; exit 1; }

# pkg-config finds the same library.
export PKG_CONFIG_PATH=$work/prefix/lib/pkgconfig
# shellcheck disable=SC2046  # flags are words
"$cxx" -fsyntax-only $(pkg-config --cflags catoptric) "$source/examples/embed/main.cpp"
case "$(pkg-config --libs catoptric)" in *-lcatoptric*) ;; *) echo "pkg-config --libs lacks the library" >&2; exit 1 ;; esac
