#!/usr/bin/env bash
# Draws the pictures of the README anew: ./docs/gallery/make.sh
set -euo pipefail
cd "$(dirname "$0")/../.."
cargo build --release
quadrel=${CARGO_TARGET_DIR:-target}/release/quadrel
here=docs/gallery
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT

"$quadrel" --stages "$scratch" -o "$here/gingerbread.svg"
cp "$scratch/stages.svg" "$here/stages.svg"
domains=tests/domains
for domain in hohq/BlobAdapt.control hohq/EllipseAndFourCircles.control hohq/IceCreamConeCommented.control \
    glyphs/LatinModernRoman/u0026.svg glyphs/DejaVuSans/u0038.svg icons/bootstrap/twitter.svg; do
    name=$(basename "${domain%.*}")
    timeout 600 "$quadrel" "$domains/$domain" --order 5 --relative 1e-4 -o "$here/$name.svg" ||
        echo "no picture of $domain"
done
"$quadrel" "$domains/icons/bootstrap/twitter.svg" --order 5 --relative 1e-4 --stages "$scratch"
cp "$scratch/5-regions.svg" "$here/twitter-regions.svg"
for domain in hohq/NACA0012.control glyphs/DejaVuSans/u0038.svg icons/mdi/alpha-b.svg; do
    "$quadrel" "$domains/$domain" --order 5 --relative 1e-5 --stages "$scratch"
    cp "$scratch/stages.svg" "$here/stages-$(basename "${domain%.*}").svg"
done
