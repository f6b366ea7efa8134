#!/usr/bin/env bash
# bench film: exported runs, read back by Python, which knows nothing of the program, and pictures.
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
. "$here/../cli/functions.sh"

# A body that moves, one that stays, and none.
for scene in 'garment --set n=12 --set period=0.3' 'drape --set n=7' 'chain --set n=9'; do
  name=${scene%% *}
  mkdir -p "$name"
  # shellcheck disable=SC2086
  "$BENCH_BINARY" film --scene $scene --set duration=0.1 --solver fast_projection --limit 0.02 --step 0.005 \
    --out "$name/it.obj" >paths.txt 2>stderr.txt || fail "$scene: $(tail -1 stderr.txt)"
  while read -r path; do [[ -s $path ]] || fail "$path was named, but is not there"; done < <(grep "^$name/" paths.txt)
done
/usr/bin/python3 "$here/read_back.py" || fail "read_back.py"

refused "must end in" film --out out.avi
refused "must be wider than the waist" film --scene garment --set rim=0.1 --out out.png
refused "takes no collider" film --scene garment --set n=12 --solver soft_step --out out.png
refused "must end in .png" film --stills 0.1 --out out.webp
refused "has no pictures" film --width 100 --out out.obj
refused "is 'x', must be a number of at least 0" film --stills 0.1,x --out out.png

# Pictures, under a name of their own where none is given: by an installed program, which writes below the current folder.
mkdir -p installed/bin installed/share/inextensible
cp "$BENCH_BINARY" installed/bin/bench
cp -r "$here"/../../../{configs,plots} installed/share/inextensible
BENCH_BINARY=installed/bin/bench
film=(--scene drape --set n=7 --set duration=0.1 --solver fast_projection,jacobi --width 32)
exits 0 results/local/film-drape.webp film "${film[@]}"
exits 0 results/local/film-drape-2.webp film "${film[@]}"  # the first is not replaced
exits 0 results/local/film-drape.png film "${film[@]}" --stills 0,0.1
for picture in film-drape.webp film-drape-2.webp film-drape.png; do [[ -s results/local/$picture ]] || fail "no $picture"; done
/usr/bin/python3 -c 'from PIL import Image
flat, met = (Image.open("results/local/film-drape.png").convert("RGB").getpixel((x, 12)) for x in (16, 48))
assert max(flat) < 235 and max(met) < 235, (flat, met)' || fail "cloth in the middle is not seen"
env PATH=/nowhere "$BENCH_BINARY" film "${film[@]}" --out out.png 2>stderr.txt
[[ $? == 2 && $(wc -l <stderr.txt) == 1 && $(<stderr.txt) == *'apt-get install povray'* ]] || fail "without POV-Ray: $(<stderr.txt)"

finish
