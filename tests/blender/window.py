"""In a window, Convert runs beside the user's work: with progress, a cancel, and a result."""

import os
import time
import traceback

import bpy
from meshes import empty_scene, suzanne
from vox_addon.run import Run


def story():
    """Yields whenever Blender is to go on for a while."""
    yield
    empty_scene()
    thing = suzanne()
    convert = bpy.ops.object.vox_convert

    thing.vox.dim = 3000
    assert convert("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    assert not convert.poll()  # one at a time
    while not Run.now.fraction:
        yield
    assert bpy.context.window_manager.vox_progress > 0
    bpy.ops.object.vox_cancel()
    while Run.now:
        yield
    assert os.listdir() == [] and not bpy.data.volumes, os.listdir()

    thing.vox.dim = 80
    assert convert("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    bpy.ops.object.select_all(action="DESELECT")  # the user goes on
    while Run.now:
        yield
    assert os.listdir() == ["Suzanne.vdb"]
    assert [o.type for o in bpy.data.objects] == ["MESH", "VOLUME"]

    assert bpy.ops.object.vox_convert_frames("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    yield
    bpy.ops.object.vox_cancel()
    while Run.now:
        yield
    assert os.listdir() == ["Suzanne.vdb"] and bpy.context.scene.frame_current == 1


def step(steps=story(), end=time.monotonic() + 240):
    try:
        assert time.monotonic() < end, "takes too long"
        next(steps)
        return 0.05
    except StopIteration:
        print("converted in a window", flush=True)
        os._exit(0)  # Blender would write its last scene first
    except BaseException:
        traceback.print_exc()
        os._exit(1)


bpy.app.timers.register(step, first_interval=1)
