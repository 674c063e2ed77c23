"""Voxel models of vox in Blender, without the add-on installed.

    blender --python vox_import.py                                    the add-on, for one session
    blender --python vox_import.py -- model.vdb                       look at a model
    blender --background --python vox_import.py -- model.vdb out.png  a picture of it
"""

import importlib.util
import os
import sys
import threading
import time

import bpy

# Of out.png. Blender's own 1920 x 1080 pixels of 4096 samples would take hours.
PICTURE_SIZE = 640, 480
PICTURE_SAMPLES = 32
PICTURE_SECONDS = 35  # of samples; a slower machine takes fewer


def load_addon():
    """The add-on, from its folder beside this file, under the name it has when it is installed."""
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "vox")
    spec = importlib.util.spec_from_file_location(
        "vox_addon", os.path.join(folder, "__init__.py"), submodule_search_locations=[folder]
    )
    addon = importlib.util.module_from_spec(spec)
    sys.modules["vox_addon"] = addon
    spec.loader.exec_module(addon)
    return addon


def render_picture(path):
    """Writes a picture of the scene. Tells every few seconds how long it takes."""
    scene = bpy.context.scene
    scene.cycles.samples = PICTURE_SAMPLES
    scene.cycles.time_limit = PICTURE_SECONDS
    scene.cycles.use_denoising = False  # Debian's Blender has no denoiser
    scene.render.filepath = path
    start = time.monotonic()
    done = threading.Event()

    def tell():
        while not done.wait(5):
            print(f"rendering: {time.monotonic() - start:.0f} s of about {PICTURE_SECONDS}", flush=True)

    teller = threading.Thread(target=tell)
    teller.start()
    try:
        bpy.ops.render.render(write_still=True)
    finally:
        done.set()
        teller.join()


def check_picture(path):
    """Refuses a file that cannot be written, before the work starts."""
    if not path.lower().endswith(".png"):
        raise RuntimeError(f"{path}: the name of the picture must end in .png")
    if not os.access(os.path.dirname(os.path.abspath(path)), os.W_OK):
        raise RuntimeError(f"{path}: the folder does not exist or cannot be written to")


def main(arguments):
    if len(arguments) > 1:
        check_picture(arguments[1])
    addon = load_addon()
    addon.register()
    if not arguments:
        return
    addon.framing.make_way()
    volume = addon.import_volume.import_vdb(arguments[0])
    scene = bpy.context.scene
    if len(arguments) > 1:
        scene.render.resolution_x, scene.render.resolution_y = PICTURE_SIZE
    addon.framing.frame(volume)
    if len(arguments) > 1:
        render_picture(arguments[1])


if __name__ == "__main__":
    try:
        main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else [])
    except RuntimeError as wrong:
        print("vox_import: error:", str(wrong).removeprefix("Error: ").strip(), file=sys.stderr)
        if bpy.app.background:
            sys.exit(1)
