#!/usr/bin/env bash
# The main job from beginning to end: installs what is missing, builds chiaro, lights five balls with three lamps, hides
# the lamps, and finds them again from the light on the surfaces alone. Results are in out/demo.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD
scene=$root/scenes/fiveballs.glb
true_lights=$root/scenes/lights/fiveballs-3.json
result=$root/out/demo
chiaro=$root/build/release/bin/chiaro

step_number=0
step() {
  step_number=$((step_number + 1))
  printf '\n[%d/9, after %d s] %s\n' "$step_number" "$SECONDS" "$1"
}

step "Install what is missing"
bash cmake/install_dependencies.sh

step "Build the release preset (minutes the first time)"
cmake --preset release >/dev/null
cmake --build --preset release --target chiaro
build_seconds=$SECONDS

# Everything is made aside and takes its place at the end, so that out/demo is always whole.
mkdir -p out
work=$(mktemp -d out/demo.XXXXXX.part)
trap 'rm -rf "$root/$work"' EXIT
chmod 755 "$work"
cd "$work"
cp "$true_lights" true.json

step "The light that is wanted: trace what the three lamps of scenes/lights/fiveballs-3.json give"
"$chiaro" illuminate "$scene" --lights true.json -o wanted.glb --samples 1024 --seed 11

step "Bake: how unity lights on a grid light every receiver"
"$chiaro" bake "$scene" --on wanted.glb -o cache.exr --seed 12

step "Solve: from wanted.glb and the cache alone, find the lights"
"$chiaro" solve "$scene" --target wanted.glb --cache cache.exr -o found.glb --seed 13

step "Trace what the found lights give, and compare it with what was wanted (the noise of both included)"
"$chiaro" illuminate "$scene" --lights found.json --on wanted.glb -o got.glb --samples 1024 --seed 14
"$chiaro" compare got.glb wanted.glb

# The same seed for both frames, unlike above: most of their noise is then the same, and the difference shows the lights.
step "Render both: the true lights (before.exr), the found ones (after.exr)"
frame=(--width 512 --samples 96 --seed 15 --preview)
"$chiaro" render "$scene" --lights true.json -o before.exr "${frame[@]}"
"$chiaro" render found.glb -o after.exr "${frame[@]}"

step "Compare the frames"
"$chiaro" compare after.exr before.exr -o DIFF.png

step "The found lights beside the true ones"
"$chiaro" inspect "$scene" --json --quiet >scene.json
python3 "$root/scenes/compare_lights.py" true.json found.json scene.json

cd "$root"
rm -rf "$result"
mv "$work" "$result"
cat <<END

Done in $SECONDS s, $build_seconds s of them to install and build. Open in out/demo:
  before.png, after.png   the scene under the true and under the found lights (before.exr, after.exr: OpenEXR, cd/m²)
  DIFF.png                after, before, eight times their difference, and FLIP
  found.glb, found.json   the scene with the found lights in it (for any glTF program), and the lights alone
  wanted.glb, got.glb     the light on the surfaces, wanted and reached, as vertex colours
  cache.exr               the transport cache (chiaro inspect out/demo/cache.exr)
END
