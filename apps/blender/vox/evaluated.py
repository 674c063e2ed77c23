"""The mesh of an object as it is to be converted: with its modifiers, also if it is hidden."""

import contextlib

import bpy


@contextlib.contextmanager
def _shown(thing):
    """Shows an object for a while: Blender does not evaluate the modifiers of hidden ones."""
    was = thing.hide_viewport, thing.hide_get()
    if not any(was):
        yield
        return
    thing.hide_viewport = False
    thing.hide_set(False)
    try:
        yield
    finally:
        thing.hide_viewport = was[0]
        thing.hide_set(was[1])


@contextlib.contextmanager
def mesh_of(thing, use_modifiers):
    """The mesh, for the length of a block, and the object's place in the world."""
    thing.update_from_editmode()
    with _shown(thing):
        depsgraph = bpy.context.evaluated_depsgraph_get()
        evaluated = thing.evaluated_get(depsgraph)
        place = evaluated.matrix_world.copy()
        if not use_modifiers:
            yield thing.data, place
            return
        # All layers, as creases and colours are needed too.
        mesh = evaluated.to_mesh(preserve_all_data_layers=True, depsgraph=depsgraph)
        try:
            yield mesh, place
        finally:
            evaluated.to_mesh_clear()
