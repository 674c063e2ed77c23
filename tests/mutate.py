#!/usr/bin/env python3
"""Converts randomly damaged copies of the OBJ files of a folder: each becomes voxels or is refused.

Usage: mutate.py VOX FOLDER COUNT [FIRST_SEED]. The same seed is the same mesh and the same options.
Best with a VOX that has sanitizers. What fails is kept in the working folder as mutant-SEED.obj.
"""
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

MOST_FACES = 2000  # of a mutant: pieces of larger meshes, so that thousands of them can be tried
SECONDS = 120
REFUSALS = {3: "refused as bad input", 4: "refused as too large"}

OPTIONS = [
    "",
    "--interpolate both",
    "--boundary free",
    "--grids density,mask,surface --fill solid",
    "--grids density --fill solid --edge soft",
    "--grids normal,color --texture marble",
    "--grids surface --open-mesh unsigned",
    "--until levels=1",
    "--until angle=15,diameter=4 --separating 26",
    "--separating 26",
    "--until flatness=0.2 --grids mask,normal",
    "--localize off",
    "--localize before --submesh-faces 16",
    "--weld 0.01",
    "--faces keep --grids surface",
    "--strict",
    "--verify",
]


def piece(points, faces, rng):
    """Up to MOST_FACES faces that follow each other, with all points: most of them unused."""
    if len(faces) <= MOST_FACES:
        return points, faces
    start = rng.randrange(len(faces) - MOST_FACES)
    faces = faces[start : start + MOST_FACES]
    used = sorted({v for face in faces for v in face})
    number = {v: i for i, v in enumerate(used)}
    return [points[v] for v in used], [[number[v] for v in face] for face in faces]


def damage(points, faces, rng):
    """One change of the kinds that modellers, exporters and disks make."""
    some = lambda: rng.randrange(len(faces))
    face = faces[some()]
    corner = rng.randrange(len(face))
    kind = rng.randrange(14)
    if kind == 0 and len(faces) > 1:
        del faces[some()]
    elif kind == 1:
        faces.append(list(face))
    elif kind == 2:
        face.reverse()
    elif kind == 3:
        face[corner] = rng.randrange(len(points))
    elif kind == 4:
        face.insert(corner, face[corner - 1])
    elif kind == 5 and len(face) > 3:
        del face[corner]
    elif kind == 6:
        points[face[corner]] = points[rng.randrange(len(points))]
    elif kind == 7:
        points[face[corner]] = [x + rng.gauss(0, 0.3) for x in points[face[corner]]]
    elif kind == 8:
        points[face[corner]] = [x * rng.choice([-1, 0, 1e-9, 50]) for x in points[face[corner]]]
    elif kind == 9:
        hole = some()
        del faces[hole : min(hole + rng.randrange(1, 50), hole + len(faces) - 1)]
    elif kind == 10:
        face[:] = rng.sample(range(len(points)), min(len(points), rng.randrange(3, 40)))
    elif kind == 11:
        for v in range(len(points)):
            points[v] = [x + rng.gauss(0, 0.01) for x in points[v]]
    elif kind == 12:  # every face a sheet of its own
        points[:], faces[:] = (
            [points[v] for f in faces for v in f],
            numbered_apart(faces),
        )
    else:
        axis = rng.randrange(3)
        for v in range(len(points)):
            points[v] = [x * (rng.choice([0, 1e-6]) if i == axis else 1) for i, x in enumerate(points[v])]


def numbered_apart(faces):
    apart, count = [], 0
    for face in faces:
        apart.append(list(range(count, count + len(face))))
        count += len(face)
    return apart


def damage_text(text, rng):
    """What only the reader meets: cut files, wrong numbers, wrong bytes."""
    at = rng.randrange(len(text))
    kind = rng.randrange(4)
    if kind == 0:
        return text[:at]
    if kind == 1:
        return text[:at] + rng.choice(["nan", "1e999", "-7", "0", "99999999999", "f 1 1 1\n", "v\n"]) + text[at:]
    if kind == 2:
        return text[:at] + chr(rng.randrange(1, 127)) + text[at + 1 :]
    return text[:at] + text[at + rng.randrange(1, 200) :]


def read_obj(file):
    points, faces = [], []
    for line in file.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            points.append([float(x) for x in words[1:4]])
        elif words[:1] == ["f"]:
            faces.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return points, faces


def mutant(meshes, rng):
    points, faces = rng.choice(meshes)
    points, faces = piece(list(points), [list(face) for face in faces], rng)
    for _ in range(rng.randrange(1, 12)):
        damage(points, faces, rng)
    text = "".join("v %.17g %.17g %.17g\n" % tuple(p) for p in points)
    text += "".join("f " + " ".join(str(v + 1) for v in face) + "\n" for face in faces)
    return damage_text(text, rng) if rng.random() < 0.15 else text


def outcome(vox, mesh, target, options):
    """What became of it, or what is wrong, after 'FAILED: '."""
    command = [vox, "convert", mesh, "-o", target, "--max-memory", "512M", *options]
    try:
        run = subprocess.run(command, capture_output=True, timeout=SECONDS, text=True, errors="replace")
    except subprocess.TimeoutExpired:
        return "FAILED: no end after %d s" % SECONDS
    first = (run.stderr.splitlines() or [""])[0]
    if "Sanitizer" in run.stderr or "runtime error" in run.stderr:
        return "FAILED: sanitizer: " + run.stderr[:2000]
    if os.path.exists(target) != (run.returncode == 0):
        return "FAILED: exit code %d and the file do not agree: %s" % (run.returncode, first)
    if run.returncode == 0:
        os.remove(target)
        return "converted"
    if run.returncode in REFUSALS and first.startswith("vox: error: "):
        return REFUSALS[run.returncode]
    return "FAILED: exit code %d: %s" % (run.returncode, run.stderr[:500])


def told(counts):
    return ", ".join("%d %s" % (n, what) for what, n in counts.most_common())


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    vox, folder, count = sys.argv[1:4]
    first = int(sys.argv[4]) if len(sys.argv) > 4 else 0
    meshes = [read_obj(file) for file in sorted(Path(folder).glob("*.obj"))]
    if not meshes:
        sys.exit(folder + ": no .obj files")
    counts = Counter()
    failures = 0
    with tempfile.TemporaryDirectory() as temporary:
        mesh, target = temporary + "/mutant.obj", temporary + "/mutant.vdb"
        for seed in range(first, first + int(count)):
            rng = random.Random(seed)
            Path(mesh).write_text(mutant(meshes, rng))
            options = ["--dim", str(rng.choice([8, 16, 24, 40])), *rng.choice(OPTIONS).split()]
            what = outcome(vox, mesh, target, options)
            counts[what.split(":")[0]] += 1
            if what.startswith("FAILED"):
                failures += 1
                shutil.copy(mesh, "mutant-%d.obj" % seed)
                print("seed %d, %s: %s" % (seed, " ".join(options), what), flush=True)
            if (seed - first) % 100 == 99:
                print("so far: " + told(counts), file=sys.stderr, flush=True)
    print(told(counts))
    sys.exit(failures > 0)


main()
