#!/usr/bin/env bash
# The command line as a user meets it: outputs, exit codes, and one clear line for each mistake.
# Usage: cli.sh VOX SCENES
set -uo pipefail
vox=$(realpath "$1")
scenes=$(realpath "$2")
here=$(realpath "$(dirname "$0")")
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
failures=0

fail() {
  echo "FAILED: $*"
  failures=$((failures + 1))
}

# expect CODE PATTERN ARGS...: vox ARGS exits with CODE and, unless PATTERN is empty, prints exactly
# one line on stderr that matches it. No output file may appear when it fails.
expect() {
  local code=$1 pattern=$2
  shift 2
  "$vox" "$@" >stdout 2>stderr </dev/null
  local got=$?
  [ "$got" -eq "$code" ] || fail "vox $*: exit code $got, not $code: $(cat stderr)"
  [ -z "$pattern" ] && return
  [ "$(wc -l <stderr)" -eq 1 ] || fail "vox $*: not one line on stderr: $(cat stderr)"
  grep -qE -- "$pattern" stderr || fail "vox $*: stderr does not match '$pattern': $(cat stderr)"
  if [ "$code" -ne 0 ]; then
    grep -q '^vox: error: ' stderr || fail "vox $*: no 'vox: error:' prefix"
    [ -z "$(find . -name '*out*' -not -name 'stdout')" ] || fail "vox $*: left $(ls)"
  fi
}

# Bad input, exit code 3, never an output file.
triangle=$'v 0 0 0\nv 1 0 0\nv 0 1 0\n'
: >empty.obj
: >empty.ply
: >empty.toml
mkdir folder.obj
printf '%sf 0 1 2\n' "$triangle" >zero.obj
printf '%sf 1 2 4\n' "$triangle" >beyond.obj
printf '%sf 1 2 -4\n' "$triangle" >negative.obj
printf 'v 0 nan 0\n%sf 1 2 3\n' "$triangle" >nan.obj
printf 'v 0 inf 0\n%sf 1 2 3\n' "$triangle" >inf.obj
printf 'v 0 1e30 0\n%sf 1 2 3\n' "$triangle" >large.obj
printf '%sf 1 2\n' "$triangle" >digon.obj
printf '%s' "$triangle" >faceless.obj
printf '%sf 1 2 3\nf 1 2 3\n' "$triangle" >winding.obj
printf '%sf 1 2 3\n' "$triangle" >mesh.xyz
printf '%sf 1 2 3\n' "$triangle" >good.obj
printf '[convert]\nspeed = 3\n' >key.toml
printf '[convert]\npart_by = "face"\n[[object]]\nmesh = "good.obj"\n' >key2.toml
printf '[convert\n' >syntax.toml
printf '[[object]]\nmesh = "missing.obj"\n' >missing.toml
cat >header.txt <<'PLY'
ply
format binary_little_endian 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
PLY
{ cat header.txt; printf '\0\0\0\0'; } >truncated.ply
yes 'neither a mesh nor a scene' | head -c 300 | tee garbage.stl >garbage.om
for command in convert subdivide; do
  out=out.vdb
  more=()
  [ $command = subdivide ] && out=out.obj && more=(--levels 1)
  try() { expect 3 "$1" $command "$2" -o $out "${more[@]}"; }
  try 'empty.obj: .*empty' empty.obj
  try 'empty.ply: .*empty' empty.ply
  try 'empty.toml: ' empty.toml
  try 'missing.obj: .*no such file' missing.obj
  try 'folder.obj: .*(folder|directory|regular)' folder.obj
  try 'zero.obj:4: ' zero.obj
  try 'beyond.obj:4: ' beyond.obj
  try 'negative.obj:4: ' negative.obj
  try 'nan.obj:1: ' nan.obj
  try 'inf.obj:1: ' inf.obj
  try 'large.obj:1: ' large.obj
  try 'digon.obj: no faces: dropped 1 face' digon.obj
  try 'faceless.obj: .*face' faceless.obj
  try 'mesh.xyz: .*extension' mesh.xyz
  try 'truncated.ply: .*truncated' truncated.ply
  try 'garbage.stl: ' garbage.stl
  try 'garbage.om: ' garbage.om
  try "key.toml:2:1: unknown key 'speed'" key.toml
  try 'syntax.toml:1:' syntax.toml
  try 'missing.toml:2:8: .*missing.obj' missing.toml
done

# Usage, exit code 2.
expect 2 'dim' convert good.obj -o out.vdb --dim 0
expect 2 'dim' convert good.obj -o out.vdb --dim many
expect 2 'voxel-size' convert good.obj -o out.vdb --voxel-size -1
expect 2 'voxel-size' convert good.obj -o out.vdb --voxel-size 0
expect 2 'voxel-size.*dim|dim.*voxel-size' convert good.obj -o out.vdb --voxel-size 1 --dim 3
expect 2 'bounds.*x0,y0,z0' convert good.obj -o out.vdb --bounds 0,0,0,1,1
expect 2 'bounds.*six numbers' convert good.obj -o out.vdb --bounds 0,0,0,1,1,nan
expect 2 'bounds.*low one first' convert good.obj -o out.vdb --bounds 0,0,0,1,-1,1
for option in --bounds --like --texture --split --part-by --edge --alpha --grids; do
  expect 2 "$option: must not be empty" convert good.obj -o out.vdb "$option" ''
done
expect 2 'alpha cut needs --edge hard .soft is the default of --target blender' \
  convert good.obj -o out.vdb --alpha cut --target blender
expect 2 'clip needs --like' convert good.obj -o out.vdb --clip
expect 2 'like.*dim|dim.*like' convert good.obj -o out.vdb --dim 3 --like good.vdb
expect 2 'like.*voxel-size|voxel-size.*like' convert good.obj -o out.vdb --voxel-size 3 --like good.vdb
expect 3 'missing.vdb:density: no such file' convert good.obj -o out.vdb --like missing.vdb:density
expect 3 'good.obj: is not an OpenVDB file' convert good.obj -o out.vdb --like good.obj
expect 2 'unknown grid .fog.' convert good.obj -o out.vdb --grids fog
expect 2 'unknown option --dims; did you mean --dim?' convert good.obj -o out.vdb --dims 3
expect 2 'unknown option --voxelsize; did you mean --voxel-size?' convert good.obj -o out.vdb --voxelsize=1
expect 2 'unknown command konvert; did you mean convert?' konvert good.obj -o out.vdb
expect 2 'output' convert good.obj
expect 2 'levels' subdivide good.obj -o out.obj
expect 2 'levels' subdivide good.obj -o out.obj --levels -1
expect 2 'out.vdb: .*\.obj' subdivide good.obj -o out.vdb --levels 1
expect 2 'max-memory' convert good.obj -o out.vdb --max-memory lots
expect 2 '(--force|convert).*maybe' convert good.obj -o out.vdb --dim=3 --force=maybe
expect 2 'true or false: --strict=maybe' convert good.obj -o out.vdb --dim=3 --strict=maybe
expect 2 'true or false: --strict=99999999999999999999' convert good.obj -o out.vdb --strict=99999999999999999999
expect 2 '' # no command at all

# Limits, exit code 4; output, exit code 5.
expect 4 'memory' convert "$scenes/cube.toml" -o out.vdb --dim 100000 --max-memory 256M
printf 'v 1e6 0 0\nv 1e6 1 0\nv 1e6 0 1\nf 1 2 3\n' >far.obj
expect 4 'voxel size of at least' convert far.obj -o out.vdb --voxel-size 2e-5
expect 4 'memory' subdivide "$scenes/cube.toml" -o out.obj --levels 20 --max-memory 256M
expect 5 'nowhere' convert good.obj -o nowhere/out.vdb
mkfifo fifo.vdb
expect 5 'regular' convert good.obj -o fifo.vdb --force
"$vox" convert good.obj -o - --dim 8 >/dev/full 2>stderr
[ $? -eq 5 ] || fail "a full disk behind stdout: $(cat stderr)"

# Pictures.
"$vox" convert "$scenes/cube.toml" -o cube.vdb --dim 16 --quiet
head -c 2000 cube.vdb >cut.vdb
head -c 2000 /dev/urandom >noise.vdb
expect 2 'out.jpg: .*\.png' render good.obj -o out.jpg
expect 2 'unknown option --sice; did you mean --size?' render good.obj -o out.png --sice 3x3
expect 2 'size' render good.obj -o out.png --size 30
expect 2 'size' render good.obj -o out.png --size 0x30
expect 2 'width.*16384' render good.obj -o out.png --size 99999x30
expect 2 'view.*front' render good.obj -o out.png --view sideways
expect 2 'elevation' render good.obj -o out.png --view 30
expect 2 'background' render good.obj -o out.png --background '#12345'
expect 2 'shading.*congradient' render good.obj -o out.png --shading gouraud
expect 2 'projection' render good.obj -o out.png --projection fisheye
expect 2 'up' render good.obj -o out.png --up x
expect 2 '--dim is for meshes' render cube.vdb -o out.png --dim 30
expect 2 '--threshold is for .vdb' render good.obj -o out.png --threshold 1
expect 3 'missing.vdb: .*no such file' render missing.vdb -o out.png
expect 3 'cut.vdb: ' render cut.vdb -o out.png
expect 3 'noise.vdb: ' render noise.vdb -o out.png
expect 3 'no grid fog; there are density' render cube.vdb -o out.png --grid fog
expect 3 'threshold' render cube.vdb -o out.png --threshold 1000
expect 3 'nan.obj:1: ' render nan.obj -o out.png
expect 4 'memory' render cube.vdb -o out.png --size 9999x9999 --max-memory 1M
expect 5 'nowhere' render cube.vdb -o nowhere/out.png
expect 0 'cube.png: 60 x 40 pixels' render cube.vdb -o cube.png --size 60x40
expect 5 'force' render cube.vdb -o cube.png --size 60x40
expect 0 'cube.png: 60 x 40 pixels' render cube.vdb -o cube.png --size 20x20 --views front,top,30,20,-10,-20,iso --force --background transparent --projection perspective --samples 1 --occlusion 0
expect 0 '' render cube.vdb -o a.png --size 90x70 --threads 1
expect 0 '' render cube.vdb -o b.png --size 90x70 --threads 3
cmp -s a.png b.png || fail "render: pictures differ"
expect 0 '' render "$scenes/cube.toml" -o b.png --dim 16 --size 90x70 --force --shading congradient
cmp -s a.png b.png || fail "render: the picture of a scene is not that of its .vdb file"
"$vox" render cube.vdb -o - --size 90x70 2>/dev/null | cmp -s - a.png || fail "render: stdout differs"
"$vox" render cube.vdb -o - >/dev/full 2>stderr
[ $? -eq 5 ] || fail "render: a full disk behind stdout: $(cat stderr)"

# What works.
expect 0 '' --help
expect 0 '' --version
for command in convert merge subdivide info diff check render; do
  expect 0 '' $command --help
done
expect 0 'active voxels' convert "$scenes/toy_jack.toml" -o jack.vdb --dim 64 --grids density,mask
expect 5 'force' convert "$scenes/toy_jack.toml" -o jack.vdb --dim 64 --grids density,mask
cp jack.vdb first.vdb
expect 0 'active voxels' convert "$scenes/toy_jack.toml" -o jack.vdb --dim 64 --grids density,mask --force --threads 1
cmp -s jack.vdb first.vdb || fail "two runs differ"
"$vox" convert "$scenes/toy_jack.toml" -o - --dim 64 --grids density,mask 2>/dev/null | cmp -s - first.vdb || fail "stdout differs"
expect 0 '' convert "$scenes/toy_jack.toml" -o jack.vdb --dim 64 --grids density,mask --force --quiet
[ -s stderr ] && fail "--quiet is not quiet"

# NanoVDB files: the same grids, from and for every command.
expect 0 'jack.nvdb: [0-9]+ active voxels' convert "$scenes/toy_jack.toml" -o jack.nvdb --dim 64 --grids density,mask
expect 5 'force' convert "$scenes/toy_jack.toml" -o jack.nvdb --dim 64
expect 0 '' diff --no-metadata jack.vdb jack.nvdb
expect 1 '' diff jack.vdb jack.nvdb
grep -q 'metadata vox_version' stdout || fail "diff: .nvdb has metadata"
expect 0 '' info jack.nvdb
grep -q 'grid density: Tree_float_5_4_3, fog volume' stdout || fail "info: no density in .nvdb"
expect 0 '' check jack.nvdb --mesh "$scenes/toy_jack.toml"
expect 0 '' render jack.nvdb -o nvdb.png --size 64x64
expect 0 'copied.nvdb: 2 grids' convert jack.vdb -o copied.nvdb
cmp -s copied.nvdb jack.nvdb || fail "convert: .nvdb of a mesh and of its .vdb differ"
expect 0 'copied.vdb: 2 grids' convert copied.nvdb -o copied.vdb --compression zip
expect 0 '' diff --no-metadata copied.vdb jack.vdb
expect 0 'copied.vdb: 2 grids' convert jack.vdb -o copied.vdb -f
expect 0 '' diff copied.vdb jack.vdb
expect 0 '' merge copied.nvdb jack.nvdb -o united.vdb
expect 0 '' diff --no-metadata united.vdb jack.vdb
expect 0 'likewise.vdb' convert "$scenes/toy_jack.toml" -o likewise.vdb --like jack.nvdb:density --grids density,mask
expect 0 '' diff --no-metadata likewise.vdb jack.vdb
for compression in blosc zip none; do
  expect 0 '' convert jack.vdb -o copied.nvdb --compression $compression -f --threads 1
  "$vox" convert -q jack.vdb -o again.nvdb --compression $compression -f
  cmp -s copied.nvdb again.nvdb || fail ".nvdb of 1 thread differs"
  expect 0 '' diff --no-metadata jack.vdb copied.nvdb
  head -c 2000 copied.nvdb >cut.nvdb
  expect 3 'cut.nvdb: is (truncated|damaged)' info cut.nvdb
  expect 3 'cut.nvdb: is (truncated|damaged)' convert cut.nvdb -o out.vdb
done
expect 2 'jack.vdb: --dim is for meshes and scenes only' convert jack.vdb -o out.nvdb --dim 3
expect 2 'jack.vdb: is the input' convert jack.vdb -o jack.vdb -f
expect 2 'out.nvdb: .*--half' convert good.obj -o out.nvdb --dim 3 --half
expect 2 'out.nvdb: .*vox merge' convert good.obj -o out.nvdb --dim 3 --part 1/2
expect 2 'must end in .vdb' diff jack.vdb jack.nvdb -o out.nvdb
expect 2 'must end in .vdb' merge jack.vdb jack.nvdb -o out.nvdb
cp jack.vdb wrong.nvdb
expect 3 'wrong.nvdb: is not a NanoVDB file' diff jack.vdb wrong.nvdb
cp jack.nvdb wrong.vdb
expect 3 'wrong.vdb: is not an OpenVDB file' check wrong.vdb

# Each scene gives the voxels it states.
for scene in "$scenes"/*.toml; do
  stated=$(sed -n 's/^# Active voxels: //p' "$scene")
  expect 0 '' convert "$scene" -o scene.vdb --force
  grep -q "scene.vdb: $stated active voxels" stderr || fail "$scene states $stated voxels: $(cat stderr)"
done

expect 0 '' info jack.vdb "$scenes/toy_jack.toml" "$scenes/sheet.toml"
grep -q 'grid density: Tree_float_5_4_3, fog volume' stdout || fail "info: no density"
grep -q 'grid mask: Tree_mask_5_4_3' stdout || fail "info: no mask"
grep -q 'Euler characteristic 2' stdout || fail "info: the jack is not a sphere"
grep -q 'closed' stdout || fail "info: the jack is not closed"
grep -q '1 loop of 16 edges' stdout || fail "info: the sheet has no boundary"
expect 0 '' info --json jack.vdb "$scenes/cube.obj"
python3 - stdout <<'PY' || fail "info --json"
import json, sys
vdb, mesh = json.load(open(sys.argv[1]))
assert [grid["name"] for grid in vdb["grids"]] == ["density", "mask"]
assert vdb["grids"][0]["active_voxels"] == vdb["grids"][1]["active_voxels"] > 1000
cube = mesh["meshes"][0]
assert cube["valences"] == {"3": 8}
assert cube["closed"] and cube["orientable"] and cube["genus"] == 0
assert cube["repair"] == {} and cube["prepared"]["faces"] == 6
PY

# Parts: two cubes that overlap, in one file.
{
  printf 'o the "left" one\n'
  sed -n '/^[vf]/p' "$scenes/cube.obj"
  printf 'o right-hand\n'
  sed -n '/^[vf]/p' "$scenes/cube.obj" | awk '/^v/ {print "v", $2 + 1.2, $3 + 0.7, $4 + 0.4} /^f/ {for (i = 2; i <= NF; ++i) $i += 8; print}'
} >parts.obj
expect 0 'active voxels' convert parts.obj -o parts.vdb --dim 32 --grids density,part
expect 0 '' check parts.vdb
expect 0 '' info parts.obj
grep -q 'objects  *2: the "left" one (' stdout || fail "info: no names of objects"
expect 0 '' info parts.vdb
grep -q 'vox_part_names  *{"1": "the \\"left\\" one", "2": "right-hand"}' stdout || fail "info: no names of parts"
expect 0 '' info --json parts.vdb
python3 - stdout <<'PY' || fail "grid part"
import json, sys
density, part = json.load(open(sys.argv[1]))[0]["grids"]
assert part["type"] == "Tree_int32_5_4_3" and part["name"] == "part", part
assert part["active_voxels"] == density["active_voxels"] > 1000
assert json.loads(part["metadata"]["vox_part_names"]) == {"1": 'the "left" one', "2": "right-hand"}
PY
expect 0 '' diff parts.vdb parts.vdb
expect 0 '' render parts.vdb -o parts.png --size 60x50
expect 0 'active voxels' convert parts.obj -o split.vdb --dim 32 --split part --verify
expect 0 '' check split.vdb --mesh parts.obj
grep -q 'parts: no tunnels' stdout || fail "check: no word of tunnels of parts"
expect 0 '' render split.vdb -o split.png --size 60x50
expect 0 '' info --json split.vdb
python3 - stdout <<'PY' || fail "--split"
import json, sys
grids = json.load(open(sys.argv[1]))[0]["grids"]
names = {grid["name"]: grid["metadata"]["vox_part_name"] for grid in grids}
assert names == {"the__left__one": 'the "left" one', "right_hand": "right-hand"}, names
assert sum(grid["active_voxels"] for grid in grids) == int(grids[0]["metadata"]["vox_active_voxels"])
PY
printf '[convert]\ngrids = ["density", "part"]\npart_by = "material"\nsplit = "part"\n[[object]]\nmesh = "parts.obj"\nname = "both"\n' >parts.toml
expect 0 'active voxels' convert parts.toml -o both.vdb --dim 32
expect 0 '' info both.vdb
grep -q 'vox_part_name  *both$' stdout || fail "scene: part_by and split"
expect 3 'part_by must be one of object, group, material' convert key2.toml -o out.vdb
expect 2 '--split splits the grid density' convert parts.obj -o out.vdb --split part --grids mask
expect 2 'contradict each other' convert parts.obj -o out.vdb --split object --part-by group
expect 2 '--part-by must be one of object, group, material' convert parts.obj -o out.vdb --part-by face
expect 3 'missing.vdb' info missing.vdb
expect 0 '' info winding.obj
grep -q 'repair  *dropped 1 duplicate face' stdout || fail "info: no word of the repair"
grep -q 'after repair: 3 vertices, 3 edges, 1 face' stdout || fail "info: not after repair"
expect 0 '' info --json winding.obj
python3 - stdout <<'PY' || fail "info --json of a repair"
import json, sys
mesh = json.load(open(sys.argv[1]))[0]["meshes"][0]
assert mesh["faces"] == 2 and mesh["prepared"]["faces"] == 1
assert mesh["prepared"]["boundary_loops"] == [3]
assert mesh["repair"]["dropped duplicate faces"]["count"] == 1
assert "face 1" in mesh["repair"]["dropped duplicate faces"]["first"]
PY

for format in obj ply off; do
  expect 0 '96 vertices, 98 faces' subdivide "$scenes/cube.obj" -o "cube.$format" --levels 2
  expect 0 '' subdivide "cube.$format" -o again.obj --levels 0 --force
  [ $format = obj ] && cp again.obj reference.obj
  cmp -s again.obj reference.obj || fail "$format does not keep the mesh"
done
"$vox" subdivide "$scenes/cube.obj" -o - --levels 2 2>/dev/null | cmp -s - cube.obj || fail "OBJ on stdout"

# Smoothing.
expect 0 '64 vertices' subdivide "$scenes/sheet.toml" -o sheet.obj --levels 1 --boundary free
expect 0 'sheet.obj: 96 vertices' subdivide "$scenes/sheet.toml" -o sheet.obj --levels 1 --force
echo 0 >first.txt
echo '6 7 # two of the interior' >vertices.txt
expect 0 '25 vertices' subdivide "$scenes/sheet.toml" -o sheet.obj --levels 0 --force --interpolate boundary --interpolate-vertices vertices.txt
expect 3 'vertex 0 cannot be interpolated: it is on the boundary' subdivide "$scenes/sheet.toml" -o out.obj --levels 0 --interpolate-vertices first.txt
expect 0 'active voxels' convert "$scenes/sheet.toml" -o sheet.vdb --dim 32 --interpolate both
expect 2 'one of extend, free, corners' convert good.obj -o out.vdb --boundary round
printf '0 1\n1 3 # an edge\n' >edges.txt
expect 0 'active voxels' convert "$scenes/cube.obj" -o sharp.vdb --dim 20 --crease 40 --report sharp.json
grep -q '"sharp_edges": 12' sharp.json || fail "the report has no sharp edges"
expect 0 '' info "$scenes/cube.obj" --crease 89
grep -q 'creases  *12 sharp edges, 8 corner vertices, 0 darts' stdout || fail "info: no creases"
expect 0 '' info "$scenes/cube.obj" --crease-edges edges.txt
grep -q 'creases  *2 sharp edges, 0 corner vertices, 2 darts' stdout || fail "info: no listed creases"
expect 0 '' info "$scenes/sheet.toml" --boundary corners
grep -q 'creases  *0 sharp edges, 4 corner vertices, 0 darts' stdout || fail "info: no corners of the boundary"
expect 2 '--boundary must be one of extend, free, corners' info "$scenes/sheet.toml" --boundary round
expect 0 '' check sharp.vdb --mesh "$scenes/cube.obj" --ignore no-density
expect 0 'active voxels' convert "$scenes/cube.obj" -o flat.vdb --dim 20 --crease 40 --until levels=0
expect 3 'has no smoothing groups, so no edge is sharp by group, which --strict forbids' convert "$scenes/cube.obj" -o no.vdb --dim 20 --crease groups --strict
printf '0 7\n' >noedge.txt
expect 3 'the mesh has no edge at 1 of the 1 pairs .*, which --strict forbids' convert "$scenes/cube.obj" -o no.vdb --dim 20 --crease-edges noedge.txt --strict
expect 0 'sharp.obj: ' subdivide "$scenes/cube.obj" -o sharp.obj --levels 3 --crease 40
expect 0 '' info sharp.obj
grep -q 'closed, orientable, genus 0' stdout || fail "subdivide: not joined along creases"
expect 2 "degrees from 0 to 180, groups, or both with a comma, not '200'" convert good.obj -o out.vdb --crease 200
expect 2 'creases need a boundary that the surface reaches' convert good.obj -o out.vdb --crease 30 --boundary free
expect 3 'first.txt: has 1 numbers, but pairs are wanted' convert good.obj -o out.vdb --crease-edges first.txt
expect 2 'one of none, interior' convert good.obj -o out.vdb --interpolate all
expect 2 'free boundary cannot be interpolated' convert good.obj -o out.vdb --boundary free --interpolate both
echo '1 two' >wrong.txt
expect 3 'wrong.txt:1: ' convert good.obj -o out.vdb --interpolate-vertices wrong.txt

# Polygons: the cube of 8 voxels has 9^3 - 7^3 on its faces.
expect 0 ': 386 active voxels' convert "$scenes/cube.obj" -o polygons.vdb --dim 8 --until levels=0
expect 0 ': 386 active voxels' convert "$scenes/cube.obj" -o polygons26.vdb --dim 8 --until levels=0 --separating 26
expect 0 '' info polygons.vdb polygons26.vdb
for separating in 6 26; do
  grep -q "vox_guarantee.*[^2]$separating-separating" stdout || fail "guarantee of $separating: $(cat stdout)"
done
expect 0 '' convert "$scenes/cube.obj" -o polygons.vdb --dim 8 --until levels=1 --verbose --force
grep -q ', 44 triangles after 1 levels' stderr || fail "triangles: $(cat stderr)"
# The command line wins over the object, the object over [convert].
cube="mesh = '$scenes/cube.obj'"
printf '[convert]\ndim = 8\nuntil = { levels = 1 }\n[[object]]\nuntil = { levels = 0 }\n%s\n' "$cube" >until.toml
expect 0 ': 386 active voxels' convert until.toml -o until.vdb
expect 0 ': 386 active voxels' convert until.toml -o until.vdb --force --separating 26
expect 0 '' convert until.toml -o until.vdb --force --until voxel --verbose
grep -q 'submesh' stderr || fail "--until over an object's: $(cat stderr)"
printf '[convert]\ndim = 8\nuntil = { levels = 0 }\n[[object]]\n%s\n' "$cube" >until.toml
expect 0 ': 386 active voxels' convert until.toml -o until.vdb --force
for until in voxels levels levels=31 levels=-1 levels=two; do
  expect 2 '--until must be one of voxel, levels=K' convert good.obj -o out.vdb --until "$until"
done
expect 2 "--separating must be 6 or 26, not '18'" convert good.obj -o out.vdb --separating 18
for until in diameter=0 angle=181 flatness=-1 levels=1,, diameter=nan diameter; do
  expect 2 '--until must be one of voxel, levels=K' convert good.obj -o out.vdb --until "$until"
done
expect 2 "needs --until voxel, not angle=5" convert good.obj -o out.vdb --until angle=5 --voxelize vertex
expect 2 'cannot make 26-separating' convert good.obj -o out.vdb --separating 26 --voxelize vertex
expect 2 '--voxelize must be one of auto, vertex, polygon' convert good.obj -o out.vdb --voxelize all
expect 0 '' convert "$scenes/cube.obj" -o smooth26.vdb --dim 32 --separating 26 --verbose
grep -q 'until flatness=0.1' stderr || fail "26-separating until voxel: $(cat stderr)"
expect 0 '' convert "$scenes/cube.obj" -o limits.vdb --dim 32 --until angle=5,diameter=4 --until flatness=0.5 --verbose
grep -q 'until diameter=4,angle=5,flatness=0.5' stderr || fail "limits: $(cat stderr)"
printf '[convert]\ndim = 32\nvoxelize = "polygon"\n[[object]]\nuntil = { angle = 5, diameter = 4 }\n%s\n' "$cube" >limits.toml
expect 0 '' convert limits.toml -o limits.vdb --force --verbose
grep -q 'until diameter=4,angle=5' stderr || fail "limits of a scene: $(cat stderr)"
expect 4 'larger limit' convert "$scenes/cube.obj" -o out.vdb --until diameter=1e-6
printf '[convert]\nuntil = { levels = 31 }\n[[object]]\n%s\n' "$cube" >until.toml
expect 3 'until.toml:2:20: levels must lie between 0 and 30' convert until.toml -o out.vdb
expect 4 'use fewer levels' convert "$scenes/cube.obj" -o out.vdb --until levels=30 --max-memory 256M

# Solid textures: from the scene, or of all objects.
printf '[convert]\ndim = 8\ngrids = ["color"]\n[[object]]\n%s\ntexture = { kind = "checker", scale = 0.5, colors = ["#ff0000", [0, 0, 1]] }\n' "$cube" >texture.toml
expect 0 'active voxels' convert texture.toml -o color.vdb
expect 0 'active voxels' convert texture.toml -o color2.vdb --texture 'checker:scale=0.5,colors=1:0:0/0:0:1'
expect 0 '' info color.vdb color2.vdb
grep -q 'grid color: Tree_vec3s_5_4_3' stdout || fail "no color: $(cat stdout)"
grep -q 'vox_options.*texture=checker:scale=0.5,colors=1:0:0/0:0:1' stdout || fail "no texture in the metadata: $(cat stdout)"
expect 0 '' convert "$scenes/cube.obj" -o color3.vdb --dim 8 --texture marble
expect 0 '' info color3.vdb
[ "$(grep -c 'grid density\|grid color' stdout)" -eq 2 ] || fail "--texture does not bring the color grid: $(cat stdout)"
expect 2 "unknown texture 'marbel'; known are checker" convert good.obj -o out.vdb --texture marbel
expect 2 "texture checker has no 'size'; it has scale, space, colors" convert good.obj -o out.vdb --texture checker:size=1
expect 2 '--texture needs color among --grids' convert good.obj -o out.vdb --texture checker --grids mask
texture_error() {  # PATTERN TEXTURE
  printf '[[object]]\n%s\ntexture = %s\n' "$cube" "$2" >texture.toml
  expect 3 "texture.toml:3:$1" convert texture.toml -o out.vdb
}
texture_error "[0-9]+: unknown texture 'wood'" '"wood"'
texture_error '11: texture must be a string' 7
texture_error '11: a texture needs a kind' '{ scale = 1 }'
texture_error "[0-9]+: texture marble: scale must be a number above 0, not '-1'" '{ kind = "marble", scale = -1 }'
texture_error '[0-9]+: texture marble has no .size.; it has scale' '{ kind = "marble", size = 1 }'
texture_error '[0-9]+: .*colors must be 2 to 16' '{ kind = "marble", colors = [[1, 0, 0]] }'
texture_error '[0-9]+: colors must be a number, a text or a list' '{ kind = "marble", colors = [1, [], {}] }'
# Volumes: the command line wins over the scene.
printf '[convert]\nfill = "solid"\ngain = 3\n[[object]]\nname = "block"\n%s\n' "$cube" >solid.toml
expect 0 'active voxels' convert solid.toml -o solid.vdb --dim 64 --report solid.json
expect 0 'active voxels' convert solid.toml -o shell.vdb --dim 64 --fill surface
"$vox" info --json solid.vdb shell.vdb >info.json
python3 - <<'PY' || fail "a solid"
import json
solid, shell = (file["grids"][0]["active_voxels"] for file in json.load(open("info.json")))
# The smoothed cube lies between the ball of the same width and the cube, the shell counts for a bit.
assert 0.52 * 64**3 < solid < 0.95 * 64**3 and shell < solid / 5, (solid, shell)
assert json.load(open("solid.json"))["options"]["fill"] is None
PY
expect 2 "--fill must be one of surface, solid, not 'half'" convert good.obj -o out.vdb --fill half
expect 2 "--open-mesh must be one of" convert good.obj -o out.vdb --open-mesh maybe
expect 2 'gain must lie between' convert good.obj -o out.vdb --gain 0
expect 2 'gain' convert good.obj -o out.vdb --gain lots
expect 3 'good: 1 of its 1 component has no inside; the first, of 1 face, is open at .*--open-mesh' convert good.obj -o out.vdb --fill solid --open-mesh error
expect 0 '' convert good.obj -o good.vdb --fill solid --dim 16
grep -q 'warning: good: 1 of its 1 component has no inside' stderr || fail "open: $(cat stderr)"

for wrong in '--compression lzma' '--target maya' '--up x'; do
  # shellcheck disable=SC2086
  expect 2 "${wrong% *} must be one of .*, not '${wrong#* }'" convert good.obj -o out.vdb $wrong
done
printf '[convert]\nhalf = true\ntarget = "houdini"\nup = "z"\ncompression = "zip"\n[[object]]\n%s\n' "$cube" >file.toml
expect 0 'active voxels' convert file.toml -o file.vdb --dim 32
expect 0 'active voxels' convert file.toml -o file2.vdb --dim 32 --half=false --compression none
[ "$(stat -c %s file.vdb)" -lt "$(stat -c %s file2.vdb)" ] || fail "half floats and zip do not save space"

printf '[convert]\ngrids = ["surface"]\nband = 4\n[[object]]\n%s\n' "$cube" >level.toml
expect 0 'active voxels' convert level.toml -o level.vdb --dim 32
"$vox" info level.vdb | grep -q 'grid surface: .*level set' || fail "no level set"
expect 0 'active voxels' convert level.toml -o level.vdb --dim 32 --grids surface,density,mask --band 3 --force
expect 2 'the band must lie between 1 and 1000, not 0.2' convert good.obj -o out.vdb --band 0.2 --grids surface
expect 2 'the band must lie between 1 and 1000, not 0$' convert good.obj -o out.vdb --band 0
expect 2 'the band must lie between 1 and 1000, not 2000' convert good.obj -o out.vdb --band 2000
expect 2 'the band must lie between 1 and 1000, not 2000' convert good.obj -o out.vdb --band 3,2000
for wrong in a 1,2,3 1, ,1; do
  expect 2 "--band must be a number of voxels, or two with a comma .*, not '$wrong'" convert good.obj -o out.vdb --band "$wrong"
  [ "$(wc -l <stderr)" = 1 ] || fail "more than a line: $(cat stderr)"
done
expect 0 'active voxels' convert "$scenes/cube.toml" -o widths.vdb --dim 32 --grids surface --band 3.5,5 --report widths.json
python3 -c 'import json, sys; sys.exit(json.load(open("widths.json"))["options"]["band"] != [3.5, 5])' ||
  fail "band in the report: $(cat widths.json)"
"$vox" info widths.vdb | grep -q 'band=3.5,5' || fail "no band in the metadata"
expect 0 '' check widths.vdb --ignore no-density
for band in 1 2 1,3 3,1; do
  expect 0 'active voxels' convert "$scenes/cube.toml" -o narrow.vdb --dim 32 --grids surface --band $band --force
  expect 0 '' check narrow.vdb --ignore no-density
done
grep -q 'warning narrow-band: surface: holds distances up to 1 voxel outside' stdout || fail "check: no word of a narrow band: $(cat stdout)"
expect 0 '' convert "$scenes/cube.toml" -o widths.vdb --dim 32 --grids surface --force --verbose
grep -q 'not voxelized' stderr || fail "verbose: $(cat stderr)"
grep -q 'grid surface: [0-9]* active voxels, distances from -.* to ' stderr || fail "verbose: $(cat stderr)"
! grep -qE ' 0 (submeshes|vertices|active)' stderr || fail "verbose: $(cat stderr)"
expect 0 'active voxels' convert "$scenes/cube.toml" -o widths.vdb --dim 32 --grids surface --band 3.5,5 --force
printf '[convert]\ngrids = ["surface"]\nband = [2, 5]\n[[object]]\n%s\n' "$cube" >widths.toml
expect 0 'active voxels' convert widths.toml -o widths2.vdb --dim 32
expect 0 '' check widths2.vdb --ignore no-density
printf '[convert]\ntolerance = 0.2\n[[object]]\n%s\n' "$cube" >tolerance.toml
for arguments in 'level.toml --tolerance 0.3' tolerance.toml 'tolerance.toml --tolerance 0.3' 'tolerance.toml --dry-run'; do
  # shellcheck disable=SC2086
  expect 0 '' convert $arguments -o level.vdb --dim 32 --force
  [ "$(grep -c 'warning: the tolerance has no effect any more; leave it out' stderr)" = 1 ] ||
    fail "$arguments: $(cat stderr)"
done
expect 2 'the tolerance must lie' convert good.obj -o out.vdb --tolerance 0 --grids surface
expect 4 'memory' convert "$scenes/cube.toml" -o out.vdb --grids surface --dim 3000 --max-memory 256M

# Sequences share one transform.
mkdir frames
for frame in 7 8 10; do
  awk -v s="$frame" '$1 == "v" {print "v", $2 * s, $3 * s, $4 * s; next} {print}' "$scenes/cube.obj" \
    >"frames/c.00$(printf %02d "$frame").obj"
done

# Lattices of other files, and crops.
expect 0 '' convert "$scenes/torus.obj" -o reference_lattice.vdb --dim 40
expect 0 '' convert "$scenes/cube.obj" -o like.vdb --like reference_lattice.vdb
"$vox" info --json reference_lattice.vdb like.vdb >info.json
python3 - <<'PY' || fail "--like"
import json
a, b = [file["grids"][0] for file in json.load(open("info.json"))]
assert a["voxel_size"] == b["voxel_size"] and a["origin"] == b["origin"], (a, b)
assert "dim=" not in b["metadata"]["vox_options"], b
PY
expect 3 "reference_lattice.vdb: has no grid 'fog'; it has density" convert good.obj -o no.vdb --like reference_lattice.vdb:fog
expect 0 '' check like.vdb --mesh "$scenes/cube.obj" --quiet
expect 0 '' convert "$scenes/cube.obj" -o clip.vdb --like reference_lattice.vdb:density --clip
expect 0 '' convert "$scenes/torus.obj" -o part.vdb --dim 40 --bounds=-9,-9,-9,0.1,9,9
expect 3 'was cropped' check part.vdb --mesh "$scenes/torus.obj"
expect 2 'verify needs the whole' convert "$scenes/torus.obj" -o no.vdb --verify --bounds 0,0,0,1,1,1
expect 0 '' convert "$scenes/torus.obj" -o none.vdb --bounds 90,90,90,99,99,99
grep -q 'warning: no active voxel lies in the box' stderr || fail "no warning of an empty box"
expect 0 '' convert "$scenes/torus.obj" --dim 40 --bounds=-9,-9,-9,0.1,9,9 --dry-run
printf 'convert = {dim = 40, bounds = [-9, -9, -9, 0.1, 9, 9]}\n[[object]]\nmesh = "%s"\n' \
  "$scenes/torus.obj" >part.toml
expect 0 '' convert part.toml -o scene_part.vdb
expect 0 '' diff part.vdb scene_part.vdb --no-metadata
printf 'convert = {dim = 20, split = "object", alpha = "cut"}\n[[object]]\nmesh = "good.obj"\n' >scene_split.toml
expect 0 '' convert scene_split.toml -o scene_split.vdb
expect 0 'pixels' render scene_split.toml -o scene_split.png --size 20x20
expect 0 '' convert scene_split.toml -o scene_split_mask.vdb --grids mask
printf 'convert = {bounds = [0, 0, 0, 1, 1]}\n[[object]]\nmesh = "good.obj"\n' >five.toml
expect 3 'five.toml:1:.*six numbers' convert five.toml -o no.vdb

expect 0 '' convert 'frames/c.####.obj' -o 'frames/c.####.vdb' --dim 40
"$vox" info --json frames/c.0007.vdb frames/c.0008.vdb frames/c.0010.vdb >info.json
python3 - <<'PY' || fail "a sequence"
import json
grids = [file["grids"][0] for file in json.load(open("info.json"))]
assert [g["voxel_size"] for g in grids] == [[20 / 40] * 3] * 3, grids
voxels = [g["active_voxels"] for g in grids]
assert voxels == sorted(voxels) and voxels[0] < voxels[2], voxels
PY
expect 0 '' convert frames/c.0008.obj frames/c.0010.obj -o 'frames/n_%02d.vdb' --dim 40
cmp -s frames/n_01.vdb frames/c.0008.vdb || fail "a list is not converted as the pattern is"
expect 5 'c.0007.vdb: exists; use --force' convert 'frames/c.####.obj' -o 'frames/c.####.vdb'
expect 2 'needs a place for a number' convert 'frames/c.####.obj' -o out.vdb
expect 3 'd.####.obj: no file has such a name' convert 'd.####.obj' -o 'out.####.vdb'
expect 2 'report needs a single input' convert good.obj good.obj -o 'out#.vdb' --report out.json

# A dry run.
expect 0 '' convert "$scenes/cube.toml" --dry-run --dim 256 --grids density,surface
grep -qE '^in all: about .* MiB of memory for grids, .* MiB in the file$' stdout || fail "dry run: $(cat stdout)"
grep -qE '^grid density: about 2[0-9]{2}000 voxels' stdout || fail "dry run: $(cat stdout)"
expect 4 'the grids need about .* TiB of memory .*use --dim [0-9]+' convert "$scenes/cube.toml" --dry-run --dim 100000 --max-memory 1G
expect 2 'output is required' convert good.obj

# Faults of a mesh are repaired and reported.
expect 0 '' convert winding.obj -o winding.vdb --dim 8
grep -q 'warning: winding: dropped 1 duplicate face' stderr || fail "no word of the repair: $(cat stderr)"
printf '%sf 1 1 2\n' "$triangle" >nothing.obj
expect 3 'nothing.obj: nothing is left after repair' convert nothing.obj -o out.vdb

# Strict: no repair at all. Both commands, the scene, and the command line over the scene.
printf '[convert]\nstrict = true\n[[object]]\nname = "two"\nmesh = "winding.obj"\n' >strict.toml
strict='winding.obj: needs repair, which --strict forbids: dropped face 1, which repeats face 0'
expect 3 "$strict" convert winding.obj -o out.vdb --dim 8 --strict
expect 3 "$strict" subdivide winding.obj -o out.obj --levels 0 --strict
expect 3 'strict.toml: needs repair, .*face 1' convert strict.toml -o out.vdb --dim 8
expect 0 '' convert strict.toml -o strict.vdb --dim 8 --strict=false
expect 0 'active voxels' convert "$scenes/cube.toml" -o strict.vdb --dim 8 --strict --force

# Faces with holes and concave faces are split, which is no fault.
cat >frame.obj <<'OBJ'
v 0 0 0
v 4 0 0
v 4 4 0
v 0 4 0
v 1 1 0
v 1 3 0
v 3 3 0
v 3 1 0
f 1 2 3 4 1 5 6 7 8 5
OBJ
cat >slot.obj <<'OBJ'
v 0 0 0
v 3 0 0
v 3 3 0
v 2 3 0
v 2 1 0
v 1 1 0
v 1 3 0
v 0 3 0
f 1 2 3 4 5 6 7 8
OBJ
says() { grep -q "$1" stderr || fail "not '$1', but: $(cat stderr)"; }
expect 0 '' convert frame.obj -o frame.vdb --dim 16 --strict --faces keep
says 'frame: split 1 face with holes into 4'
expect 0 '' convert slot.obj -o slot.vdb --dim 16 --strict
says 'slot: split 1 concave face into 3'
expect 0 '' subdivide slot.obj -o slot_parts.obj --levels 0
says '8 vertices, 3 faces'
expect 0 '8 vertices, 1 faces' subdivide slot.obj -o slot_parts.obj --levels 0 --force --faces keep
for keep in '--faces keep' '--until levels=0'; do
  expect 0 'active voxels' convert slot.obj -o slot.vdb --dim 16 --force $keep
  ! grep -q split stderr || fail "faces are split in spite of $keep: $(cat stderr)"
done
expect 2 'one of split, keep' convert slot.obj -o out.vdb --faces cut
"$vox" info slot.obj >stdout
grep -q 'split 1 concave face into 3' stdout || fail "info does not tell of concave faces: $(cat stdout)"
"$vox" info slot.obj --json | grep -q '"concave faces"' || fail 'info --json does not tell of concave faces'
"$vox" info slot.obj --faces keep >stdout
! grep -q split stdout || fail "info splits in spite of --faces keep: $(cat stdout)"
printf '[[object]]\nname = "slot"\nmesh = "slot.obj"\nconcave_faces = "keep"\n' >slot.toml
expect 0 'active voxels' convert slot.toml -o slot.vdb --dim 16 --force
! grep -q split stderr || fail "faces are split in spite of the scene: $(cat stderr)"
expect 0 '' convert slot.toml -o slot.vdb --dim 16 --force --faces split
says 'split 1 concave'
expect 0 '' check slot.vdb --mesh slot.toml
printf '[[object]]\nmesh = "slot.obj"\nfaces = "keep"\n' >slot.toml
expect 3 'slot.toml:3:.*concave_faces' convert slot.toml -o slot.vdb --dim 16 --force

# Near vertices, in world units.
cat >near.obj <<'OBJ'
v 0 0 0
v 100 0 0
v 0 100 0
v 100.3 0 0
v 0 100.3 0
v 100 100 0
f 1 2 3
f 4 6 5
OBJ
expect 0 'near.off: 6 vertices, 2 faces' subdivide near.obj -o near.off --levels 0
expect 0 '' subdivide near.obj -o near.off --levels 0 --weld 0.5 --force
grep -q 'warning: near: welded 2 vertices' stderr || fail "no word of welding: $(cat stderr)"
grep -q 'near.off: 4 vertices, 2 faces' stderr || fail "not welded: $(cat stderr)"
printf '[convert]\nweld = 0.5\n[[object]]\nmesh = "near.obj"\n' >near.toml
expect 0 '' convert near.toml -o near.vdb --dim 10
grep -q 'warning: object 1: welded 2 vertices' stderr || fail "the scene's weld: $(cat stderr)"
expect 0 '' convert near.toml -o near.vdb --dim 10 --weld 0 --force
grep -q 'falls apart into 2 separate faces' stderr || fail "--weld 0 over the scene: $(cat stderr)"
expect 2 'weld tolerance' convert near.obj -o out.vdb --weld -1
expect 2 'weld tolerance' subdivide near.obj -o out.obj --levels 0 --weld inf
expect 2 'weld' convert near.obj -o out.vdb --weld far

expect 0 '' info near.obj --weld 0.5
grep -q 'after repair: 4 vertices' stdout || fail "info --weld: $(cat stdout)"
expect 2 'weld tolerance' info near.obj --weld -1

# T-junctions, gaps, debris, openings. The bottom of this box at UTM coordinates is 0.01 too low.
printf 'v %s\n' '500000.25 0 0' '500002.25 0 0' '500002.25 1 0' '500000.25 1 0' '500000.25 0 1' \
  '500002.25 0 1' '500002.25 1 1' '500000.25 1 1' '500001.25 0 0' '500001.25 0 1' \
  '500000.25 0 -0.01' '500002.25 0 -0.01' '500002.25 1 -0.01' '500000.25 1 -0.01' \
  '0 0 0' '0.001 0 0' '0 0.001 0' >box.obj
printf 'f %s\n' '11 14 13 12' '5 6 7 8' '1 9 10 5' '9 2 6 10' '2 3 7 6' '3 4 8 7' '4 1 5 8' '15 16 17' >>box.obj
expect 3 'all 3 components would be dropped' convert box.obj -o box.vdb --drop-components below=100
expect 0 '' info box.obj --drop-components below=2
grep -q 'debris  *dropped 2 components of 2 faces' stdout || fail "info: no debris: $(cat stdout)"
expect 0 '' info box.obj --drop-components size=0.1
grep -q 'debris  *dropped 1 component of 1 face' stdout || fail "info: debris by size: $(cat stdout)"
grep -q '500000.25' stdout || fail "info: digits are missing: $(cat stdout)"
weld=$(sed -n 's/.*gaps .*--weld \([0-9.]*\) closes them$/\1/p' stdout)
[ -n "$weld" ] || fail "info names no tolerance: $(cat stdout)"
expect 0 '' convert box.obj -o box.vdb --drop-components size=0.1 --dim 40 --fill solid --until levels=0
grep -q "no inside.*(500000.25, .*--weld $weld closes them" stderr || fail "convert names no gap: $(cat stderr)"
expect 0 '' convert box.obj -o box.vdb --drop-components size=0.1 --dim 40 --fill solid --until levels=0 --weld "$weld" --force
grep -q 'no inside' stderr && fail "--weld $weld does not close the box: $(cat stderr)"
grep -q 'stitched . T-junction' stderr || fail "no word of stitching: $(cat stderr)"
expect 2 'below=N' convert box.obj -o box.vdb --drop-components tiny
expect 2 'close' convert box.obj -o box.vdb --close 5000
expect 0 '' info nothing.obj
grep -q 'nothing is left' stdout || fail "info of nothing: $(cat stdout)"

# Comparison: 0 the same, 1 different; data on stdout.
"$vox" convert "$scenes/torus.toml" -o torus.vdb --dim 40 --grids density,mask -q
"$vox" convert "$scenes/torus.toml" -o torus41.vdb --dim 41 --grids mask -q
expect 0 '' diff torus.vdb torus.vdb
grep -qE '^mask: same, [0-9]+ active voxels$' stdout || fail "diff of the same: $(cat stdout)"
[ -s stderr ] && fail "diff says something on stderr"
"$vox" diff torus.vdb torus41.vdb >stdout
[ $? -eq 1 ] || fail "diff of different files: exit code"
grep -q '^density: only in A$' stdout || fail "diff: $(cat stdout)"
grep -q '^mask: differs$' stdout || fail "diff: $(cat stdout)"
"$vox" diff torus.vdb torus41.vdb --quiet >stdout
[ $? -eq 1 ] && [ ! -s stdout ] || fail "diff --quiet"
"$vox" diff torus.vdb torus41.vdb --json --grids mask -o difference.vdb >stdout
[ $? -eq 1 ] || fail "diff --json: exit code"
python3 - stdout <<'PY' || fail "diff --json"
import json, sys
diff = json.load(open(sys.argv[1]))
assert diff["same"] is False and [g["name"] for g in diff["grids"]] == ["mask"]
grid = diff["grids"][0]
assert [p["what"] for p in grid["properties"]] == ["transform"]
assert grid["topology"]["only_a"] > 0 and grid["topology"]["distance"] >= 1
assert grid["values"] is None
PY
expect 0 '' info difference.vdb
grep -q 'grid mask_only_a' stdout || fail "diff -o: $(cat stdout)"
expect 5 'difference.vdb: exists' diff torus.vdb torus41.vdb -o difference.vdb
expect 2 'is the input' diff torus.vdb torus41.vdb -o torus.vdb --force
expect 2 'must end in .vdb' diff torus.vdb torus41.vdb -o out.png
expect 2 'tolerance' diff torus.vdb torus.vdb --tolerance -1
expect 3 'nowhere.vdb: no such file' diff torus.vdb nowhere.vdb
expect 3 "neither file has a grid 'fog'" diff torus.vdb torus.vdb --grids fog

expect 2 'tolerance' diff torus.vdb torus.vdb --tolerance-voxels -1
expect 1 '' diff torus.vdb torus41.vdb --grids mask --no-metadata --tolerance-voxels 3
grep -q '^  topology: .* voxels apart, where 3 are allowed$' stdout || fail "diff --tolerance-voxels: $(cat stdout)"
"$vox" convert "$scenes/torus.toml" -o again.vdb --like torus.vdb --grids mask --until diameter=0.3 -q
expect 1 '' diff torus.vdb again.vdb --grids mask --no-metadata
expect 0 '' diff torus.vdb again.vdb --grids mask --no-metadata --tolerance-voxels 1
grep -q '^mask: same, ' stdout || fail "diff --tolerance-voxels: $(cat stdout)"

# Folders, by the names of files; and reports for CI.
mkdir -p one/sub two/sub
cp torus.vdb one/sub/torus.vdb
cp torus.vdb two/sub/torus.vdb
expect 0 '' diff one two
printf 'sub/torus.vdb: same\n' | diff - <(head -1 stdout) || fail "diff of folders: $(cat stdout)"
cp torus.vdb "one/<script>&.vdb"
cp torus41.vdb "two/<script>&.vdb"
cp torus.vdb two/more.vdb
cp torus.vdb $'two/tab\x01\xff.vdb'
expect 1 '' diff one two --junit folders.xml
grep -q '^<script>&.vdb: differs$' stdout || fail "diff of folders: $(cat stdout)"
grep -q '^  mask: differs$' stdout || fail "diff of folders: $(cat stdout)"
grep -q '^more.vdb: only in B$' stdout || fail "diff of folders: $(cat stdout)"
grep -q '^4 files: 1 same, 1 different, 2 only in B$' stdout || fail "diff of folders: $(cat stdout)"
expect 5 'folders.xml: exists' diff one two --junit folders.xml
expect 1 '' diff one two --junit folders.xml --force --json
python3 - stdout folders.xml <<'PY' || fail "diff of folders: --json and --junit"
import json, sys
import xml.etree.ElementTree as tree
diff = json.load(open(sys.argv[1]))
assert diff["same"] is False and len(diff["files"]) == 4
by_name = {file["name"]: file for file in diff["files"]}
assert by_name["sub/torus.vdb"]["same"] and not by_name["more.vdb"]["in_a"]
assert [g["name"] for g in by_name["<script>&.vdb"]["grids"]] == ["density", "mask"]
suite = tree.parse(sys.argv[2]).getroot().find("testsuite")
assert (suite.get("tests"), suite.get("failures"), suite.get("errors")) == ("4", "3", "0")
cases = {case.get("name"): case for case in suite}
assert set(cases) == {"<script>&.vdb", "more.vdb", "sub/torus.vdb", "tab\ufffd\ufffd.vdb"}, cases
failure = cases["<script>&.vdb"].find("failure")
assert failure.get("message") == "<script>&.vdb: differs" and "mask: differs" in failure.text
assert cases["sub/torus.vdb"].find("failure") is None
PY
echo nothing >one/bad.vdb
cp one/bad.vdb two/bad.vdb
expect 3 '1 of 5 files could not be compared; the first: one/bad.vdb: is not an OpenVDB file' diff one two --junit errors.xml
grep -q '^sub/torus.vdb: same$' stdout || fail "diff of folders: an error stops it: $(cat stdout)"
grep -q 'errors="1"' errors.xml || fail "--junit: $(cat errors.xml)"
expect 1 '' diff torus.vdb torus41.vdb --junit grids.xml
grep -q '<testcase classname="vox diff torus.vdb torus41.vdb" name="mask">' grids.xml || fail "--junit: $(cat grids.xml)"
expect 3 'is not an OpenVDB file' diff torus.vdb one/bad.vdb --junit error.xml
expect 2 'is no folder, but one is' diff one torus.vdb
expect 2 'two files, not folders' diff one two -o out.vdb
expect 2 'must end in .xml' diff torus.vdb torus41.vdb --junit out.txt
expect 3 "no file that both folders have has a grid 'fog'" diff one/sub two/sub --grids fog
if command -v xmllint >/dev/null; then
  for report in folders errors grids error; do
    xmllint --noout --schema "$here/junit.xsd" $report.xml 2>stderr || fail "$report.xml: $(cat stderr)"
  done
fi

# Merging: other files, and the parts of a conversion.
"$vox" convert "$scenes/torus.toml" -o fog.vdb --dim 40 -q
expect 0 'two.vdb: 2 grids with [0-9]+ active voxels from 2 files$' merge torus.vdb fog.vdb -o two.vdb
expect 0 '' diff torus.vdb two.vdb --no-metadata
expect 5 'two.vdb: exists' merge torus.vdb -o two.vdb
expect 0 '' merge torus.vdb fog.vdb -o two.vdb --force --quiet
[ -s stderr ] && fail "merge --quiet is not quiet"
"$vox" merge torus.vdb fog.vdb -o - 2>/dev/null | cmp -s - two.vdb || fail "merge: stdout differs"
expect 3 'torus41.vdb: the grid mask is also in torus.vdb and has another transform' merge torus.vdb torus41.vdb -o out.vdb
expect 3 'nowhere.vdb: no such file' merge torus.vdb nowhere.vdb -o out.vdb
expect 2 'is the input torus.vdb' merge torus.vdb fog.vdb -o torus.vdb --force
expect 2 'must end in .vdb' merge torus.vdb -o out.png
expect 2 'output' merge torus.vdb
expect 2 'FILE' merge -o out.vdb
"$vox" convert "$scenes/torus.toml" -o whole.vdb --dim 300 --grids density,mask -q
for part in 1 2 3; do
  "$vox" convert "$scenes/torus.toml" -o "p$part.vdb" --dim 300 --grids density,mask --part $part/3 -q
done
"$vox" convert "$scenes/torus.toml" -o stale.vdb --dim 301 --grids density,mask --part 2/3 -q
expect 0 'merged.vdb: 2 grids' merge p2.vdb p1.vdb p3.vdb -o merged.vdb
cmp -s merged.vdb whole.vdb || fail "merge: not the file of one run"
expect 3 'p1.vdb: is one of 3 parts, of which parts 2-3 are missing' merge p1.vdb -o out.vdb
expect 3 'p2.vdb: is part 2 of 3, which is in p2.vdb, too' merge p2.vdb p1.vdb p2.vdb p3.vdb -o out.vdb
expect 3 'stale.vdb: is of another conversion than p1.vdb: it has other options' merge p1.vdb stale.vdb p3.vdb -o out.vdb
expect 3 'whole.vdb: is not a part' merge p1.vdb p2.vdb p3.vdb whole.vdb -o out.vdb
head -c 5000 p2.vdb >cut.vdb
expect 3 'cut.vdb: is damaged' merge p1.vdb cut.vdb p3.vdb -o out.vdb
expect 2 'leave it out, or --part' convert "$scenes/torus.toml" --part 1/3 --verify -o out.vdb
"$vox" merge p1.vdb p3.vdb -o partial.vdb --partial 2>stderr || fail "merge --partial: $(cat stderr)"
grep -q 'warning: without part 2 of 3' stderr || fail "merge --partial: $(cat stderr)"
expect 3 'partial.vdb: lacks part 2 of 3' check partial.vdb --mesh "$scenes/torus.toml"
expect 3 'partial.vdb: lacks parts' merge partial.vdb p2.vdb -o out.vdb
expect 2 '--part must be I/N' convert "$scenes/torus.toml" --part 3 -o out.vdb
expect 2 '--part must be I/N, with I from 1 to N' convert "$scenes/torus.toml" --part 4/3 -o out.vdb
expect 2 '--split' convert "$scenes/torus.toml" --part 1/3 --split part -o out.vdb
expect 0 '' convert "$scenes/torus.toml" --dim 300 --part 2/3 --dry-run
[ "$(grep -c '^part [123] of 3: .* % of the surface, in ' stdout)" = 3 ] || fail "dry run of a part: $(cat stdout)"
expect 3 'holds a part of its grids' check p1.vdb --mesh "$scenes/torus.toml"
expect 4 'or convert in [0-9]* parts' convert "$scenes/torus.toml" --dim 20000 --grids normal --max-memory 1G -o out.vdb

# Checks: 0 no faults, 1 some. The options are those of the file.
expect 0 '' check torus.vdb
grep -qE '^mask: [0-9]+ active voxels in 1 component, around 1 enclosed space' stdout || fail "check: $(cat stdout)"
grep -q '^no faults$' stdout || fail "check: $(cat stdout)"
expect 0 '' check torus.vdb --mesh "$scenes/torus.toml"
grep -q '^torus: no tunnels$' stdout || fail "check --mesh: $(cat stdout)"
"$vox" check torus41.vdb >stdout
[ $? -eq 1 ] && grep -q '^fault no-density: ' stdout || fail "check of a mask alone: $(cat stdout)"
expect 0 '' check torus41.vdb --ignore no-density
# The surface through the vertices is another one, as is a larger torus.
"$vox" check torus.vdb --mesh "$scenes/torus.toml" --interpolate both >stdout
[ $? -eq 1 ] && grep -q '^fault tunnel: mask: torus: ' stdout || fail "check of another surface: $(cat stdout)"
"$vox" convert "$scenes/torus.toml" -o through.vdb --dim 40 --interpolate both -q --verify
expect 0 '' check through.vdb --mesh "$scenes/torus.toml"
"$vox" convert "$scenes/toy_jack.toml" -o levels.vdb --dim 40 --until levels=2 --separating 26 -q --verify
expect 0 '' check levels.vdb --mesh "$scenes/toy_jack.toml"
"$vox" check levels.vdb --mesh "$scenes/toy_jack.toml" --until levels=0 --json >stdout
[ $? -eq 1 ] || fail "check of other polygons"
python3 - stdout <<'PY' || fail "check --json"
import json, sys
check = json.load(open(sys.argv[1]))
assert check["ok"] is False and check["objects"][0]["tunnels"] > 0
assert [f["fault"] for f in check["faults"]] == ["tunnel"]
assert check["components"]["count"] == 1
PY
expect 0 '' convert "$scenes/sheet.toml" -o adaptive.vdb --dim 40 --until angle=5,diameter=4 --grids mask,density --verify --quiet
expect 0 '' check adaptive.vdb --mesh "$scenes/sheet.toml"
expect 0 '' convert "$scenes/toy_jack.toml" -o turned.vdb --dim 40 --grids density,mask,surface,normal --fill solid --target houdini --verify --quiet
expect 0 '' check turned.vdb --mesh "$scenes/toy_jack.toml"
expect 2 "unknown fault 'holes'" check torus.vdb --ignore holes
expect 3 "has no grid 'fog'" check torus.vdb --grid fog
expect 3 'nowhere.vdb: no such file' check nowhere.vdb
expect 4 'needs about' check torus.vdb --mesh "$scenes/torus.toml" --max-memory 1M
# Limits of the command line mean polygons, even if the scene names vertices.
printf '[convert]\ndim = 8\nvoxelize = "vertex"\n[[object]]\n%s\n' "$cube" >vertex.toml
expect 0 '' convert vertex.toml -o vertex.vdb --quiet
expect 0 '' check vertex.vdb --mesh vertex.toml --until levels=1
expect 3 'error: nowhere.txt: no such file' check vertex.vdb --mesh vertex.toml --interpolate-vertices nowhere.txt
# Damaged metadata in a file whose UUID does not show it.
damage() {
  python3 - "$@" <<'PY'
import sys
file, old, new = sys.argv[1:]
content = bytearray(open(file, "rb").read().replace(old.encode(), new.encode()))
content[21 + 14] = ord("4")  # the version of the UUID: no hash of ours
open(file, "wb").write(content)
PY
}
expect 0 '' convert "$scenes/torus.toml" -o damaged.vdb --dim 20 --weld 1e-9
damage damaged.vdb weld=1.0 weld=abc
expect 3 "damaged.vdb: vox_options has 'weld=abc" check damaged.vdb --mesh "$scenes/torus.toml"
expect 0 '' convert "$scenes/torus.toml" -o impossible.vdb --dim 20 --band 2.5
damage impossible.vdb band=2.5 band=0.5
expect 3 'impossible.vdb: vox_options is impossible: the band must' check impossible.vdb --mesh "$scenes/torus.toml"
expect 0 'active voxels' convert "$scenes/gallery.toml" -o verified.vdb --dim 100 --verify
for until in angle=20 diameter=6 flatness=0.3 angle=8,diameter=20 levels=3,angle=10; do
  expect 0 'active voxels' convert "$scenes/toy_jack.toml" -o verified.vdb --dim 60 --until $until --verify --force
done
# A plate thinner than a voxel has no inside: convert and check say so.
printf 'v %s\n' '0 0 .501' '1 0 .501' '1 1 .501' '0 1 .501' '0 0 .504' '1 0 .504' '1 1 .504' '0 1 .504' >plate.obj
printf 'f %s\n' '4 3 2 1' '5 6 7 8' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8' >>plate.obj
"$vox" convert plate.obj -o plate.vdb --dim 48 --grids density,surface --until levels=0 2>stderr || fail "plate: $(cat stderr)"
grep -q 'warning: .*thinner than a voxel' stderr || fail "convert of a thin plate: $(cat stderr)"
expect 0 '' check plate.vdb
grep -q '^warning no-inside: surface: ' stdout && grep -q '^no faults$' stdout || fail "check of a thin plate: $(cat stdout)"
expect 0 '' check plate.vdb --ignore no-inside
grep -q 'no-inside' stdout && fail "check --ignore of a warning: $(cat stdout)"

# Odd files are read, strict refuses them with the line.
sed 's/$/#x/' "$scenes/cube.obj" | sed 's/^#x$//' >hash.obj
expect 0 'active voxels' convert hash.obj -o hash.vdb --dim 8
expect 3 'hash.obj:[0-9]+: comment without a blank before its #, which --strict forbids' convert hash.obj -o out.vdb --dim 8 --strict
{ cat "$scenes/cube.obj"; echo 'f 1 2'; } >digons.obj
"$vox" convert digons.obj -o digons.vdb --dim 8 2>stderr || fail "digons: $(cat stderr)"
grep -q 'warning: digons: reading its file dropped 1 face of fewer than 3 corners (on line' stderr || fail "digons: $(cat stderr)"
expect 3 'digons.obj:[0-9]+: face of fewer than 3 corners' subdivide digons.obj -o out.obj --levels 1 --strict
expect 0 '' info digons.obj
grep -q 'reading  *dropped 1 face' stdout || fail "info of digons: $(cat stdout)"

# Colours: kept by subdivide where the format has them; one warning where there are none.
sed 's/^v .*/& 1 0 0/' "$scenes/cube.obj" >red.obj
for format in obj off ply; do
  expect 0 'vertices' subdivide red.obj -o "red1.$format" --levels 1 --force
  expect 0 'vertices' subdivide "red1.$format" -o red0.obj --levels 0 --force
  [ "$(grep -c '^v .* 1 0 0$' red0.obj)" -eq 24 ] || fail "subdivide loses colours in $format"
done
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1 255 0 0\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >faces.off
"$vox" subdivide faces.off -o faces.obj --levels 0 2>stderr || fail "faces.off: $(cat stderr)"
grep -q 'warning: OBJ has no colours of faces' stderr || fail "no word of colours of faces: $(cat stderr)"
expect 0 'vertices' subdivide faces.off -o faces.ply --levels 0
"$vox" convert "$scenes/cube.obj" -o grey.vdb --dim 8 --grids color 2>stderr
[ "$(grep -c 'warning: the input has no colours' stderr)" -eq 1 ] || fail "no word of missing colours: $(cat stderr)"

expect 0 'red.glb: [0-9]+ vertices, [0-9]+ triangles' subdivide red.obj -o red.glb --levels 1
expect 0 '' subdivide red.glb -o again.obj --levels 0 --force --weld 1e-6
[ "$(grep -c '^v .* 1 0 0$' again.obj)" -ge 24 ] || fail "subdivide loses colours in glb"
expect 0 'marble.glb' subdivide "$scenes/marble_jack.toml" -o marble.glb --levels 2
expect 0 'again.glb' subdivide "$scenes/marble_jack.toml" -o again.glb --levels 2 --threads 1
cmp -s marble.glb again.glb || fail "subdivide: .glb of 1 thread differs"
expect 5 'marble.glb: exists' subdivide "$scenes/marble_jack.toml" -o marble.glb --levels 2

# Scale: of the command line, else of the scene; recorded, so that check makes the same surface.
expect 0 'active voxels of size 0.25' convert "$scenes/cube.obj" -o scaled.vdb --dim 8 --scale 1
expect 0 'active voxels of size 0.00025' convert "$scenes/cube.obj" -o scaled.vdb --dim 8 --scale 0.001 --force --grids mask,density
expect 0 '' check scaled.vdb --mesh "$scenes/cube.obj"
printf 'scale = 100\n[convert]\ndim = 8\n[[object]]\n%s\n' "$cube" >scale.toml
expect 0 'active voxels of size 25' convert scale.toml -o scaled.vdb --force
expect 0 'active voxels of size 0.5' convert scale.toml -o scaled.vdb --force --scale 2
expect 2 '--scale must be a positive number' convert "$scenes/cube.obj" -o out.vdb --scale 0
expect 4 'make the model 1000 times as large with --scale' convert "$scenes/cube.obj" -o out.vdb --scale 1e-6 --dim 100
expect 2 'objects of a scene' convert "$scenes/cube.obj" red.obj -o out.vdb
expect 3 'close it, or use --open-mesh surface or unsigned' convert "$scenes/sheet.toml" -o out.vdb --fill solid --open-mesh error

# What needs care at the edges.
expect 2 'out.obj: .*must end in .vdb' convert good.obj -o out.obj
cp "$scenes/cube.obj" cube2.obj
ln -s cube2.obj same.obj
expect 2 'is the input' subdivide cube2.obj -o same.obj --levels 1 --force
expect 2 'unknown option --ouput; did you mean --output' convert good.obj --ouput x.vdb
expect 2 'positive' convert good.obj -o out.vdb --voxel-size inf
expect 4 'OpenVDB.s range' convert good.obj -o out.vdb --voxel-size 1e-6
printf 'v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n' >point.obj
expect 3 'coincide' convert point.obj -o out.vdb
expect 3 'new.line.toml: no such file' convert $'new\nline.toml' -o out.vdb
printf '[[object]]\nname = "a\\nvox: error: fake"\nmesh = "%s/cube.obj"\n' "$scenes" >name.toml
expect 0 '' convert name.toml -o name.vdb --dim 8 --verbose
grep -q '^vox: error' stderr && fail "an object's name forges a message"
cp good.obj $'caf\xe9.obj'
expect 0 '' info --json $'caf\xe9.obj'
"$vox" info good.obj >/dev/full 2>stderr
[ $? -eq 5 ] || fail "info on a full stdout"
"$vox" --help >/dev/full 2>stderr
[ $? -eq 5 ] || fail "help on a full stdout"
(
  ulimit -f 20
  "$vox" convert "$scenes/toy_jack.toml" -o limited.vdb 2>stderr
  [ $? -eq 5 ]
) || fail "a file size limit: $(cat stderr)"
[ ! -e limited.vdb ] || fail "a file size limit leaves a file"

# The partition into submeshes does not change the voxels.
for submeshes in '--localize before' '--localize during' '--localize off' '--submesh-faces 1' '--submesh-faces 7'; do
  # shellcheck disable=SC2086
  expect 0 'active voxels' convert "$scenes/toy_jack.toml" -o cut.vdb --dim 64 --grids density,mask --force $submeshes
  cmp -s cut.vdb first.vdb || fail "$submeshes changes the file"
done
expect 2 'one of before, during, off' convert good.obj -o out.vdb --localize after
expect 2 'submesh-faces' convert good.obj -o out.vdb --submesh-faces 0
expect 2 'submesh-faces' convert good.obj -o out.vdb --submesh-faces 2147483649
expect 4 'of the whole mesh needs about .*--localize during' convert "$scenes/cube.toml" -o out.vdb --dim 3000 --grids mask --localize off --max-memory 1G

# A report.
expect 0 'active voxels' convert "$scenes/gallery.toml" -o gallery.vdb --dim 200 --grids density,mask --report report.json --threads 2
"$vox" info --json gallery.vdb >info.json
python3 - report.json info.json <<'PY' || fail "the report"
import json, sys
report, info = (json.load(open(name)) for name in sys.argv[1:])
grids = {grid["name"]: grid for grid in info[0]["grids"]}
assert report["grids"] == list(grids) == list(report["memory"]["grid_bytes"]) == ["density", "mask"]
for grid in grids.values():
    assert grid["active_voxels"] == report["active_voxels"]
    assert grid["voxel_size"] == [report["voxel_size"]] * 3
    assert grid["metadata"]["vox_active_voxels"] == str(report["active_voxels"])
    assert grid["metadata"]["vox_levels"] == str(max(o["levels"] for o in report["objects"]))
    assert grid["metadata"]["vox_input_hash"] == report["input_hash"]
assert report["memory"]["grid_bytes"]["mask"] == grids["mask"]["memory_bytes"]
assert report["memory"]["peak_resident_bytes"] > 1e7
assert sorted(report["seconds"]) == ["grids", "prepare", "read", "surface", "write"]
assert all(0 <= s < 600 for s in report["seconds"].values())
assert [o["name"] for o in report["objects"]] == ["jack", "torus", "polyhedron", "cube"]
assert [o["input_faces"] for o in report["objects"]] == [266, 128, 20, 6]
assert sum(o["active_voxels"] for o in report["objects"]) == report["active_voxels"]
for o in report["objects"]:
    assert o["vertices"] == sum(o["vertices_of_level"].values()) > o["active_voxels"] > 0
    assert max(map(int, o["vertices_of_level"])) == o["levels"]
    assert abs(o["vertices_per_voxel"] * o["active_voxels"] / o["vertices"] - 1) < 1e-9
assert report["objects"][3]["submeshes"] >= 1  # the faces of the cube are large
assert report["options"]["dim"] == 200 and report["options"]["localize"] == "during"
assert report["options"]["submesh_faces"] == 256 and report["options"]["grids"] == ["density", "mask"]
assert report["threads"] == report["options"]["threads"] == 2 and report["options"]["boundary"] is None
assert report["warnings"] == [] and report["output"] == "gallery.vdb" and len(report["input"]) == 5
PY
expect 0 '' convert winding.obj -o winding.vdb --dim 8 --force --report winding.json
grep -q 'dropped 1 duplicate face' winding.json || fail "the report leaves out a warning"
expect 5 'report.json: exists; use --force' convert good.obj -o out.vdb --dim 8 --report report.json
expect 2 'report.txt: .*must end in .json' convert good.obj -o out.vdb --dim 8 --report report.txt
expect 2 'must end in .json' convert good.obj -o out.vdb --dim 8 --report -
expect 5 'nowhere' convert good.obj -o out.vdb --dim 8 --report nowhere/report.json
ln -s linked.vdb linked.json
expect 2 'is the output, too' convert good.obj -o linked.vdb --dim 8 --report linked.json
cp good.obj good.json
ln -s good.json alias.obj
expect 2 'is the input' convert alias.obj -o out.vdb --dim 8 --report good.json --force
expect 0 '' convert "$scenes/gallery.toml" -o gallery.vdb --dim 100 --force --verbose
grep -qE 'cube: 6 faces, 1 submesh, [0-9]+ vertices \(by level .*\), [0-9]+ active voxels, .* per voxel' stderr || fail "verbose: $(cat stderr)"
grep -q 'seconds on .* read .* prepare .* surface .* grids .* write' stderr || fail "verbose: no times"
grep -q 'memory: peak .*, density ' stderr || fail "verbose: no memory"

# The progress bar: only on a terminal and without --quiet; one line that never goes back and is
# erased. Signals: the first one cancels in any stage and leaves the target as it was.
python3 - "$vox" "$scenes" <<'PY' || fail "the progress bar"
import os, pty, re, signal, sys
vox, scenes = sys.argv[1:]

def run(arguments, stage=None, number=None, kind="xterm"):
    """Exit code and output on a terminal; a signal once a stage shows."""
    child, terminal = pty.fork()
    if child == 0:
        os.environ["TERM"] = kind
        os.execv(vox, [vox] + arguments)
    output = b""
    while True:
        try:
            got = os.read(terminal, 1 << 16)
        except OSError:
            break
        if not got:
            break
        output += got
        if stage and re.search(rb"% " + stage, output):
            os.kill(child, number)
            stage = None
    os.close(terminal)
    assert stage is None, output
    return os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), output.decode()

long = ["convert", scenes + "/cube.toml", "-o", "bar.vdb", "--dim", "2500", "--force"]
code, output = run(long)
assert code == 0, output
bars = re.findall(r"\r\[(#*)\.*\] +(\d+)% (\w+)\x1b\[K", output)
percents = [int(percent) for _, percent, _ in bars]
assert len(bars) >= 3 and percents == sorted(percents) and percents[-1] == 100, output
assert all(len(full) == int(percent) * 40 // 100 or 0 < int(percent) < 100 for full, percent, _ in bars), output
assert {stage for _, _, stage in bars} <= {"prepare", "surface", "grids", "write"}, output
assert re.search(r"100% write\x1b\[K\r\x1b\[Kvox: bar.vdb: \d+ active voxels[^\r]*\r\n$", output), output
assert run(long + ["--quiet"]) == (0, "")
assert "%" not in run(long, kind="dumb")[1]

with open("bar.vdb", "w") as target:
    target.write("old")
for number in signal.SIGINT, signal.SIGTERM, signal.SIGHUP:
    code, output = run(long, b"write", number)
    assert code == 130 and output.endswith("\r\x1b[Kvox: interrupted\r\n"), (code, output)
    assert open("bar.vdb").read() == "old"
code, output = run(["subdivide", scenes + "/torus.toml", "-o", "bar.obj", "--levels", "8"], b"write", signal.SIGINT)
assert code == 130 and not os.path.exists("bar.obj"), (code, output)
code, output = run(["render", scenes + "/cube.toml", "-o", "bar.png", "--size", "4000x4000", "--samples", "8"], b"render", signal.SIGINT)
assert code == 130 and not os.path.exists("bar.png"), (code, output)
assert not [name for name in os.listdir() if name.endswith(".part")]
PY

# With --progress, lines for programs: each percent once, none goes back; also with --quiet.
"$vox" convert "$scenes/cube.toml" -o lines.vdb --dim 1000 --progress --quiet 2>stderr || fail "--progress"
percents=$(sed -nE 's/^vox: ([0-9]+)% (prepare|surface|grids|write)$/\1/p' stderr)
[ "$(wc -l <stderr)" -eq "$(wc -w <<<"$percents")" ] || fail "--progress: other lines: $(cat stderr)"
[ "$(sort -nu <<<"$percents")" = "$percents" ] || fail "--progress: $percents"
[ "$(tail -n 1 <<<"$percents")" -eq 100 ] || fail "--progress does not end at 100%"

# A signal leaves the target as it was. (Background jobs of a script ignore SIGINT.)
echo old >kept.vdb
"$vox" convert "$scenes/toy_jack.toml" -o kept.vdb --force --dim 3000 2>stderr &
for _ in $(seq 200); do  # until the program catches SIGTERM, the 15th bit
  caught=$(sed -n 's/^SigCgt:[[:space:]]*//p' /proc/$!/status)
  ((16#${caught:-0} & 0x4000)) && break
  sleep 0.05
done
kill -TERM $!
wait $!
[ $? -eq 130 ] || fail "interrupt: exit code"
[ "$(cat kept.vdb)" = old ] || fail "interrupt: the target has changed"
[ -z "$(find . -name '.*.part')" ] || fail "partial file left"

[ $failures -eq 0 ] && echo "all as documented"
exit $((failures > 0))
